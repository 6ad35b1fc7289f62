"""PETSc options of the solver: a preset's, the user's on top, none ignored."""

from __future__ import annotations

import ctypes
import difflib
from typing import Any

from petsc4py import PETSc

from porolub.errors import SceneError
from porolub.mesh.library import petsc_library
from porolub.solve.presets import DIRECT, FIELDSPLIT, NESTED, PRESETS

NEWTON: dict[str, str] = {
    "snes_linesearch_type": "basic",  # descent stalls at the kinks of contact; see solve/newton.py
}

STEPS: dict[str, str] = {
    "ts_adapt_type": "basic",  # the next step from the last error alone: exact after a restart
    "ts_adapt_safety": "0.63",  # aims at a quarter of the tolerance: few steps are taken back
    "ts_adapt_scale_solve_failed": "0.25",  # a step Newton cannot do is tried at a quarter
}
"""Choice of time steps by TS."""

OF_THE_SCENE: dict[str, str] = {
    "ts_type": "order", "ts_bdf_order": "order", "ts_dt": "first_step", "ts_init_time": "start",
    "ts_max_time": "end", "ts_max_steps": "end", "ts_rtol": "tolerance", "ts_atol": "tolerance",
}
"""What TS would read but not heed, or not survive, and the key of [time] that says it."""

KNOWN = (*NEWTON, *STEPS, *DIRECT, *FIELDSPLIT, *NESTED, "ts_monitor", "ts_view",
         "ts_adapt_monitor", "snes_monitor", "snes_view", "snes_converged_reason", "ksp_monitor",
         "ksp_view", "ksp_converged_reason", "log_view", "mat_mumps_icntl_4", "mat_mumps_icntl_7",
         "options_left")

MARK = "# the rest by porolub, solver preset "

_ours: dict[str, str] = {}  # what use() has put into PETSc's one database


def names_in(text: str) -> list[str]:
    """Names of the options in a command-line style text, without their dash."""
    return [word[1:] for word in text.split()
            if word.startswith("-") and not word[1:2].isdigit() and len(word) > 1]


def set_options(text: str) -> list[str]:
    """Put the user's options and, under them, the defaults into PETSc's database.

    Returns the user's names. Raises SceneError for text that holds no option and for options that
    are the scene's to say.
    """
    names = names_in(text)
    if text.strip() and not names:
        raise SceneError(f"--petsc = {text!r}: options start with a dash, such as "
                         "--petsc \"-snes_monitor\".")
    for name in names:
        if name in OF_THE_SCENE:
            raise SceneError(f"--petsc -{name}: this is for the scene to say, by "
                             f"time.{OF_THE_SCENE[name]}.")
    for name in names:  # from now on the user's, whatever a preset says
        _ours.pop(name, None)
    PETSc.Options().insertString(" ".join(text.split()))
    use("direct")
    return names


def use(preset: str) -> None:
    """Bring a preset into force in place of the one before; the user's options stay."""
    options, wanted = PETSc.Options(), NEWTON | STEPS | PRESETS[preset]
    for key in [k for k in _ours if k not in wanted]:
        options.delValue(key)
        del _ours[key]
    for key, value in wanted.items():
        if key in _ours or not options.hasName(key):
            options.setValue(key, value)
            _ours[key] = value


def forget_options() -> None:
    """Empty PETSc's database: the user's options, too, are those of one run."""
    options = PETSc.Options()
    for key in options.getAll():
        options.delValue(key)
    _ours.clear()


def text_of_options(preset: str) -> str:
    """All options that a run with a preset has in force, the user's first, as PETSc reads them."""
    users = {k: v for k, v in PETSc.Options().getAll().items() if k not in _ours}
    defaults = {k: v for k, v in (NEWTON | STEPS | PRESETS[preset]).items() if k not in users}
    lines = [f"-{k} {v or ''}".rstrip() for k, v in sorted(users.items())]
    lines.append(f"{MARK}{preset}:")
    return "\n".join([*lines, *(f"-{k} {v}" for k, v in defaults.items())])


def users_options(text: str) -> str:
    """The user's part of what ``text_of_options`` wrote."""
    return " ".join(text.split(MARK)[0].split())


def option(name: str) -> str:
    """The value in force of an option; empty where there is none."""
    return str(PETSc.Options().getString(name, ""))


def fixed_steps() -> bool:
    """Whether the user wants steps of one size, as studies of order need them."""
    return option("ts_adapt_type") == "none"


class UnusedOption(SceneError):
    """An option that no solver of the scene reads: wrong for all scenes of its kind."""


def refuse_unused_together(names: list[str], comm: Any) -> None:
    """As ``refuse_unused`` on rank 0, which takes part in every solve; all ranks raise. Collective.
    """
    problem = None
    if comm.rank == 0:
        try:
            refuse_unused(names)
        except SceneError as error:
            problem = str(error)
    problem = comm.bcast(problem)
    if problem is not None:
        raise UnusedOption(problem)


def refuse_unused(names: list[str]) -> None:
    """Raise SceneError if PETSc has read none of the solvers' options by one of these names."""
    library = petsc_library()
    for name in names:
        used = ctypes.c_int(0)
        library.PetscOptionsUsed(None, name.encode(), ctypes.byref(used))
        if not used.value:
            near = difflib.get_close_matches(name, KNOWN, n=1)
            hint = f"; did you mean -{near[0]}?" if near else "."
            if name in KNOWN:
                hint = ": it belongs to another solver.preset or kind of scene."
            raise SceneError(f"--petsc -{name}: no solver of this scene reads that option{hint}")
