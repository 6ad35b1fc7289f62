"""The composition root of ``porolub accuracy``: settings -> sweep -> errors -> table, figure."""

from __future__ import annotations

import shlex
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from mpi4py import MPI

from porolub.io.atomic import reported
from porolub.io.figure import save
from porolub.io.terminal import new_console
from porolub.scene import load_scene
from porolub.scene.overrides import path_of
from porolub.study.accuracy.draw_precision import draw_precision
from porolub.study.accuracy.files import write_accuracy
from porolub.study.accuracy.measured import (
    ORDERS_OF_MESHES,
    ORDERS_OF_TOLERANCES,
    Measured,
    Trial,
    measured,
    trial,
)
from porolub.study.accuracy.quantities import default_quantities, read_quantities
from porolub.study.accuracy.recommend import Advice, advise
from porolub.study.accuracy.strategies import Setting, as_options, read_varied, settings_of
from porolub.study.accuracy.tables import level_name, print_accuracy
from porolub.study.plan.cases import cases_of
from porolub.study.plan.definition import Sweep
from porolub.study.plan.named_axis import named_axis
from porolub.study.sweep import run_sweep
from porolub.study.work.journal import rows_of
from porolub.together import on_root

FIGURE = "precision.png"
AXIS = "setting"
_OF_SWEEPS = ("stribeck.png", "curves.png")
"""Figures of a sweep that say nothing of a study: all its cases are the same scene."""


@dataclass(frozen=True)
class Study:
    """An accuracy study as a whole: what was asked and what was found.

    ``scene``: its file, ``overrides``: changes made to it; ``side_by_side``: cases that ran at the
    same time, one rank each.
    """

    title: str
    scene: str
    overrides: tuple[str, ...]
    varied: tuple[str, ...]
    side_by_side: int
    trials: list[Trial]
    found: list[Measured]
    advice: list[Advice]

    def command(self, setting: Setting) -> str:
        """Return the command that runs the scene with a setting."""
        replaced = {path_of(text) for text in setting.changes}
        kept = [text for text in self.overrides if path_of(text) not in replaced]
        options = as_options([*kept, *setting.changes])
        return f"porolub run {shlex.quote(self.scene)} {options}".rstrip()


def run_accuracy(
    path: Path, overrides: Sequence[str], out_dir: Path, varied: str = "", levels: int = 4,
    quantities: str = "", petsc_options: str = "", quiet: bool = False,
) -> int:  # fmt: skip
    """Run a scene on several levels of several strategies and tell what accuracy costs. Collective.

    ``varied``, ``quantities``: names, separated by commas, "" for the usual ones. Writes, beside
    the files of a sweep, accuracy.json, accuracy.csv and precision.png; the same call goes on where
    it was stopped. Returns 0, or 3 if no case converged. Raises SceneError for what cannot be
    studied, and as run_sweep does.
    """
    scene = load_scene(path, overrides)
    wanted = read_quantities(quantities, scene)
    names = read_varied(varied, scene)
    settings = settings_of(scene, names, levels)
    sweep = _sweep(scene, path, overrides, settings)
    code = run_sweep(sweep, out_dir, petsc_options=petsc_options, quiet=quiet)
    comm = MPI.COMM_WORLD

    def evaluate() -> None:
        for name in _OF_SWEEPS:
            (out_dir / name).unlink(missing_ok=True)
        rows = rows_of(out_dir)
        trials = [trial(setting, rows.get(case.key))
                  for setting, case in zip(settings, cases_of(sweep), strict=True)]  # fmt: skip
        found = _measure(trials, wanted or _usual(scene, trials), names)
        study = Study(scene.title, str(path), tuple(overrides), names, comm.size, trials, found,
                      advise(trials, found))  # fmt: skip
        with reported(out_dir, "the results of the study"):
            write_accuracy(out_dir, study)
            if found:
                save(draw_precision(study), out_dir / FIGURE)
        if not quiet:
            print_accuracy(new_console(), study, out_dir)

    on_root(comm, evaluate)
    return code


def _sweep(scene: Any, path: Path, overrides: Sequence[str], settings: Sequence[Setting]) -> Sweep:
    base = scene.resolved()
    if scene.time is not None:  # all runs end at the same time, and pictures are not what is timed
        base["time"] |= {"until": "end", "frames": 0}
    axis = named_axis(AXIS, {s.name: s.values for s in settings})
    return Sweep(f"Accuracy: {scene.title}", base, (axis,), path.resolve(), tuple(overrides),
                 start="zero")  # fmt: skip


def _usual(scene: Any, trials: Sequence[Trial]) -> tuple[str, ...]:
    return default_quantities(scene, [t.summary for t in trials if t.converged])


def _measure(
    trials: Sequence[Trial], quantities: Sequence[str], varied: Sequence[str]
) -> list[Measured]:
    meshes = level_name(varied) != "tolerance"
    orders = ORDERS_OF_MESHES if meshes else ORDERS_OF_TOLERANCES
    found = [measured(quantity, trials, orders) for quantity in quantities]
    return [m for m in found if m is not None]
