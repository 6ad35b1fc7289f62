"""Carrying a state from mesh to mesh: what must survive, on any number of ranks."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from porolub.solve.model import Model
from porolub.solve.transfer import restore, snapshot
from tests.solve.models import Array, case1, model_of, physical, vector, waves

SCRIPT = Path(__file__).with_name("transfer_ranks.py")
COARSE = case1(6, 4)
GRADED = {"along": 24, "across": 4, "edges": (-4.0, 4.5), "edge_size": 0.4}


def places(model: Model, name: str) -> Array:
    """Where the nodes of a field are: (n, 2) from 0 to 1 along and across the layer."""
    return model.mesh.logical(model.mesh.coordinates[model.dofs.nodes[name]])


def affine(model: Model) -> Array:
    """A local, physical state, linear along and across with its own slopes in each field."""
    local = np.zeros(model.dofs.size_local)
    for k, (name, f) in enumerate(model.dofs.fields.items()):
        if f.degree == 0:
            local[model.dofs.range[name]] = 0.07
            continue
        a, b = places(model, name).T
        for c in range(f.components):
            model.dofs.field(name, local)[:, c] = 0.1 * (1 + k) + (0.3 + c) * a - 0.2 * (k + c) * b
    return local


def unconstrained(model: Model) -> Array:
    """(size_local,) True where no condition has a say."""
    free = np.ones(model.dofs.size_local, bool)
    free[model.system.constraints.fixed] = False
    base = model.dofs.base.get("u")
    if base is not None:  # at a rotated node a fixed axis mixes the components
        for c in range(model.mesh.dim):
            free[base[model.system.constraints.rotated] + c] = False
    return free


def test_a_state_comes_back_unchanged_on_its_own_mesh() -> None:
    with model_of(COARSE) as model:
        x = vector(model, waves(model.dofs), conditions=True)
        y = restore(model, snapshot(model, x))
        y.axpy(-1.0, x)
        assert y.norm() < 1e-13


@pytest.mark.parametrize(
    "mesh", [{"along": 12, "across": 8}, {"along": 9, "across": 5}, GRADED],
    ids=["nested", "not nested", "graded"],
)
def test_affine_fields_are_reproduced(mesh: dict[str, Any]) -> None:
    with model_of(COARSE) as coarse, model_of(COARSE, **mesh) as fine:
        x = restore(fine, snapshot(coarse, vector(coarse, affine(coarse))))
        free = unconstrained(fine)
        assert free.mean() > 0.7
        np.testing.assert_allclose(physical(fine, x)[free], affine(fine)[free], atol=1e-12)


def test_prescribed_values_are_those_of_the_new_mesh() -> None:
    with model_of(COARSE) as coarse, model_of(COARSE, along=12, across=8) as fine:
        x = restore(fine, snapshot(coarse, vector(coarse, affine(coarse))))
        conditions = fine.system.constraints
        np.testing.assert_array_equal(fine.dofs.to_local(x)[conditions.fixed], conditions.values)


def test_nothing_exceeds_the_old_nodes_around_it() -> None:
    """A contact pressure of zero here and there stays so: no contact comes from nowhere."""
    random = np.random.default_rng(3)
    with model_of(COARSE) as coarse, model_of(COARSE, **GRADED) as fine:
        place = np.rint(12 * places(coarse, "l")[:, 0]).astype(int)
        left = np.clip(np.floor(12 * places(fine, "l")[:, 0] + 1e-9).astype(int), 0, 11)
        for old in random.normal(size=(20, 13)) * random.integers(0, 2, (20, 13)):
            local = np.zeros(coarse.dofs.size_local)
            coarse.dofs.field("l", local)[:, 0] = old[place]
            x = restore(fine, snapshot(coarse, vector(coarse, local)))
            low, high = np.sort([old[left], old[left + 1]], axis=0)
            found = fine.dofs.field("l", physical(fine, x))[:, 0]
            assert np.all((found >= low - 1e-12) & (found <= high + 1e-12))


def test_the_error_of_a_smooth_state_falls_with_the_square_of_the_element_size() -> None:
    errors = []
    with model_of(COARSE, along=48, across=12) as fine:
        inside = np.all(np.abs(places(fine, "u") - 0.5) < 0.3, axis=1)
        exact = fine.dofs.field("u", waves(fine.dofs))
        for counts in ({"along": 12, "across": 3}, {"along": 24, "across": 6}):
            with model_of(COARSE, **counts) as coarse:
                x = restore(fine, snapshot(coarse, vector(coarse, waves(coarse.dofs))))
            found = fine.dofs.field("u", physical(fine, x))
            errors.append(np.abs(found - exact)[inside].max())
    assert np.log2(errors[0] / errors[1]) > 1.8, errors


@pytest.mark.mpi
def test_ranks_carry_the_same_state(run_mpi, tmp_path: Path) -> None:
    found = {}
    for ranks in (1, 2, 4):
        path = tmp_path / f"{ranks}.npz"
        run_mpi(ranks, SCRIPT, path)
        found[ranks] = dict(np.load(path))
    assert set(found[1]) >= {f"{case} {way} {name}" for case in ("plane", "barrel")
                             for way in ("shared", "alone") for name in ("u", "p", "l", "v0")}
    for ranks in (2, 4):
        for name, values in found[1].items():
            np.testing.assert_allclose(found[ranks][name], values, atol=1e-13, err_msg=name)


def test_what_other_ranks_are_told_of_a_state_on_rank_0_has_no_rows() -> None:
    with model_of(COARSE) as coarse:
        data = snapshot(coarse, vector(coarse, affine(coarse)))
    outline = data.outline()
    assert not data.shared
    assert outline.scalars == data.scalars
    assert {name: rows.shape for name, rows in outline.rows.items()} == {
        name: (0, rows.shape[1]) for name, rows in data.rows.items()}
