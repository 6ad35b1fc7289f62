"""``porolub check``: the table of expected costs, and which part of a joint is modelled."""

from pathlib import Path

import pytest

from porolub.scene import load_scene
from porolub.scene.cost import expected_cost
from tests.cli.test_check import CASE1, JOBS, output

JOINT = str(JOBS / "joint3d.toml")


def cells(text: str, name: str) -> list[str]:
    """Return the cells of the row of a linear solver in the table of costs."""
    table = text[text.index("Expected cost") :]
    rows = [[c.strip() for c in line.split("│")[1:-1]] for line in table.splitlines()]
    return next(row for row in rows if row and row[0] == name)


def test_it_shows_time_and_memory_of_both_solvers_and_which_is_used() -> None:
    text = output(CASE1)
    cost = expected_cost(load_scene(CASE1))
    assert f"matrix of {cost.entries:,} entries" in " ".join(text.split())
    assert "within a factor of 2" in " ".join(text.split())
    direct, split = cells(text, "direct"), cells(text, "fieldsplit")
    assert (direct[1], split[1]) == ("yes", "no")
    assert direct[2] == f"{cost.direct.seconds:.2g} s"
    assert direct[3].endswith(" MB")
    assert 0.9 < float(direct[3].split()[0]) / (cost.direct.memory / 1e6) < 1.1


def test_a_joint_is_iterated_on_and_its_half_is_named() -> None:
    text = output(JOINT)
    assert cells(text, "fieldsplit")[1] == "yes"
    note = "front is a symmetry plane: loads, flows and contact are those of half of the width."
    assert note in " ".join(text.split())
    whole = " ".join(output(JOINT, "--set", "geometry.symmetry=[]").split())
    assert "symmetry plane" not in whole
    slab = " ".join(output(JOINT, "--set", 'geometry.symmetry=["front", "back"]').split())
    assert "front and back are symmetry planes: loads, flows and contact are those of the" in slab


@pytest.mark.parametrize("preset", ["direct", "fieldsplit", "nested"])
def test_a_preset_of_the_scene_is_shown(preset: str) -> None:
    assert cells(output(CASE1, "--set", f"solver.preset={preset}"), preset)[1] == "yes"


def test_the_cluster_s_joint_fits_the_memory_its_script_asks_for() -> None:
    cost = expected_cost(load_scene(JOBS / "joint3d_cluster.toml"))
    script = Path(JOBS / "joint3d.slurm").read_text()
    asked = {line.split("=")[0]: line.split("=")[1] for line in script.splitlines()
             if line.startswith("#SBATCH --")}
    ranks = int(asked["#SBATCH --nodes"]) * int(asked["#SBATCH --ntasks-per-node"])
    memory = 1e9 * float(asked["#SBATCH --mem-per-cpu"].rstrip("G"))
    assert cost.fieldsplit.memory_per_rank(ranks) < memory / 2
