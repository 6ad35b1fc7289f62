"""``porolub restart``: what it hands on, and what becomes of the outcome."""

import sys
from pathlib import Path
from types import ModuleType
from typing import Any

import pytest
from typer.testing import CliRunner

from porolub.cli import app
from porolub.errors import Interrupted, SceneError, SolveError


class Calls(list[tuple[Any, ...]]):
    """Stands for restart: keeps its arguments, then returns or raises ``outcome``."""

    outcome: BaseException | None = None

    def __call__(self, *arguments: Any) -> int:
        self.append(arguments)
        if self.outcome is not None:
            raise self.outcome
        return 0


@pytest.fixture
def calls(monkeypatch: pytest.MonkeyPatch) -> Calls:
    calls, module = Calls(), ModuleType("porolub.run_transient")
    module.restart = calls  # type: ignore[attr-defined]
    monkeypatch.setitem(sys.modules, "porolub.run_transient", module)
    return calls


def test_it_hands_on_directory_overrides_and_options(calls: Calls) -> None:
    words = ["--set", "time.end=8 s", "--set", "time.frames=0", "--petsc", "-ts_monitor", "--quiet"]
    result = CliRunner().invoke(app, ["restart", "results/case2", *words])
    assert result.exit_code == 0
    overrides = ["time.end=8 s", "time.frames=0"]
    assert calls == [(Path("results/case2"), overrides, "-ts_monitor", True)]
    CliRunner().invoke(app, ["restart", "here"])
    assert calls[1:] == [(Path("here"), (), "", False)]


@pytest.mark.parametrize(
    ("end", "code", "said"),
    [
        (SceneError("here: another scene."), 2, "porolub: here: another scene.\n"),
        (SolveError("no convergence."), 3, "porolub: no convergence.\n"),
        (Interrupted("Interrupted by SIGTERM."), 130, "porolub: Interrupted by SIGTERM.\n"),
        (KeyboardInterrupt(), 130, "porolub: interrupted.\n"),
    ],
)
def test_the_outcome_becomes_the_exit_code(
    calls: Calls, end: BaseException, code: int, said: str
) -> None:
    calls.outcome = end
    result = CliRunner().invoke(app, ["restart", "here"])
    assert (result.exit_code, result.stdout, result.stderr) == (code, "", said)
