"""A made-up body: 4 x 1 x 3 hex27 cells of a barrel, and its lubricated surface."""

import numpy as np

from porolub.mesh.cell import HEX
from porolub.solve.report import Array, FieldData, SurfaceMap

RADIUS, ANGLE, WIDTH, THICKNESS = 0.1, np.radians(5.0), 12e-3, 1e-3
NX, NZ = 16, 12
HALF_S, HALF_Z = 4e-3, 3.2e-3  # of the contact


def grid(nx: int, ny: int, nz: int) -> tuple[Array, np.ndarray]:
    """Angle, height (0 bone, 1 surface) and z of the nodes, and hex27 cells in VTK's order."""
    ticks = (np.linspace(-ANGLE, ANGLE, 2 * nx + 1), np.linspace(0, 1, 2 * ny + 1),
             WIDTH * np.linspace(-0.5, 0.5, 2 * nz + 1))  # fmt: skip
    places = np.stack(np.meshgrid(*ticks, indexing="ij"), axis=-1)
    number = np.arange(places[..., 0].size).reshape(places.shape[:3])
    corner = np.array([(0, 0, 0), (2, 0, 0), (2, 2, 0), (0, 2, 0),
                       (0, 0, 2), (2, 0, 2), (2, 2, 2), (0, 2, 2)])  # fmt: skip
    means = [corner[list(entity)].mean(axis=0) for kind in HEX.parents() for entity in kind]
    steps = np.vstack([corner, np.array(means)]).astype(int)
    i, j, k = (2 * np.arange(n) for n in (nx, ny, nz))
    start = np.stack(np.meshgrid(i, j, k, indexing="ij"), axis=-1).reshape(-1, 1, 3) + steps
    return places.reshape(-1, 3), number[tuple(np.moveaxis(start, -1, 0))]


def positions(places: Array) -> Array:
    """Positions of nodes by angle, height and z, m."""
    angle, height, z = places.T
    radius = RADIUS - THICKNESS * (1 - height)
    return np.stack([radius * np.sin(angle), RADIUS - radius * np.cos(angle), z], axis=-1)


def body() -> FieldData:
    """Simple fields."""
    places, cells = grid(4, 1, 3)
    nodes = positions(places)
    wave = np.cos(200 * nodes[:, 0]) * np.cos(300 * nodes[:, 2])
    return FieldData(
        nodes=nodes, cells=cells, cell_type="hex", degree=2,
        displacement=1e-5 * wave[:, None] * [0.1, 1.0, 0.2], pressure=1e5 * wave,
        jacobian=1 - 0.01 * wave, von_mises=2e5 * wave**2, flux=1e-6 * nodes,
    )  # fmt: skip


def body_surface(phase: float = 0.0, depth: float = WIDTH) -> SurfaceMap:
    """An elliptic contact, film outside, dragged along s; ``phase`` (0 to 1) skews the pressure.

    depth: how wide it is in z.
    """
    s, z = np.meshgrid(np.linspace(-RADIUS * ANGLE, RADIUS * ANGLE, 2 * NX + 1),
                       depth * np.linspace(-0.5, 0.5, 2 * NZ + 1), indexing="ij")  # fmt: skip
    number = np.arange(s.size).reshape(s.shape)
    i, j = np.meshgrid(2 * np.arange(NX), 2 * np.arange(NZ), indexing="ij")
    quad9 = [(0, 0), (2, 0), (2, 2), (0, 2), (1, 0), (2, 1), (1, 2), (0, 1), (1, 1)]
    cells = np.stack([number[i + a, j + b] for a, b in quad9], axis=-1).reshape(-1, 9)
    s, z = s.ravel(), z.ravel()
    inside = 1 - (s / HALF_S) ** 2 - (z / HALF_Z) ** 2
    skew = 1 + 0.3 * np.cos(2 * np.pi * phase) * s / HALF_S
    h = np.where(inside > 0, 0.0, -inside * 80e-6)
    angle = s / RADIUS
    Q_s, Q_z = 0.05 * h, 0.02 * h * np.sign(-s * z)
    return SurfaceMap(
        nodes=np.stack([RADIUS * np.sin(angle), RADIUS * (1 - np.cos(angle)), z], axis=-1),
        cells=cells, cell_type="quad", degree=2, s=s,
        p=1.6e5 * np.maximum(inside, 0.0) * skew, p_c=1.1e5 * np.maximum(inside, 0.0), h=h,
        Q=np.stack([Q_s * np.cos(angle), Q_s * np.sin(angle), Q_z], axis=-1), Q_s=Q_s, Q_z=Q_z,
        V=5e-6 * np.sign(s) * (inside <= 0),
    )  # fmt: skip
