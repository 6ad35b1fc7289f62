"""One call from a scene to its steady state: coarse start, then finer meshes.

On a structured shape the scene is first solved on a coarse mesh from zero, and the solution
carried to the scene's mesh (graded toward the contact edges found on the way, if asked).  On a
user's mesh the start-up runs on that mesh itself.  Given neighbours, solutions of like scenes, the
solve starts from a blend of them on the scene's mesh, and from zero only if that fails.
"""

from __future__ import annotations

import logging
import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Any

import numpy as np
from mpi4py import MPI
from petsc4py import PETSc

from porolub.mesh import build_mesh
from porolub.solve.coarser import with_coarser
from porolub.solve.derived import scalars
from porolub.solve.estimate import Numbers, mesh_error
from porolub.solve.levels import ALONE, Level, levels_of
from porolub.solve.linear import Linear, final_preset
from porolub.solve.model import Model, build_model, lubricated_name, scales_of
from porolub.solve.neighbours import Neighbour, blended, blended_edges
from porolub.solve.newton import Clock, Newton, NewtonResult
from porolub.solve.options import refuse_unused_together, set_options
from porolub.solve.place import place_in_words
from porolub.solve.report import NewtonRecord
from porolub.solve.scales import Scales
from porolub.solve.startup import LIFTED, PRESSED_IN, Starter, StartUp
from porolub.solve.surface import typical_thickness
from porolub.solve.transfer import Snapshot, restore, snapshot
from porolub.solve.zones import contact_edges

log = logging.getLogger(__name__)
FAILURES_ALLOWED = 2  # meshes without a steady state before the sequence is given up
EDGE_SIZE = 10e-6  # m; of the smallest elements unless the scene says
EDGES_MOVED = 0.1  # thicknesses a place may lie off the one the mesh was refined toward
HOPE = 3  # iterations from neighbours in which no update gets smaller
WARM_ITERATIONS = 15  # of Newton from a blend of neighbours, before it is given up


@dataclass(frozen=True)
class Found:
    """What a mesh of the sequence hands to the next; nothing yet by default."""

    result: NewtonResult = field(default_factory=lambda: NewtonResult(False, 0))
    data: Snapshot | None = None
    edges: tuple[float, ...] = ()
    newton_iterations: int = 0
    linear_iterations: int = 0
    rejected: int = 0
    preset: str = ""  # of the linear solver
    numbers: dict[str, Any] = field(default_factory=dict)  # those of a summary, if it converged


@dataclass
class Outcome:
    """How a solve ended.

    converged; message: a sentence for the user; model and x: the last state reached (kept on
    failure too); newton: every iteration; totals of iterations and of start-up steps.
    """

    converged: bool
    message: str
    model: Model
    x: PETSc.Vec
    newton: list[NewtonRecord]
    newton_iterations: int
    linear_iterations: int
    rejected_steps: int
    clock: Clock
    edges: tuple[float, ...] = ()  # where the mesh was refined, mesh units
    status: str = ""  # converged | failed | interrupted; by default from ``converged``
    time_steps: int = 0
    overall: dict[str, float] = field(default_factory=dict)  # what the summary says of all steps
    errors: dict[str, float] = field(default_factory=dict)  # of the summary's numbers, absolute, SI

    def __post_init__(self) -> None:
        self.status = self.status or ("converged" if self.converged else "failed")

    def destroy(self) -> None:
        """Free all that PETSc holds."""
        _free(self.model, self.x)


