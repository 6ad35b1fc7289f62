"""A scene over time: consistent start, steps to the end, and what is reported on the way."""

from __future__ import annotations

import logging
import time as wall
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

from porolub.errors import SceneError
from porolub.solve.balance import FluidBalance
from porolub.solve.derived import Derived, scalars, scalars_of
from porolub.solve.drive import drive
from porolub.solve.estimate import RunErrors, relative
from porolub.solve.gather import gather_fields, gather_surface
from porolub.solve.linear import Linear
from porolub.solve.newton import Newton
from porolub.solve.options import fixed_steps, refuse_unused_together
from porolub.solve.pacing import ease, given_rate, landing, longest, next_picture, stops
from porolub.solve.periodic import difference_of_periods
from porolub.solve.place import place_in_words
from porolub.solve.report import FrameData, Resume, StepRecord
from porolub.solve.resume import Gathered, owned_values
from porolub.solve.startup import PRESSED_IN, STEP_LIMIT
from porolub.solve.steady import Outcome, SteadySolver
from porolub.solve.stepping import Rejection, Step, TimeStepper
from porolub.solve.watch import Totals, Watch

log = logging.getLogger(__name__)
FIRST = 1e-3  # of the period or the end: the first step from a steady state
SUDDEN = 1e-6  # of the layer's own time and the end: within it a load from rest is put on
RESOLVED = 1e-12  # of the time reached; shorter steps are lost in rounding
AWAY = -10.0  # thicknesses; a plane pulled off so far is gone in no time
AT_A_KINK = 0.1  # of the step before: the first step after a kink
LIFTED = {True: -10e-6, False: 0.0}  # m; where the plane starts from rest with a film, without
NOBODY = Watch()


