"""The command line. Exit codes: 0 done, 2 bad input, 3 the solve failed, 130 interrupted."""

import os

# Threads of the linear algebra library would fight with the MPI ranks; it reads these at import.
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
os.environ.setdefault("OMP_NUM_THREADS", "1")

import sys
import time
import traceback
from pathlib import Path
from typing import Annotated, Any

import typer
from rich.console import Console
from typer.core import TyperGroup

from porolub.errors import PorolubError, SceneError, SolveError
from porolub.versions import versions

PATIENCE = 10.0  # s that a rank in error waits for the others to get there too

SceneFile = Annotated[Path, typer.Argument(metavar="SCENE", help="Scene file (TOML).")]
SceneOrSweep = Annotated[Path, typer.Argument(metavar="SCENE", help="Scene or sweep file (TOML).")]
Overrides = Annotated[
    list[str] | None,
    typer.Option(
        "--set",
        metavar="SECTION.KEY=VALUE",
        help="Change the scene, as often as you like: load.force='3 kN/m', mesh.along=600, "
        "solid.base=bonded. film=none (or film=false) takes a whole section away, load.force= a "
        "single key; load={approach='50 um'} replaces a section.",
    ),
]

Petsc = Annotated[str, typer.Option("--petsc", metavar="OPTIONS", help="Options handed to PETSc.")]
Quiet = Annotated[bool, typer.Option("--quiet", help="No progress, no result table.")]


def rank_and_size() -> tuple[int, int]:
    """Return this process's MPI rank and their number, from the launcher, without starting MPI."""
    for rank, size in (
        ("OMPI_COMM_WORLD_RANK", "OMPI_COMM_WORLD_SIZE"),
        ("PMI_RANK", "PMI_SIZE"),
        ("PMIX_RANK", "SLURM_NTASKS"),
    ):
        if rank in os.environ and size in os.environ:
            return int(os.environ[rank]), int(os.environ[size])
    return 0, 1


def _say_error(message: str) -> None:
    if rank_and_size()[0] == 0:
        for line in message.splitlines():
            print(f"porolub: {line}", file=sys.stderr, flush=True)


def _leave_together(code: int) -> None:
    """Let all ranks get here before one exits: mpirun kills the others, message and all, then."""
    if rank_and_size()[1] == 1:
        return
    from mpi4py import MPI

    request = MPI.COMM_WORLD.Ibarrier()
    deadline = time.monotonic() + PATIENCE
    while not request.Test():
        if time.monotonic() > deadline:  # the error is not on all ranks: end the others
            MPI.COMM_WORLD.Abort(code)
        time.sleep(0.01)


class _Commands(TyperGroup):
    """Ends every command that meets a PorolubError with one line and its exit code."""

    def invoke(self, ctx: Any) -> Any:
        try:
            return super().invoke(ctx)
        except PorolubError as error:
            _say_error(str(error))
            _leave_together(error.exit_code)
            raise typer.Exit(error.exit_code) from error
        except KeyboardInterrupt as error:
            _say_error("interrupted.")
            _leave_together(130)
            raise typer.Exit(130) from error
        except (typer.Exit, typer.Abort, typer.TyperException):
            raise
        except Exception:
            if rank_and_size()[1] == 1:
                raise
            traceback.print_exc()  # a defect on one rank must not leave the others waiting
            _leave_together(1)
            raise typer.Exit(1) from None


app = typer.Typer(
    name="porolub",
    cls=_Commands,
    help="Porohyperelastic lubrication: scene file in, coupled solution out.",
    no_args_is_help=True,
    add_completion=False,
    pretty_exceptions_enable=False,
)


@app.command()
def run(
    scene: SceneFile,
    out: Annotated[
        Path | None,
        typer.Option("--out", metavar="DIR", help="If not given: results/<scene file name>."),
    ] = None,
    overrides: Overrides = None,
    petsc: Petsc = "",
    quiet: Quiet = False,
) -> None:
    """Compute a scene and write the results."""
    from porolub.scene import load_scene
    from porolub.study.plan.sweep_file import is_sweep

    if is_sweep(scene):
        raise SceneError(f"{scene}: this is a sweep file; porolub sweep {scene} runs it.")
    checked = load_scene(scene, overrides or ())
    from porolub.run import run_scene

    out_dir = out if out is not None else Path("results") / scene.stem
    raise typer.Exit(run_scene(checked, out_dir, petsc, quiet))


@app.command()
def restart(
    directory: Annotated[Path, typer.Argument(metavar="DIR", help="Output directory of a run.")],
    overrides: Overrides = None,
    petsc: Petsc = "",
    quiet: Quiet = False,
) -> None:
    """Go on with a transient run from its checkpoint, on any number of ranks.

    --set may change how far and how finely it goes: time.end, time.tolerance and the like.
    """
    from porolub.run_transient import restart as go_on

    raise typer.Exit(go_on(directory, overrides or (), petsc, quiet))


