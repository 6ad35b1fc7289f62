"""`porolub run` with the iterative presets, as a user meets them: results, options, failures."""

from pathlib import Path

import pytest

from porolub.io.summary import read_summary
from tests.run.output import JOBS
from tests.run.program import porolub

JOINT = (JOBS / "joint3d.toml").read_text()
SMALL = [f"--set=mesh.{key}" for key in ("along=12", "across=2", "deep=3")]
SPLIT = [*SMALL, "--set", "solver.preset=fieldsplit", "--quiet", "--out", "here"]


def test_a_joint_in_time_ends_well_and_can_be_taken_further_by_another_preset(tmp_path: Path
                                                                              ) -> None:
    scene = tmp_path / "scene.toml"
    scene.write_text(f'{JOINT}\n[time]\nend = "0.02 s"\ntolerance = 0.01\n')
    result = porolub("run", scene, *SPLIT, cwd=tmp_path)
    assert (result.returncode, result.stderr) == (0, "")
    summary = read_summary(tmp_path / "here" / "summary.json")
    assert summary["load_total"] == pytest.approx(6.0, rel=1e-6)
    assert summary["linear_iterations"] > 5 * summary["newton_iterations"]
    further = porolub("restart", "here", "--set", "time.end=0.03 s", "--set",
                      "solver.preset=direct", "--quiet", cwd=tmp_path)
    assert (further.returncode, further.stderr) == (0, "")
    assert read_summary(tmp_path / "here" / "summary.json")["time_steps"] > summary["time_steps"]


def test_an_option_deep_inside_is_read(tmp_path: Path) -> None:
    result = porolub("run", JOBS / "joint3d.toml", *SPLIT, "--petsc",
                     "-fieldsplit_u_mg_coarse_pc_type lu -ksp_converged_reason", cwd=tmp_path)
    assert (result.returncode, result.stderr) == (0, "")
    assert "CONVERGED_RTOL" in result.stdout
    mine, rest = (tmp_path / "here" / "petsc.options").read_text().split("#")
    assert mine.splitlines() == ["-fieldsplit_u_mg_coarse_pc_type lu", "-ksp_converged_reason"]
    assert "-fieldsplit_u_mg_coarse_pc_type" not in rest
    assert "-fieldsplit_u_pc_type mg" in rest


@pytest.mark.parametrize(("option", "said"), [
    ("-fieldsplit_u_mg_coarse_pc_tipe lu", "did you mean -fieldsplit_u_mg_coarse_pc_type?"),
    ("-mat_mumps_icntl_7 5 -fieldsplit_v_pc_type lu", "no solver of this scene reads"),
])
def test_an_option_no_split_reads_is_refused(tmp_path: Path, option: str, said: str) -> None:
    result = porolub("run", JOBS / "joint3d.toml", *SPLIT, "--petsc", option, cwd=tmp_path)
    assert result.returncode == 2
    (line,) = result.stderr.splitlines()
    assert said in line


def test_too_few_iterations_are_said_to_be_the_reason(tmp_path: Path) -> None:
    result = porolub("run", JOBS / "joint3d.toml", *SPLIT, "--petsc", "-ksp_max_it 2",
                     cwd=tmp_path)
    assert result.returncode == 3
    assert "did not converge in 2 iterations" in result.stderr
    assert 'solver.preset = "direct"' in result.stderr
    assert "Traceback" not in result.stderr
    assert (tmp_path / "here" / "summary.json").exists()


def test_another_preconditioner_for_the_whole_matrix_is_the_users_to_choose(tmp_path: Path) -> None:
    result = porolub("run", JOBS / "joint3d.toml", *SPLIT, "--petsc",
                     "-pc_type lu -pc_factor_mat_solver_type mumps -ksp_type preonly",
                     cwd=tmp_path)
    assert (result.returncode, result.stderr) == (0, "")
    summary = read_summary(tmp_path / "here" / "summary.json")
    assert summary["linear_iterations"] == summary["newton_iterations"]


def test_an_option_of_another_preset_is_said_to_be_one(tmp_path: Path) -> None:
    result = porolub("run", JOBS / "joint3d.toml", *SMALL, "--quiet", "--out", "here",
                     "--petsc", "-fieldsplit_u_pc_type lu", cwd=tmp_path)
    assert result.returncode == 2
    (line,) = result.stderr.splitlines()
    assert "-fieldsplit_u_pc_type" in line
    assert "another solver.preset" in line
