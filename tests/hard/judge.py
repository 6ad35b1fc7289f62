"""Runs a hard case and says of each criterion whether it holds."""

from __future__ import annotations

import time
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np
from mpi4py import MPI

from porolub.errors import SceneError
from porolub.scene import Scene
from porolub.solve.derived import scalars
from porolub.solve.doubts import UNCERTAIN, doubts
from porolub.solve.gather import gather_surface
from porolub.solve.report import SurfaceData
from porolub.solve.steady import SteadySolver
from tests.hard.case import Case, Verdict, Verdicts
from tests.hard.histories import History, difference_after_restart, history_of
from tests.hard.measures import Measures, measured
from tests.hard.stable import further_change


@dataclass
class Steady:
    """A steady state that was looked for, and what was measured of it."""

    converged: bool
    message: str
    iterations: int
    jacobian: float
    change: float
    values: dict[str, Any]
    doubts: list[str]
    seen: Measures
    surface: SurfaceData | None
    dry_friction: float

    def __getitem__(self, key: str) -> float:
        return float(self.values[key] or 0.0)


def steady_of(scene: Scene) -> Steady:
    """From zero in one call. Raises SceneError for a scene that is refused."""
    outcome = SteadySolver(scene, MPI.COMM_SELF).solve()
    model, x = outcome.model, outcome.x
    surface = gather_surface(model, x)
    assert surface is None or isinstance(surface, SurfaceData)
    values = scalars(model, x)
    found = Steady(outcome.converged, outcome.message, outcome.newton_iterations,
                   model.system.lowest_jacobian,
                   further_change(outcome) if outcome.converged else np.inf,
                   values, doubts(scene, values, outcome.errors), measured(model, x), surface,
                   scene.contact.friction if scene.contact is not None else 0.0)
    outcome.destroy()
    return found


def solved(case: Case, scene: Scene) -> Steady | History:
    return steady_of(scene) if scene.time is None else history_of(scene, case.petsc)


@dataclass
class Trial:
    """A case that is tried in a directory of its own; solved once."""

    case: Case
    directory: Path

    @cached_property
    def found(self) -> Steady | History:
        return solved(self.case, self.case.scene(self.directory))


def judged(trial: Trial) -> Verdicts:
    """Every criterion but the reference; those that do not apply are left out."""
    case, directory, start = trial.case, trial.directory, time.perf_counter()
    try:
        found = trial.found
    except SceneError as error:
        return {"end": asked_for(case.refused, f"exit 2: {error}"), "time": spent(start)}
    verdicts = {"end": end(case, found)}
    if not case.fails and not case.refused:
        verdicts |= criteria(case, found)
        if case.also is not None:
            verdicts["own"] = attempt(lambda: case.also(found) if case.also else "")
        if case.restart is not None:
            verdicts["restart"] = restarted(case, directory, *case.restart)
    return verdicts | {"time": spent(start)}


def restarted(case: Case, directory: Path, stop_at: float, end: float) -> Verdict:
    scene = case.scene(directory, f"time.end={end} s")
    try:
        found = difference_after_restart(scene, directory / "restart", stop_at)
    except AssertionError as error:
        return Verdict(False, str(error).strip().splitlines()[0])
    return Verdict(found <= case.bounds.restart, f"{found:.0e}")


def spent(start: float) -> Verdict:
    return Verdict(True, f"{time.perf_counter() - start:.1f} s")


def attempt(check: Any) -> Verdict:
    try:
        return Verdict(True, check())
    except AssertionError as error:
        return Verdict(False, str(error).strip().splitlines()[0] if str(error) else "does not hold")


def asked_for(part: str, sentence: str) -> Verdict:
    """Whether it ended badly as the case says it must."""
    return Verdict(bool(part) and part in sentence, sentence)


def end(case: Case, found: Steady | History) -> Verdict:
    if case.refused:
        return Verdict(False, "was not refused")
    if not found.converged:
        return asked_for(case.fails, f"exit 3: {found.message}")
    if case.fails:
        return Verdict(False, "converged, though it is said to fail")
    if isinstance(found, Steady):
        # a state that one more iteration changes is none
        steady = found.change < case.bounds.steady
        moves = "" if steady else f", moves by {found.change:.0e}"
        return Verdict(steady, f"{found.iterations} it{moves}")
    return Verdict(True, f"{len(found.records) - 1} steps, {len(found.rejections)} back")


def criteria(case: Case, found: Steady | History) -> Verdicts:
    bounds = case.bounds
    if isinstance(found, Steady):
        seen, lowest, balance = found.seen, found.jacobian, found.values
    else:
        seen = found.worst
        lowest, balance = float(np.nanmin(found["jacobian_min"])), found.overall
    verdicts = {"J": Verdict(lowest > bounds.lowest, f"{lowest:.3f}")}
    measures = (("load", balance.get("load_balance_error"), bounds.load),
                ("fluid", balance.get("mass_balance_error"), bounds.fluid),
                ("contact", seen.contact, bounds.contact),
                ("p along", seen.along / seen.largest, bounds.oscillation),
                ("p across", seen.across / seen.largest, bounds.across))
    for name, value, bound in measures:
        if value is not None:
            verdicts[name] = Verdict(value <= bound, f"{value:.0e}")
    return verdicts


def compared(trial: Trial) -> Verdicts:
    """The largest difference from the refined scene, and of which quantity.

    A steady state that is off by more than is resolved must come with a warning.
    """
    case = trial.case
    try:
        found = trial.found
        finer = solved(case, case.scene(trial.directory, *case.refined))
    except SceneError as error:
        return {"reference": Verdict(False, str(error))}
    if not (found.converged and finer.converged):
        return {"reference": Verdict(False, found.message if finer.converged else finer.message)}
    difference = (difference_of_states(found, finer) if isinstance(found, Steady)
                  else difference_of_runs(found, finer))
    name, worst = max(difference.items(), key=lambda item: item[1])
    text, silent = f"{worst:.1%} {name}", False
    if isinstance(found, Steady) and worst > UNCERTAIN:
        silent = not found.doubts
        text += ", not warned of" if silent else ", warned of"
    return {"reference": Verdict(worst <= case.within and not silent, text)}


def difference_of_states(found: Any, finer: Any) -> dict[str, float]:
    """Loads over the total load (1 N/m at least); where the load is given, also friction over the
    dry one (0.1 at least), the approach over itself or the film's thickness (10 um at least)."""
    def over(key: str, size: float) -> float:
        return abs(found[key] - finer[key]) / size

    total = max(abs(finer["load_total"]), 1.0)
    different = {"L": over("load_total", total), "L_s": over("load_solid", total),
                 "L_f": over("load_fluid", total)}
    if finer.values["load_balance_error"] is None:
        return different
    return different | {
        "mu": over("friction_coefficient", max(finer.dry_friction, 0.1)),
        "v0": over("approach", max(abs(finer["approach"]), finer["film_min"], 1e-5))}


def difference_of_runs(found: Any, finer: Any) -> dict[str, float]:
    """The same, largest over the finer run's steps; all over their largest values."""
    times, out = finer["time"], {}
    for name, key, over in (("L_s", "load_solid", "load_total"),
                            ("L_f", "load_fluid", "load_total"), ("v0", "approach", "approach")):
        other = np.interp(times, found["time"], found[key])
        out[name] = float(np.abs(other - finer[key]).max() / np.abs(finer[over]).max())
    return out