class TransientSolver:
    """Runs one scene with [time]; ``records`` holds a row per accepted step."""

    def __init__(self, scene: Any, comm: Any, watch: Watch = NOBODY,
                 user_options: Sequence[str] = (),
                 stop: Callable[[Any], str] = lambda comm: "",
                 give_up: Callable[[Any], str] | None = None) -> None:
        """``stop``: asked in every Newton iteration; a reason ends the run in good order.

        ``give_up``: the same for the steady start, which has nothing to keep (may raise).
        """
        self.scene, self.comm, self.watch, self.stop = scene, comm, watch, stop
        self.give_up = give_up or stop
        self.records: list[StepRecord] = []
        self.totals, self._errors = Totals(), RunErrors()
        self._user_options = list(user_options)
        of_newton = [name for name in user_options if not name.startswith("ts_")]
        self.steady = SteadySolver(scene, comm, watch.newton, watch.stage, of_newton,
                                   self.give_up)
        self.clock = self.steady.clock
        self._edges: tuple[float, ...] = ()
        self._frame, self._frame_due = 0, 0.0  # number of the next picture, and when, s
        self._next = 0.0  # scaled: the step to try next

    # -- the run ------------------------------------------------------------------------------
    def solve(self, resume: Resume | None = None,
              records: Sequence[StepRecord] = ()) -> Outcome:
        """From the start, or from a checkpoint (``resume``, of which each rank has its block).

        Raises SceneError for a scene the mesh or the model refuses.
        """
        self.records = list(records)
        if resume is not None:
            self._resume(resume)
        else:
            failed = self._start()
            if failed is not None:
                return failed
        return self._march()

    def destroy(self) -> None:
        """Free all that PETSc holds; the outcome is of no use afterwards."""
        if hasattr(self, "stepper"):
            self.stepper.x.destroy()
            self.stepper.destroy()
            self.model.destroy()

    def _march(self) -> Outcome:
        time = self.scene.time
        self.watch.begin(self.now * self.unit, time.end)
        for stop, kink in stops(self.scene, self.unit):
            if stop < self.now * (1 - RESOLVED):
                continue
            failed = self._march_to(stop)
            if failed is not None:
                return failed
            if kink and self.stepper.lookback.steps:  # not if a checkpoint was written since
                self.stepper.restart(self.now)
                self._next *= AT_A_KINK
            if time.until == "periodic" and self._repeats():
                return self._outcome(True, f"the last period repeats the one before; stopped "
                                           f"after {self.totals.periods} periods")
        if time.until == "periodic":
            return self._outcome(True, "reached the end before a period repeated within "
                                       f"{time.repeats_within:g}: raise time.end to go on")
        return self._outcome(True, "reached the end")

    def _march_to(self, stop: float) -> Outcome | None:
        limit, given = longest(self.scene, self.unit), given_rate(self.scene, self.unit)
        while stop - self.now > RESOLVED * stop:
            size = min(landing(self._next, stop - self.now), limit)
            if given is not None:
                size = given.limit(size, self.stepper.lookback)
            step = self.stepper.step(size)
            if self._user_options:
                refuse_unused_together(self._user_options, self.comm)
                self._user_options = []
            for rejection in step.rejected:
                self._tell_rejected(rejection)
            if step.failed:
                return self._failed(step)
            cut_short = size < self._next and not step.rejected
            self._next = max(self.stepper.next_size, self._next if cut_short else 0.0)
            if not fixed_steps():
                self._next = min(self._next, step.size * ease(step.effort))
            self._accepted(step)
            why = self.stop(self.comm)
            if why:
                return self._outcome(False, why, "interrupted")
            if self._next < RESOLVED * self.now:
                return self._stuck()
            if self._approach() < AWAY:
                return self._pulled_off()
        return None

    @property
    def now(self) -> float:
        """The time reached, scaled."""
        return self.stepper.lookback.entries[0].time

    @property
    def unit(self) -> float:
        """One unit of scaled time, s."""
        return float(self.model.scales.time)

    # -- starts -------------------------------------------------------------------------------
    def _start(self) -> Outcome | None:
        """Build the model and find a consistent state; an Outcome if that fails."""
        time = self.scene.time
        if time.start == "steady":
            found = self.steady.solve()
            if not found.converged:
                found.message = found.message.replace(
                    "The steady solve", "The steady solve at t = 0, where the run starts,")
                return found
            self.model, self._edges = found.model, found.edges
            self._create_stepper()
            self.stepper.restart(0.0, found.x)
            self._errors = RunErrors(relative(found.errors, scalars(found.model, found.x)))
            found.x.destroy()
            self.totals.newton_iterations = found.newton_iterations
            self.totals.linear_iterations = found.linear_iterations
            shortest = min(self.scene.period or np.inf, time.end)
            self._next = (time.first_step or FIRST * shortest) / self.unit
        else:
            failed = self._from_rest()
            if failed is not None:
                return failed
        self._note_start()
        return None

    def _from_rest(self) -> Outcome | None:
        """The undeformed layer feels what acts at t = 0: one very short step of order 1."""
        if self.scene.mesh.grading == "contact":
            raise SceneError('mesh.grading = "contact" needs time.start = "steady": at rest there '
                             "is no contact yet to refine toward.")
        self.model = self.steady.model()
        self._create_stepper()
        system, dofs, time = self.model.system, self.model.dofs, self.scene.time
        x = self.stepper.x
        if "v0" in dofs.fields:
            place = time.approach if time.approach is not None else LIFTED[bool(self.scene.film)]
            dofs.set_scalar("v0", x, place / self.model.scales.length)
        size = SUDDEN * min(1.0, time.end / self.unit)
        drive(self.model, 0.0)
        before = system.physical(dofs.to_local(x))
        system.backward_euler(before, size)  # what was held under a plane not yet moved on
        drive(self.model, size * self.unit)
        if "v0" in dofs.fields and not self.scene.film:  # nothing holds a plane that only touches
            dofs.set_scalar("v0", x, PRESSED_IN)
        newton = Newton(system, self.clock, self.watch.newton, self.give_up,
                        linear=Linear(self.model))
        newton.limits = dict(STEP_LIMIT)
        result = newton.solve(x, "from rest", max_iterations=60)
        self.totals.newton_iterations += newton.iterations
        self.totals.linear_iterations += newton.linear_iterations
        newton.destroy()
        if not result.converged:
            return self._outcome(False, "The load could not be put on the layer at rest: "
                                 f"{result.why}; try a smaller load at t = 0 that grows with "
                                 'time, or time.start = "steady".')
        self.stepper.restart(size)
        self._next = (time.first_step or size * self.unit) / self.unit
        return None

    def _create_stepper(self) -> None:
        time = self.scene.time
        start = wall.perf_counter()
        self.stepper = TimeStepper(self.model, time.order, time.tolerance, self.clock,
                                   stop=self.stop)
        self._gathered = Gathered(self.model)
        self.clock.add("setup", start)

    def _note_start(self) -> None:
        """The state a run starts from is a row of the history too."""
        d = self._evaluated()
        newest = self.stepper.lookback.entries[0]
        held = newest.content
        if "p" in self.model.dofs.fields:
            rows = self.model.dofs.range["p"]
            self.totals.content_start = d.total(sum(c[rows].sum() for c in held.values()))
        self._record(d, Step(newest.time, 0.0, 1, self.totals.newton_iterations))
        self._frames()

    def _resume(self, resume: Resume) -> None:
        """Take up where a checkpoint left off."""
        totals, self._frame = resume.totals, resume.frame
        self._errors = RunErrors.from_totals(totals)
        self._edges = tuple(e / self.steady.scales.length for e in resume.edges)
        self.model = self.steady.model(self._edges)
        self._create_stepper()
        entries = [(state.time / self.unit, owned_values(self.model, state),
                    totals.get(f"gained {k}", 0.0)) for k, state in enumerate(resume.states)]
        self.stepper.sizes = {n: totals[f"largest {n}"] for n in self.stepper.sizes}
        self.stepper.replay(entries)
        self._next = resume.step / self.unit
        self._frame_due = next_picture(self.scene, self.now * self.unit)
        for name, kind in Totals.__annotations__.items():
            setattr(self.totals, name, (int if kind == "int" else float)(totals[name]))

    # -- what is told on the way --------------------------------------------------------------
    def _accepted(self, step: Step) -> None:
        self.totals.time_steps += 1
        self.totals.rejected_steps += len(step.rejected)
        self.totals.newton_iterations += step.newton_iterations
        start = wall.perf_counter()
        self._record(self._evaluated(), step)
        self._frames()
        self.watch.checkpoint(self.resume)
        self.clock.add("output", start)

    def _evaluated(self) -> Derived:
        d = Derived(self.model, self.stepper.x)
        d.held = self.stepper.lookback.entries[0].content
        return d

    def _record(self, d: Derived, step: Step) -> None:
        model, scene = self.model, self.scene
        values = {k: v for k, v in scalars_of(d).items() if isinstance(v, float)}
        t, end = step.time * self.unit, scene.time.end
        t = end if abs(t - end) <= RESOLVED * end else t
        values |= {"time_step": step.size * self.unit, "order": float(step.order),
                   "newton_iterations": float(step.newton_iterations),
                   "rejected_steps": float(len(step.rejected))}
        if model.law is not None:
            values["jacobian_min"] = model.system.lowest_jacobian
        if scene.motion is not None:
            values["speed"] = scene.motion.at(t)
        if scene.load is not None and scene.load.force is not None:
            values["load_applied"] = scene.load.at(t)
        if "p" in model.dofs.fields:
            values |= self._fluid(d.balance(), step)
        if "load_balance_error" in values:
            self.totals.load_error = max(self.totals.load_error, values["load_balance_error"])
        record = StepRecord(t, values)
        self.records.append(record)
        self.watch.step(record)

    def _fluid(self, found: FluidBalance, step: Step) -> dict[str, float]:
        """Content and what has entered since the start, kg/m or kg."""
        totals, gained = self.totals, self.stepper.lookback.entries[0].gained
        swing = abs(found.content - totals.content_start)
        totals.content_swing = max(totals.content_swing, swing)
        totals.through += found.through * step.size
        s = self.model.scales
        mass = s.volume_flow * s.time * self.scene.fluid_density
        return {"fluid_content": (found.content - totals.content_start) * mass,
                "fluid_gained": gained * mass}

    def _tell_rejected(self, rejection: Rejection) -> None:
        t, size = rejection.time * self.unit, rejection.size * self.unit
        log.debug("t = %.6g s: a step of %.3g s is taken back: %s", t, size, rejection.why)
        self.watch.rejected(t, size, rejection.why)

    def _frames(self) -> None:
        """Keep a picture if one is due."""
        now = self.now * self.unit
        if not self.scene.time.frames or now < self._frame_due:
            return
        fields = gather_fields(self.model, self.stepper.x)
        surface = gather_surface(self.model, self.stepper.x)
        number, self._frame = self._frame, self._frame + 1
        self._frame_due = next_picture(self.scene, self.now * self.unit)
        self.watch.frame(FrameData(number, now, fields, surface))

    def _repeats(self) -> bool:
        """Whether the period that has just ended repeats the one before."""
        period = self.scene.period
        assert period is not None  # a rule of the scene
        turns = self.now * self.unit / period
        if abs(turns - round(turns)) > 1e-9 * max(turns, 1.0):
            return False
        self.totals.periods = round(turns)
        within = difference_of_periods(self.records, period)
        log.info("period %d differs from the one before by %.2g", self.totals.periods, within)
        return bool(self.comm.bcast(within <= self.scene.time.repeats_within, root=0))

    def resume(self) -> Resume:
        """All that is needed to go on from here. Collective."""
        entries = self.stepper.lookback.entries
        states = self._gathered.states(entries)
        totals = {k: float(v) for k, v in vars(self.totals).items()}
        totals["linear_iterations"] += self.stepper.newton.linear_iterations
        totals |= {f"gained {k}": e.gained for k, e in enumerate(entries)}
        totals |= {f"largest {name}": v for name, v in self.stepper.sizes.items()}
        totals |= self._errors.totals()
        return Resume(states, tuple(e.order for e in entries), self._next * self.unit,
                      self._frame, tuple(e * self.model.scales.length for e in self._edges),
                      totals)

    # -- how it ended -------------------------------------------------------------------------
    def _failed(self, step: Step) -> Outcome:
        if self.stop(self.comm):
            return self._outcome(False, step.failed, "interrupted")
        t, size = step.time * self.unit, step.size * self.unit
        near = ""
        if step.place is not None:
            near = f", near {place_in_words(step.place, self.model.scales.length)}"
        return self._outcome(False, f"At t = {t:.6g} s even a step of {size:.2g} s fails: "
                             f"{step.failed}{near}; try a smaller time.tolerance or a finer "
                             "mesh, and look at the last state in the output.")

    def _approach(self) -> float:
        """Of a plane that the load moves, in thicknesses."""
        if "v0" not in self.model.dofs.fields:
            return 0.0
        return self.model.dofs.scalar_value("v0", self.stepper.x)

    def _pulled_off(self) -> Outcome:
        """A film resists a pull the less the thicker it is: its plane is gone in finite time."""
        t = self.now * self.unit
        away = -self._approach() * self.model.scales.length
        unit = "N/m" if self.model.scales.dim == 2 else "N"
        return self._outcome(False, f"At t = {t:.6g} s a load of {self.scene.load.at(t):.4g} "
                             f"{unit} has pulled the plane {away * 1e3:.3g} mm off the layer and "
                             "nothing holds it: load.force must press again sooner, or prescribe "
                             "load.approach.")

    def _stuck(self) -> Outcome:
        """Steps that succeed but shrink to nothing would never get anywhere."""
        lowest, place = self.model.system.lowest()
        crushed = ""
        if self.model.law is not None and place:
            crushed = (f" (the lowest volume ratio J is {lowest:.2g}, near "
                       f"{place_in_words(place, self.model.scales.length)})")
        return self._outcome(False, f"At t = {self.now * self.unit:.6g} s the steps have shrunk to "
                             f"{self._next * self.unit:.2g} s: Newton needs ever shorter ones"
                             f"{crushed}; try a smaller load or a finer mesh, and look at the last "
                             "state in the output.")

    def _outcome(self, done: bool, message: str, status: str = "") -> Outcome:
        """The state reached, with what has been counted."""
        t = self.totals
        newton = self.stepper.newton
        return Outcome(done, message, self.model, self.stepper.x, [], t.newton_iterations,
                       newton.linear_iterations + t.linear_iterations,
                       t.rejected_steps, self.clock, self._edges,
                       status or ("converged" if done else "failed"), t.time_steps,
                       self._overall(), self._errors.at_end(self.records, self.scene.time.order))

    def _overall(self) -> dict[str, float]:
        """What the summary says of the whole run."""
        if not self.records:
            return {}
        last, totals = self.records[-1].values, self.totals
        found = {"time": self.records[-1].time}
        if "load_balance_error" in last:
            found["load_balance_error"] = totals.load_error
        if "fluid_content" in last:
            s = self.model.scales
            mass = s.volume_flow * s.time * self.scene.fluid_density
            appeared = abs(last["fluid_content"] - last["fluid_gained"]) / mass
            moved = max(totals.through, totals.content_swing)
            found["mass_balance_error"] = appeared / moved if moved > 0 else 0.0
        if self.scene.period is not None:
            found["periods"] = float(int(found["time"] / self.scene.period * (1 + 1e-9)))
        return found
