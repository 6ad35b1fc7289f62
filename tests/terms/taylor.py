"""The Jacobian against central differences, for each pair of a row field and a column field."""

import numpy as np
from numpy.typing import NDArray

from porolub.solve.system import System
from porolub.terms.plane import Plane
from tests.terms.support import everywhere, vector

Array = NDArray[np.float64]

STEPS = np.array([1.0, 0.5, 0.25])
SIZES = {"u": 2e-4, "p": 1e-2, "l": 2e-3, "v0": 2e-4}  # of the largest change; others as p
MARGIN = 6e-4  # what keeps every gap, or l - gap, away from its kink under these changes


def direction(of: System, name: str, seed: int) -> Array:
    """A random local change of one field that respects the constraints."""
    change = np.zeros(of.dofs.size_local)
    r = of.dofs.range[name]
    random = np.random.default_rng(seed).uniform(-1, 1, r.stop - r.start)
    change[r] = SIZES.get(name, SIZES["p"]) * random
    change[of.constraints.fixed] = 0.0
    return change


def residual(of: System, local: Array) -> Array:
    x, out = vector(of.dofs, local), of.dofs.vector()
    of.residual(x, out)
    found = of.dofs.to_local(out)
    x.destroy()
    out.destroy()
    return found


def pairs(of: System, stored: Array) -> set[tuple[str, str]]:
    """Taylor test at a stored local state; the (row, column) fields that have entries.

    The error of (F(x + e d) - F(x - e d)) / (2 e) = J d must fall with e^2, or be rounding.
    """
    matrix, x, product = of.create_matrix(), vector(of.dofs, stored), of.dofs.vector()
    of.jacobian(x, matrix)
    level = np.abs(residual(of, stored))
    filled = set()
    for seed, column in enumerate(of.dofs.fields):
        change = direction(of, column, seed)
        d = vector(of.dofs, change)
        matrix.mult(d, product)
        exact = of.dofs.to_local(product)
        d.destroy()
        differences = np.array([
            (residual(of, stored + e * change) - residual(of, stored - e * change)) / (2 * e)
            for e in STEPS])
        for row, r in of.dofs.range.items():
            size = np.abs(exact[r]).max(initial=0.0)
            errors = np.linalg.norm(differences[:, r] - exact[r], axis=1)
            rounding = 1e-12 * (size + level[r].max(initial=0.0)) * np.sqrt(r.stop - r.start)
            if errors[-1] > rounding:
                orders = np.log2(errors[:-1] / errors[1:])
                message = f"d {row} / d {column}: orders {orders}, errors {errors}, J d {size}"
                assert np.all(np.abs(orders - 2.0) < 0.2), message
                assert errors[-1] < 0.05 * np.sqrt(r.stop - r.start) * size, message
            if size > 0.0:
                filled.add((row, column))
    matrix.destroy()
    for v in (x, product):
        v.destroy()
    return filled


def keep_off_kinks(of: System, plane: Plane, boundary: str, physical: Array) -> Array:
    """The state with v0 (or the prescribed approach) and l moved away from the kinks.

    The plane is put where no point of the surface is within MARGIN of touching, though some
    overlap and some do not; l is put off c gap (c = 1), some nodes on either side.
    """
    physical = physical.copy()
    names = [n for n in of.domains if n.endswith(f":{boundary}")]
    gaps = np.sort(np.concatenate([plane.gap(everywhere(of, n, physical)).ravel() for n in names]))
    middle = gaps[len(gaps) // 5 : len(gaps) - len(gaps) // 5]
    k = int(np.argmax(np.diff(middle)))
    shift = (middle[k] + middle[k + 1]) / 2
    assert (middle[k + 1] - middle[k]) / 2 > MARGIN, "no room between the points of the surface"
    if "v0" in of.dofs.fields:
        physical[of.dofs.range["v0"]] += shift
    else:
        plane.operation.approach += shift
    if "l" in of.dofs.fields:
        name = f"nodes:{boundary}"
        at = everywhere(of, name, physical)
        gap = plane.gap(at)[:, 0]
        rows = of.dofs.entity_dofs("l", of.domains[name])[:, 0]
        away = physical[rows] - gap
        sign = np.where(away < 0, -1.0, 1.0)
        physical[rows] = gap + sign * np.maximum(np.abs(away), 2e-2)
        assert -1.0 in sign
        assert 1.0 in sign
    return physical
