"""What is applied right now: speed, force or approach, and the velocities that follow.

The one mutable thing terms share: continuation and load histories change it between solves.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


@dataclass
class Operation:
    """Scaled operating point.

    kind: ``rest``, ``rotation`` (body turns about ``axis`` through ``centre``, speed in rad per
    time; in two dimensions the axis is z) or ``sliding`` (plane moves along ``direction``, speed
    in length per time). ``axis`` and ``direction`` are unit vectors.
    force: load to balance, or None when ``approach`` is prescribed.
    friction: share of the dry friction that acts (continuation).
    share: share of tractions and prescribed values that acts (continuation).
    creep: speed below which dry friction fades through a reversal (0: Coulomb's jump).
    time: s; what the prescribed tractions are asked for.
    """

    kind: str = "rest"
    speed: float = 0.0
    centre: tuple[float, ...] = (0.0, 0.0)
    direction: tuple[float, ...] = (1.0, 0.0)
    force: float | None = None
    approach: float = 0.0
    friction: float = 1.0
    share: float = 1.0
    time: float = 0.0
    creep: float = 0.0
    axis: tuple[float, ...] = (0.0, 0.0, 1.0)

    @property
    def motion(self) -> tuple[object, ...]:
        """All that the velocities depend on."""
        return self.kind, self.speed, self.centre, self.direction, self.axis

    def body_velocity(self, X: Array) -> Array:
        """v = Omega axis x (X - x0), (..., dim); zero unless the body rotates."""
        v = np.zeros_like(X)
        if self.kind != "rotation":
            return v
        dim = X.shape[-1]
        x, y, z = (X[..., k] - self.centre[k] if k < dim else 0.0 for k in range(3))
        a, b, c = (self.speed * component for component in self.axis)
        turned = (b * z - c * y, c * x - a * z, a * y - b * x)
        for k in range(dim):
            v[..., k] = turned[k]
        return v

    def plane_velocity(self, X: Array) -> Array:
        """Velocity of the rigid plane, (..., dim)."""
        U = np.zeros_like(X)
        if self.kind == "sliding":
            U[...] = self.speed * np.asarray(self.direction)
        return U

    def entrainment(self, X: Array, normal: Array) -> Array:
        """Sum velocity of the two surfaces along the surface: the film carries half of it."""
        v = self.body_velocity(X) + self.plane_velocity(X)
        return v - np.einsum("...d,...d->...", v, normal)[..., None] * normal

    def sliding_direction(self, X: Array, normal: Array) -> Array:
        """w / sqrt(|w|^2 + creep^2), w the body's motion on the plane; zero at rest.

        Without creep the unit vector.  With it, friction is a smooth function of the speed, and
        in a reversal does not jump: 99 % of it act from seven times the creep on.
        """
        w = self.body_velocity(X) - self.plane_velocity(X)
        w = w - np.einsum("...d,...d->...", w, normal)[..., None] * normal
        size = np.hypot(np.linalg.norm(w, axis=-1, keepdims=True), self.creep)
        return np.where(size > 0, w / np.where(size > 0, size, 1.0), 0.0)
