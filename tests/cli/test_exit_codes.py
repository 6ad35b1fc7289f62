"""Exit codes and what stands on stderr: 0, 2 bad input, 3 failed solve, 130 interrupted."""

import os
import subprocess
import sys
from pathlib import Path

import pytest
from typer.testing import CliRunner

from porolub.cli import app

ROOT = Path(__file__).parents[2]
CASE1 = str(ROOT / "jobs" / "case1.toml")


def porolub(*arguments: str) -> "subprocess.CompletedProcess[str]":
    """Run the program as a user does."""
    return subprocess.run(
        [sys.executable, "-m", "porolub", *arguments],
        cwd=ROOT,
        env={k: v for k, v in os.environ.items() if not k.endswith("_NUM_THREADS")},
        capture_output=True,
        text=True,
        timeout=60,
        check=False,
    )


@pytest.mark.parametrize(
    ("override", "parts"),
    [
        ("solid.shear_modulus=0.5", ["solid.shear_modulus = 0.5", "no unit", "0.5 MPa"]),
        ("solid.shear_modulus=0.5 mm", ['solid.shear_modulus = "0.5 mm"', "a length", "pressure"]),
        ("solid.shear_modulus=-1 Pa", ['solid.shear_modulus = "-1 Pa"', "greater than 0"]),
        ("solid.shear_modulos=1 Pa", ["solid.shear_modulos", "did you mean solid.shear_modulus?"]),
        ("sold.law=linear", ["[sold]", "did you mean [solid]?"]),
        ("geometry.thickness=", ["geometry.thickness is missing", "1 mm"]),
        ("geometry=", ["[geometry] is missing", "sector"]),
        ("geometry.shape=disc", ['geometry.shape = "disc"', "sector, block, barrel, file"]),
        ("mesh.along=many", ['mesh.along = "many"', "whole number"]),
        ("pores.biot=2", ["pores.biot = 2", "at most 1"]),
        ("motion=none", ["pores.carry = true", "motion.kind"]),
        ("boundary.inlt.pressure=0 Pa", ["boundary.inlt", "did you mean boundary.inlet?"]),
        ("load.force", ['"load.force"', "section.key=value"]),
    ],
)
@pytest.mark.parametrize("command", ["check", "run"])
def test_a_wrong_scene_exits_with_2_and_one_clean_line(
    command: str, override: str, parts: list[str]
) -> None:
    result = CliRunner().invoke(app, [command, CASE1, "--set", override])
    assert result.exit_code == 2
    assert result.stdout == ""
    (line,) = result.stderr.splitlines()
    assert line.startswith("porolub: ")
    assert all(part in line for part in parts), line


def test_several_mistakes_are_one_line_each() -> None:
    result = CliRunner().invoke(
        app, ["check", CASE1, "--set", "mesh.along=0", "--set", "pores.biot=2"]
    )
    assert result.exit_code == 2
    lines = result.stderr.splitlines()
    assert [line.split(" ")[:2] for line in lines] == [
        ["porolub:", "mesh.along"],
        ["porolub:", "pores.biot"],
    ]


@pytest.mark.parametrize(
    ("arguments", "part"),
    [
        (["check", "nope.toml"], "porolub: nope.toml: there is no such scene file."),
        (["check"], "porolub: Missing argument 'SCENE'."),
        (["chek", CASE1], "porolub: No such command 'chek'. Did you mean 'check'?"),
        (["check", CASE1, "--fast"], "porolub: No such option: --fast"),
        (["check", CASE1, "--set", "mesh.along=0"], "porolub: mesh.along = 0: the value must"),
        (["run", CASE1, "--set", "time.end=5"], "porolub: time.end = 5: a plain number has no"),
        (["restart"], "porolub: Missing argument 'DIR'."),
        (["restart", "no/such/directory"], "porolub: no/such/directory/checkpoint.h5: there is no"),
        (["plot", "no/such/directory"], "porolub: no/such/directory: there is no such directory."),
    ],
)
def test_the_program_never_shows_a_traceback_for_bad_input(arguments: list[str], part: str) -> None:
    result = porolub(*arguments)
    assert result.returncode == 2
    assert result.stderr.startswith(part)
    assert len(result.stderr.splitlines()) == 1


