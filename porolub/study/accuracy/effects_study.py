"""The composition root of ``porolub accuracy --effects``: what each effect of a scene costs."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from mpi4py import MPI

from porolub.io.atomic import reported
from porolub.io.figure import save
from porolub.io.terminal import new_console
from porolub.scene import load_scene
from porolub.study.accuracy.draw_effects import draw_effects
from porolub.study.accuracy.effect_steps import effect_steps
from porolub.study.accuracy.effects_table import costs, print_effects, write_effects
from porolub.study.plan.cases import cases_of
from porolub.study.plan.definition import Sweep
from porolub.study.plan.named_axis import named_axis
from porolub.study.sweep import run_sweep
from porolub.study.work.journal import rows_of
from porolub.together import on_root

FIGURE = "effects.png"
AXIS = "effects"


def run_effects(
    path: Path, overrides: Sequence[str], out_dir: Path, petsc_options: str = "",
    quiet: bool = False,
) -> int:  # fmt: skip
    """Run a scene with its effects added one at a time and tell what each costs. Collective.

    Writes, beside the files of a sweep, effects.csv and effects.png. Returns 0, or 3 if no case
    converged. Raises SceneError for a scene of one effect, and as run_sweep does.
    """
    scene = load_scene(path, overrides)
    steps = effect_steps(scene)
    base = scene.resolved()
    if "time" in base:
        base["time"] |= {"frames": 0}
    axis = named_axis(AXIS, {step.name: step.values for step in steps})
    sweep = Sweep(f"Effects of {scene.title}", base, (axis,), path.resolve(), tuple(overrides),
                  start="zero")  # fmt: skip
    code = run_sweep(sweep, out_dir, petsc_options=petsc_options, quiet=quiet)
    comm = MPI.COMM_WORLD

    def evaluate() -> None:
        rows = rows_of(out_dir)
        found = costs([step.name for step in steps], [rows.get(c.key) for c in cases_of(sweep)])
        with reported(out_dir, "the results of the study"):
            write_effects(out_dir, found)
            if any(cost.converged for cost in found):
                save(draw_effects(scene.title, found), out_dir / FIGURE)
        if not quiet:
            print_effects(new_console(), found, comm.size, out_dir)

    on_root(comm, evaluate)
    return code
