"""Numbering of the unknowns: complete, unique, owned once; vectors and their local copies."""

import numpy as np
import pytest

from porolub.fem.dofs import Dofs, Field
from porolub.fem.domains import Domain, NodalDomain
from tests.fem import meshes


def all_fields(kind):
    mesh, surface = meshes.mesh(kind), meshes.surface(kind)
    fields = [Field("u", mesh.dim, 2), Field("p", 1, 1), Field("l", 1, 2, support=surface),
              Field("s", 1, 1, support=surface), Field("v0", 1, 0)]
    return mesh, surface, Dofs(mesh, fields)


each = pytest.mark.parametrize("kind", meshes.ALL)


@each
def test_every_field_has_a_dof_at_each_of_its_nodes(kind):
    mesh, surface, dofs = all_fields(kind)
    on_surface = mesh.boundary_nodes(surface)
    expected = {
        "u": mesh.dim * len(mesh.coordinates), "p": mesh.nvertices, "l": len(on_surface),
        "s": int((on_surface < mesh.nvertices).sum()), "v0": 1,
    }
    assert dofs.counts() == expected
    assert dofs.size == dofs.size_local == dofs.count_owned == sum(expected.values())
    assert dofs.owned.all()


@each
def test_no_dof_is_missing_and_none_is_numbered_twice(kind):
    _, _, dofs = all_fields(kind)
    np.testing.assert_array_equal(np.sort(dofs.global_numbers), np.arange(dofs.size))
    sets = [dofs.index_set(name) for name in dofs.fields]
    covered = np.concatenate([s.indices for s in sets])
    np.testing.assert_array_equal(np.sort(covered), np.arange(dofs.size))
    ranges = np.concatenate([np.arange(dofs.size_local)[dofs.range[name]] for name in dofs.fields])
    np.testing.assert_array_equal(np.sort(ranges), np.arange(dofs.size_local))
    for s in sets:
        s.destroy()


def test_entities_know_the_dofs_of_their_nodes():
    mesh, surface, dofs = all_fields("sector")
    facets = Domain(f"facets:{surface}", mesh, 2)
    for name, degree in (("u", 2), ("p", 1), ("l", 2), ("s", 1)):
        numbers = dofs.entity_dofs(name, facets)
        cells = (mesh.cells if degree == 2 else mesh.vertices_of_cells)[facets.cells]
        assert numbers.shape == cells.shape
        present = numbers >= 0
        lives = np.isin(cells, dofs.nodes[name])
        np.testing.assert_array_equal(present, lives)
        step = dofs.fields[name].components
        place = (numbers[present] - dofs.range[name].start) // step
        np.testing.assert_array_equal(dofs.nodes[name][place], cells[present])
    np.testing.assert_array_equal(dofs.entity_dofs("v0", facets), dofs.range["v0"].start)
    on_surface = mesh.boundary_nodes(surface)
    nodal = NodalDomain(f"nodes:{surface}", mesh, on_surface, np.ones(len(on_surface)),
                        np.ones((len(on_surface), 2)))
    np.testing.assert_array_equal(dofs.entity_dofs("l", nodal)[:, 0], dofs.base["l"][on_surface])


def test_to_local_and_back():
    _, _, dofs = all_fields("sector")
    x = dofs.vector()
    assert x.norm() == 0.0
    x.array[:] = np.arange(1.0, dofs.size + 1)
    local = dofs.to_local(x)
    np.testing.assert_array_equal(local, x.array[dofs.global_numbers])
    y = dofs.vector()
    y.set(3.0)  # what was there before is overwritten
    dofs.add_to_global(local, y)
    np.testing.assert_array_equal(y.array, x.array)
    np.testing.assert_array_equal(dofs.sum_local(local), local)
    for v in (x, y):
        v.destroy()


def test_a_field_of_a_local_vector_is_a_view_by_node():
    mesh, _, dofs = all_fields("sector")
    local = np.zeros(dofs.size_local)
    dofs.field("u", local)[...] = mesh.coordinates[dofs.nodes["u"]]
    node = 17
    base = dofs.base["u"][node]
    np.testing.assert_array_equal(local[base : base + 2], mesh.coordinates[node])
    assert not local[dofs.range["p"]].any()


def test_norms_and_scalars():
    _, _, dofs = all_fields("sector")
    x = dofs.vector()
    x.array[:] = np.linspace(-1.0, 1.0, dofs.size)
    dofs.set_scalar("v0", x, -7.0)
    assert dofs.scalar_value("v0", x) == -7.0
    local = dofs.to_local(x)
    for name, r in dofs.range.items():
        assert dofs.field_norms(x, 2)[name] == pytest.approx(np.linalg.norm(local[r]))
        assert dofs.field_norms(x, np.inf)[name] == np.abs(local[r]).max()
    x.destroy()