class SteadySolver:
    """Runs the mesh sequence of one scene."""

    def __init__(self, scene: Any, comm: Any,
                 observe: Callable[[NewtonRecord], None] = lambda record: None,
                 announce: Callable[[str, float], None] = lambda name, fraction: None,
                 user_options: Sequence[str] = (),
                 stop: Callable[[Any], str] = lambda comm: "",
                 neighbours: Sequence[Neighbour] = ()) -> None:
        """``user_options``: names of PETSc options that some solver must read; ``stop``: asked
        in every Newton iteration whether to give up, see Newton; ``neighbours``: what to start
        from instead of zero, on a structured mesh."""
        self.scene, self.comm, self.announce = scene, comm, announce
        self.neighbours, self.warm = list(neighbours), False  # whether they led to the solution
        self.records: list[NewtonRecord] = []
        self._observe, self._user_options, self._stop = observe, list(user_options), stop
        if not PETSc.Options().hasName("pc_type"):
            set_options("")
        self.clock = Clock()
        self.newton_iterations = self.linear_iterations = self.rejected = 0

    def observe(self, record: NewtonRecord) -> None:
        self.records.append(record)
        self._observe(record)

    def solve(self) -> Outcome:
        """Solve the scene. Raises SceneError for a scene the mesh or the model refuses."""
        return self._from_neighbours() or self._from_zero()

    def _from_neighbours(self) -> Outcome | None:
        """On the scene's mesh at once; None without neighbours, or where Newton fails from them."""
        if not self.neighbours:
            return None
        self.announce("from neighbours", 0.0)
        edges = tuple(e / self.scales.length for e in blended_edges(self.neighbours))
        model = self.model(edges)
        found = self._warm(model, blended(model, self.neighbours))
        if found is not None and self._moved(model, found[0], edges):
            data, edges = snapshot(model, found[0]), contact_edges(model, found[0])
            _free(model, found[0])
            model = self.model(edges)
            found = self._warm(model, restore(model, data))
        if found is None:
            log.info("Newton failed from the neighbours; starting from zero")
            model.destroy()
            return None
        refuse_unused_together(self._user_options, self.comm)
        self.warm = True
        last = levels_of(self.scene)[-1]
        errors = self._errors(last, {last: scalars(model, found[0])}, model, found[0])
        return self._outcome(found[1], model, found[0], edges, errors)

    def _warm(self, model: Model, x: PETSc.Vec) -> tuple[PETSc.Vec, NewtonResult] | None:
        """Newton from x, in place; None, and x freed, if it does not converge soon."""
        newton = Newton(model.system, self.clock, self.observe, self._stop, linear=Linear(model))
        result = Starter(model, newton).tried(x, "from neighbours", WARM_ITERATIONS, HOPE)
        self.newton_iterations += newton.iterations
        self.linear_iterations += newton.linear_iterations
        newton.destroy()
        if result.converged:
            return x, result
        self.rejected += 1
        x.destroy()
        return None

    def _moved(self, model: Model, x: PETSc.Vec, edges: tuple[float, ...]) -> bool:
        """Whether the mesh is refined elsewhere than the solution on it asks for. Collective."""
        if not levels_of(self.scene)[-1].graded:
            return False
        now = contact_edges(model, x)
        return any(min((abs(e - f) for f in edges), default=np.inf) > EDGES_MOVED for e in now)

    def _from_zero(self) -> Outcome:
        """Through the mesh sequence."""
        scales = self.scales
        before = Found()
        levels = levels_of(self.scene)
        failures = 0
        numbers: dict[Level, Numbers] = {}
        for number, level in enumerate(levels):
            last = number == len(levels) - 1
            self.announce(level.name, (number + 1) / len(levels))
            if not last and self.comm.size > 1 and level.cells < ALONE[scales.dim]:
                model, x, found = None, None, self._on_one_rank(level, scales, before)
            else:
                model, x, found = self._run(level, scales, before, self.comm, hand_on=not last)
            self.newton_iterations += found.newton_iterations
            self.linear_iterations += found.linear_iterations
            self.rejected += found.rejected
            if last or found.preset == final_preset(self.scene):
                refuse_unused_together(self._user_options, self.comm)
            failures += not found.result.converged
            numbers[level] = found.numbers
            if last or failures == FAILURES_ALLOWED:
                if model is None:
                    assert found.data is not None
                    model = self._model(level, scales, before.edges, self.comm)
                    x = restore(model, found.data)
                errors = self._errors(level, numbers, model, x)
                return self._outcome(found.result, model, x, before.edges, errors)
            if found.result.converged:
                before = found
            else:
                log.info("no steady state on %s (%s); trying the next mesh", level.name,
                         found.result.why)
            if model is not None:
                _free(model, x)
        raise AssertionError("unreachable: the last level returns")

    def _errors(self, level: Level, numbers: Mapping[Level, Numbers], model: Model, x: PETSc.Vec
                ) -> dict[str, float]:
        """Of the solution x on the last mesh, with the numbers found on it and on those before."""
        node = self._element(level, model) * self.scales.length
        known = []
        while numbers.get(level) and level.along > 1:
            known.append(numbers[level])
            level = level.halved()
        if not known:
            return {}
        return mesh_error(with_coarser(model, x, known, self.clock, self._stop), node)

    def _run(self, level: Level, scales: Any, before: Found, comm: Any,
             hand_on: bool) -> tuple[Model, PETSc.Vec, Found]:
        """Solve on one mesh of the sequence, for a next one if ``hand_on``. Collective."""
        start = time.perf_counter()
        model = self._model(level, scales, before.edges, comm)
        self.clock.add("setup", start)
        linear = Linear(model)
        newton = Newton(model.system, self.clock, self.observe, self._stop, linear=linear)
        x, result, rejected = self._level(model, newton, before.data, level.name)
        data = snapshot(model, x) if hand_on else None
        edges = contact_edges(model, x) if hand_on and result.converged else ()
        found = Found(result, data, edges, newton.iterations, newton.linear_iterations, rejected,
                      linear.preset, scalars(model, x) if result.converged else {})
        newton.destroy()
        return model, x, found

    def _on_one_rank(self, level: Level, scales: Any, before: Found) -> Found:
        """A mesh too small to share: rank 0 solves it alone and tells the others.

        Quicker than in parallel, and the path to the finer meshes does not depend on the ranks.
        """
        found: Found | None = None
        told: Found | Exception | None = None
        if self.comm.rank == 0:
            try:
                model, x, found = self._run(level, scales, before, MPI.COMM_SELF, hand_on=True)
                _free(model, x)
                assert found.data is not None
                told = replace(found, data=found.data.outline())
            except Exception as error:  # told to all ranks, which raise it together
                told = error
        told = self.comm.bcast(told)
        if isinstance(told, Exception):
            raise told
        assert told is not None
        return found or told

    @cached_property
    def scales(self) -> Scales:
        """Scaled units; the thickness of a layer on a user's mesh is measured. Collective."""
        return scales_of(self.scene, self._thickness())

    def _thickness(self) -> float:
        stated = getattr(self.scene.geometry, "thickness", None)
        if stated is not None:
            return float(stated)
        mesh = build_mesh(self.scene, self.comm)
        return typical_thickness(mesh, lubricated_name(self.scene))

    def model(self, edges: tuple[float, ...] = ()) -> Model:
        """The scene on its own mesh, refined toward ``edges`` (arc positions, mesh units)."""
        start = time.perf_counter()
        model = self._model(levels_of(self.scene)[-1], self.scales, edges, self.comm)
        self.clock.add("setup", start)
        return model

    def _model(self, level: Level, scales: Any, edges: tuple[float, ...], comm: Any) -> Model:
        options: dict[str, Any] = {}
        if self.scene.geometry.shape != "file":
            options = {"along": level.along, "across": level.across, "deep": level.deep}
            if level.graded and edges:
                options |= {"edges": edges, "edge_size": self._edge_size(level)}
        mesh = build_mesh(self.scene, comm, length_scale=scales.length, **options)
        return build_model(self.scene, mesh, scales)

    def _edge_size(self, level: Level) -> float:
        """Smallest elements of a graded mesh, in mesh units."""
        finest: float = (self.scene.mesh.edge_size or EDGE_SIZE) / self.scales.length
        return finest * self.scene.mesh.along / level.along

    def _element(self, level: Level, model: Model) -> float:
        """Length along the surface of the elements where contact ends, in mesh units."""
        if model.mesh.shape is None:
            return 0.0
        return self._edge_size(level) if level.graded else model.mesh.shape.length / level.along

    def _level(self, model: Model, newton: Newton, data: Snapshot | None,
               name: str) -> tuple[PETSc.Vec, NewtonResult, int]:
        """State, result and rejected steps on one mesh, from the coarser solution or from zero."""
        starter = Starter(model, newton)
        shared = model.mesh.comm.size == self.comm.size  # as the neighbours are
        if data is None and self.neighbours and shared:  # a coarse mesh forgives more
            x = blended(model, self.neighbours)
            result = starter.tried(x, name, WARM_ITERATIONS, HOPE)
            if result.converged:
                return x, result, starter.rejected
            x.destroy()
        if data is not None:
            x = restore(model, data)
            result = starter.tried(x, name)
            if result.converged:
                return x, result, starter.rejected
            x.destroy()
            x = restore(model, data)
            settle = True
        else:
            x = starter.zero(PRESSED_IN)
            result = starter.straight(x, name)
            if result.converged:
                return x, result, starter.rejected
            x.destroy()
            # with no film between them nothing but contact can carry the plane
            x = starter.zero(LIFTED if self.scene.film is not None else PRESSED_IN)
            settle = False
        if model.surface is None:
            log.info("%s: straight Newton failed (%s); loading in steps", name, result.why)
            x.destroy()
            x = starter.zero(0.0)
            result = starter.loaded(x)
        elif self.scene.pores is not None or self.scene.film is not None:
            log.info("%s: straight Newton failed (%s); starting up in time", name, result.why)
            options = StartUp(first_step=3e-3, moved=0.3, steps=60) if settle else StartUp()
            result = starter.physical(x, settle, options)
        else:
            log.info("%s: straight Newton failed (%s); ramping", name, result.why)
            x.destroy()
            x = starter.zero(PRESSED_IN)
            result = starter.ramped(x)
        return x, result, starter.rejected

    def _advice(self, why: str) -> str:
        """What failed and what to try, in this scene."""
        contact, solid = self.scene.contact, self.scene.solid
        wet = self.scene.pores is not None
        if contact is not None and contact.friction_traction and solid.base == "sliding" and wet:
            tip = ('friction drags a layer that slides on its base, and the suction this causes '
                   'feeds back on the load, so there may be no steady state: try solid.base = '
                   '"bonded", contact.friction_traction = false, a smaller contact.friction or '
                   'conventions.entering = "fresh"')
        elif lubricated_name(self.scene) is None:
            tip = ("try smaller tractions, displacements or pressures on the boundaries, and look "
                   "at the last state in the output")
        else:
            tip = ("try a finer mesh or mesh.grading = \"contact\", a smaller load or speed, and "
                   "look at the last state in the output")
        return f"The steady solve failed: {why}; {tip}."

    def _outcome(self, result: NewtonResult, model: Model, x: PETSc.Vec,
                 edges: tuple[float, ...], errors: dict[str, float]) -> Outcome:
        why = result.why
        if result.place is not None:
            why += f", near {place_in_words(result.place, model.scales.length)}"
        message = "converged" if result.converged else self._advice(why)
        return Outcome(result.converged, message, model, x, self.records,
                       self.newton_iterations, self.linear_iterations, self.rejected, self.clock,
                       edges, errors=errors if result.converged else {})


def _free(model: Model, x: PETSc.Vec) -> None:
    x.destroy()
    model.destroy()