@app.command()
def sweep(
    file: Annotated[Path, typer.Argument(metavar="SWEEP", help="Sweep file (TOML).")],
    out: Annotated[
        Path | None,
        typer.Option("--out", metavar="DIR", help="If not given: results/<sweep file name>."),
    ] = None,
    overrides: Overrides = None,
    retry_failed: Annotated[
        bool, typer.Option("--retry-failed", help="Compute failed cases again.")
    ] = False,
    part: Annotated[
        str,
        typer.Option("--part", metavar="K/N", help="Only the K-th of N parts, for job arrays."),
    ] = "",
    petsc: Petsc = "",
    quiet: Quiet = False,
) -> None:
    """Compute the cases of a sweep, as many side by side as there are ranks for.

    The same command again goes on where it was stopped: cases that are done are not repeated.
    """
    from porolub.study.plan.sweep_file import load_sweep
    from porolub.study.sweep import run_sweep

    loaded = load_sweep(file, overrides or ())
    out_dir = out if out is not None else Path("results") / file.stem
    if run_sweep(loaded, out_dir, part, retry_failed, petsc, quiet) != 0:
        raise SolveError(f"{out_dir}: no case converged; table.csv says what each one met with.")


@app.command()
def accuracy(
    scene: SceneFile,
    vary: Annotated[
        str,
        typer.Option(
            "--vary",
            metavar="WHAT",
            help="Some of mesh, degree, time (order of the scheme) and tolerance, separated by "
            "commas. If not given: mesh, and time,tolerance of a transient scene.",
        ),
    ] = "",
    levels: Annotated[
        int, typer.Option("--levels", metavar="N", help="How many meshes or tolerances, 3 to 8.")
    ] = 4,
    quantity: Annotated[
        str,
        typer.Option(
            "--quantity",
            metavar="NAMES",
            help="Numbers of the summary, separated by commas; of a transient run NAME.mean, "
            ".min, .max (of the last period) or .end. If not given: friction and loads.",
        ),
    ] = "",
    effects: Annotated[
        bool,
        typer.Option("--effects", help="Instead: the scene's effects added one at a time."),
    ] = False,
    out: Annotated[
        Path | None,
        typer.Option(
            "--out", metavar="DIR", help="If not given: results/<scene file name>_accuracy."
        ),
    ] = None,
    overrides: Overrides = None,
    petsc: Petsc = "",
    quiet: Quiet = False,
) -> None:
    """Show what accuracy costs: error against time on several meshes or tolerances.

    Cases run side by side, one rank each; the same command again goes on where it was stopped.
    """
    from porolub.study.plan.sweep_file import is_sweep

    if is_sweep(scene):
        raise SceneError(f"{scene}: this is a sweep file; porolub accuracy needs a scene.")
    changes = overrides or []
    if effects:
        if vary or quantity:
            option = "--vary" if vary else "--quantity"
            raise SceneError(f"{option} has no meaning with --effects.")
        from porolub.study.accuracy.effects_study import run_effects

        out_dir = out if out is not None else Path("results") / f"{scene.stem}_effects"
        raise typer.Exit(run_effects(scene, changes, out_dir, petsc, quiet))
    from porolub.study.accuracy.study import run_accuracy

    out_dir = out if out is not None else Path("results") / f"{scene.stem}_accuracy"
    raise typer.Exit(run_accuracy(scene, changes, out_dir, vary, levels, quantity, petsc, quiet))


@app.command()
def check(scene: SceneOrSweep, overrides: Overrides = None) -> None:
    """Validate a scene without computing; show its effects, unknowns and conventions.

    Of a sweep: its axes and cases, which of them are refused, and what they will cost.
    """
    from porolub.scene import load_scene
    from porolub.scene.report import report
    from porolub.study.plan.sweep_file import is_sweep

    if is_sweep(scene):
        from porolub.study.plan.cases import cases_of
        from porolub.study.plan.sweep_file import load_sweep
        from porolub.study.plan.sweep_report import report_sweep

        sweep_of_file = load_sweep(scene, overrides or ())
        cases = cases_of(sweep_of_file)
        if rank_and_size()[0] == 0:
            Console().print(report_sweep(sweep_of_file, cases))
        return
    checked = load_scene(scene, overrides or ())
    if rank_and_size()[0] == 0:
        Console().print(report(checked))


@app.command()
def plot(
    directory: Annotated[
        Path, typer.Argument(metavar="DIR", help="Output directory of a run or a sweep.")
    ],
    period: Annotated[
        int | None,
        typer.Option(
            "--period", metavar="N", min=1, help="Which period; if not given, the last full one."
        ),
    ] = None,
    animate: Annotated[
        bool, typer.Option("--animate", help="Write animation.gif of the period, too.")
    ] = False,
) -> None:
    """Draw the figures of a run or of a sweep."""
    if not directory.is_dir():
        raise SceneError(f"{directory}: there is no such directory.")
    from porolub.io.plots import plot_directory
    from porolub.study.figures.sweep_plots import is_sweep_directory, plot_sweep

    if is_sweep_directory(directory):
        if period is not None or animate:
            option = "--period" if period is not None else "--animate"
            raise SceneError(f"{option}: this is for runs; {directory} is the output of a sweep.")
        for path in plot_sweep(directory):
            print(path)
        return
    for path in plot_directory(directory, period):
        print(path)
    if animate:
        from porolub.io.animation import animate_directory

        print(animate_directory(directory, period))


@app.command()
def info() -> None:
    """Show the versions of all that takes part."""
    if rank_and_size()[0] == 0:
        for name, version in versions().items():
            print(f"{name:<10} {version}")


def main() -> None:
    """Entry point of ``porolub``: one clean line for an error, never a traceback for bad input."""
    try:
        code = app(standalone_mode=False)
    except typer.TyperException as error:  # unknown options and the like
        _say_error(error.format_message())
        _leave_together(error.exit_code)
        code = error.exit_code
    sys.exit(code)


if __name__ == "__main__":
    main()