def test_check_exits_with_0() -> None:
    result = porolub("check", CASE1)
    assert (result.returncode, result.stderr) == (0, "")


def test_help_names_the_commands_there_are() -> None:
    result = porolub("--help")
    assert result.returncode == 0
    assert all(name in result.stdout for name in ("run", "check", "restart", "plot", "info"))
    assert "film=none" in porolub("check", "--help").stdout
    assert "any number of ranks" in porolub("restart", "--help").stdout


def test_info_shows_the_versions_of_all_that_takes_part() -> None:
    result = porolub("info")
    assert result.returncode == 0
    rows = dict(line.split(maxsplit=1) for line in result.stdout.splitlines())
    assert list(rows) == [
        "python", "porolub", "numpy", "petsc", "petsc4py", "mpi4py", "gmsh", "h5py", "meshio",
    ]  # fmt: skip
    assert rows["python"] == sys.version.split()[0]
    assert all(version[0].isdigit() for version in rows.values())


def test_one_thread_a_rank_unless_the_user_says_otherwise() -> None:
    code = (
        "import os, sys; import porolub.cli; "
        "print(os.environ['OPENBLAS_NUM_THREADS'], os.environ['OMP_NUM_THREADS'])"
    )
    clean = {k: v for k, v in os.environ.items() if not k.endswith("_NUM_THREADS")}

    def threads(env: dict[str, str]) -> str:
        command = [sys.executable, "-c", code]
        return subprocess.run(
            command, cwd=ROOT, env=env, capture_output=True, text=True, timeout=60, check=True
        ).stdout.strip()

    assert threads(clean) == "1 1"
    assert threads(clean | {"OMP_NUM_THREADS": "2"}) == "1 2"


@pytest.mark.mpi
@pytest.mark.parametrize("command", ["check", "run"])
def test_ranks_stop_together_and_only_one_speaks(command: str) -> None:
    arguments = ["-m", "porolub", command, CASE1, "--set", "mesh.along=0"]
    result = subprocess.run(
        ["mpirun", "-n", "3", sys.executable, *arguments],
        cwd=ROOT, env=dict(os.environ), capture_output=True, text=True, timeout=60, check=False,
    )  # fmt: skip
    assert result.returncode == 2
    assert result.stderr.count("porolub: mesh.along = 0") == 1


@pytest.mark.mpi
@pytest.mark.parametrize(("error", "code"), [("SolveError('no.')", 3), ("ZeroDivisionError()", 1)])
def test_a_rank_in_error_does_not_leave_the_others_waiting(
    tmp_path: Path, error: str, code: int
) -> None:
    script = tmp_path / "one_fails.py"
    script.write_text(
        "import sys\nfrom types import ModuleType\nfrom mpi4py import MPI\n"
        "import porolub.cli\nfrom porolub.errors import SolveError\n"
        "def run_scene(*arguments):\n"
        f"    if MPI.COMM_WORLD.rank == 1: raise {error}\n"
        "    MPI.COMM_WORLD.recv(source=1)\n"
        "sys.modules['porolub.run'] = module = ModuleType('porolub.run')\n"
        "module.run_scene = run_scene\n"
        "porolub.cli.PATIENCE = 0.5\n"
        "porolub.cli.main()\n"
    )
    result = subprocess.run(
        ["mpirun", "-n", "2", sys.executable, str(script), "run", CASE1],
        cwd=tmp_path, env={**os.environ, "PYTHONPATH": str(ROOT)},
        capture_output=True, text=True, timeout=60, check=False,
    )  # fmt: skip
    assert result.returncode == code
