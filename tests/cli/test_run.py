"""``porolub run`` and ``plot``: what they hand on, and what becomes of the outcome."""

import sys
from pathlib import Path
from types import ModuleType
from typing import Any

import pytest
from typer.testing import CliRunner

import porolub
from porolub.cli import app, rank_and_size
from porolub.errors import SceneError, SolveError
from porolub.scene import load_scene

CASE1 = Path(__file__).parents[2] / "jobs" / "case1.toml"


class Calls(list[tuple[Any, ...]]):
    """Stands for run_scene: keeps its arguments, then returns or raises ``outcome``."""

    outcome: int | BaseException = 0

    def __call__(self, *arguments: Any) -> int:
        self.append(arguments)
        if isinstance(self.outcome, BaseException):
            raise self.outcome
        return self.outcome


@pytest.fixture
def calls(monkeypatch: pytest.MonkeyPatch) -> Calls:
    calls, module = Calls(), ModuleType("porolub.run")
    module.run_scene = calls  # type: ignore[attr-defined]
    monkeypatch.setitem(sys.modules, "porolub.run", module)
    monkeypatch.setattr(porolub, "run", module, raising=False)
    return calls


def test_it_hands_on_scene_directory_and_options(calls: Calls) -> None:
    options = ["--out", "here", "--petsc", "-ksp_view -log_view", "--quiet"]
    result = CliRunner().invoke(app, ["run", str(CASE1), *options, "--set", "mesh.along=10"])
    assert result.exit_code == 0
    scene = load_scene(CASE1, ["mesh.along=10"])
    assert calls == [(scene, Path("here"), "-ksp_view -log_view", True)]


def test_the_results_go_beside_each_other_by_default(calls: Calls) -> None:
    CliRunner().invoke(app, ["run", str(CASE1)])
    assert calls == [(load_scene(CASE1), Path("results/case1"), "", False)]


@pytest.mark.parametrize(
    ("outcome", "code", "said"),
    [
        (0, 0, ""),
        (3, 3, ""),
        (SceneError("mesh: no."), 2, "porolub: mesh: no.\n"),
        (SolveError("no convergence."), 3, "porolub: no convergence.\n"),
        (KeyboardInterrupt(), 130, "porolub: interrupted.\n"),
    ],
)
def test_the_outcome_becomes_the_exit_code(
    calls: Calls, outcome: int | BaseException, code: int, said: str
) -> None:
    calls.outcome = outcome
    result = CliRunner().invoke(app, ["run", str(CASE1)])
    assert (result.exit_code, result.stderr) == (code, said)


def test_a_defect_is_not_hidden(calls: Calls) -> None:
    calls.outcome = ZeroDivisionError()
    result = CliRunner().invoke(app, ["run", str(CASE1)])
    assert isinstance(result.exception, ZeroDivisionError)


def test_a_scene_with_time_is_handed_on_like_any_other(calls: Calls) -> None:
    result = CliRunner().invoke(app, ["run", str(CASE1), "--set", "time.end=5 s"])
    assert result.exit_code == 0
    assert calls[0][0].time.end == 5.0


def test_plot_names_the_figures_it_drew(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    drawn = [tmp_path / "pressure.png", tmp_path / "surface.png"]
    module = ModuleType("porolub.io.plots")
    module.plot_directory = lambda path, period=None: drawn if path == tmp_path else []  # type: ignore[attr-defined]
    monkeypatch.setitem(sys.modules, "porolub.io", ModuleType("porolub.io"))
    monkeypatch.setitem(sys.modules, "porolub.io.plots", module)
    result = CliRunner().invoke(app, ["plot", str(tmp_path)])
    assert result.stdout.split() == [str(path) for path in drawn]


@pytest.mark.parametrize("family", ["OMPI_COMM_WORLD", "PMI"])
def test_only_rank_0_speaks(family: str, calls: Calls, monkeypatch: pytest.MonkeyPatch) -> None:
    calls.outcome = SolveError("no convergence.")
    for name in ("OMPI_COMM_WORLD_RANK", "OMPI_COMM_WORLD_SIZE", "PMI_RANK", "PMI_SIZE"):
        monkeypatch.delenv(name, raising=False)
    assert rank_and_size() == (0, 1)
    monkeypatch.setenv(f"{family}_RANK", "1")
    monkeypatch.setenv(f"{family}_SIZE", "1")
    result = CliRunner().invoke(app, ["run", str(CASE1)])
    assert (result.exit_code, result.stderr) == (3, "")
