"""Every term alone: its Jacobian is the derivative of its residual, on all kinds of cells."""

import numpy as np
import pytest

from porolub.terms.term import Stores
from tests.fem import meshes
from tests.terms.cases import CASES, setting
from tests.terms.support import smooth, system
from tests.terms.taylor import keep_off_kinks, pairs

KINDS = {"sector": (4, 2), "sector of triangles": (3, 2), "barrel": (3, 1), "cuboid": (3, 1),
         "box of tets": (0, 0)}
# nodal quadrature gives the vertices of a quadratic triangle, a tet's face, no weight at all
NODAL = ("contact", "contact, friction")
RUNS = [(name, kind, finite) for name, case in CASES.items() for kind in KINDS
        for finite in case.finite if not (name in NODAL and kind == "box of tets")]


@pytest.mark.parametrize(("name", "kind", "finite"), RUNS)
def test_jacobian_is_the_derivative_of_the_residual(name, kind, finite):
    case, (along, across) = CASES[name], KINDS[kind]
    mesh, boundary = meshes.mesh(kind, along, across, 2), meshes.surface(kind)
    at = setting(mesh, boundary, case.kind)
    term = case.build(at)
    of = system(mesh, [term], case.fields, finite, boundary=boundary)
    state = smooth(of.dofs)
    of.backward_euler(smooth(of.dofs, 0.03, 0.05), 1 / 5.0)
    if case.surface:
        state = keep_off_kinks(of, at.plane, boundary, state)
    filled = pairs(of, state)
    assert filled == case.pairs | (case.also if finite else frozenset())
    stored = term.contents() if isinstance(term, Stores) else []
    declared = {block for part in [*term.parts(), *stored] for block in part.blocks}
    assert filled <= declared
    residual = of.local_residual(state)
    assert np.isfinite(residual).all()
    assert np.abs(residual).max() > 1e-3
