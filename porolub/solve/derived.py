"""Scalars a tribologist asks for, from a solved model: loads, friction, contact, flows, balances.

Definitions: de Boer et al. 2020, Eqs. 9-14 (flows, loads), 16-19 (friction), 20-22 (lengths).
All collective; results in SI, the same on every rank.
"""

from __future__ import annotations

from dataclasses import replace
from functools import cached_property
from typing import Any

import numpy as np
from mpi4py import MPI
from numpy.typing import NDArray
from petsc4py import PETSc

from porolub.fem.domains import Domain
from porolub.fem.points import Points
from porolub.laws.lubricant import film_thickness
from porolub.solve.balance import FluidBalance, fluid_balance
from porolub.solve.model import Model
from porolub.terms.film import Film

Array = NDArray[np.float64]
ROUNDING = 1e-12  # of the load: a share of the solid below is none
BULK = {"pores", "carry", "streamline stabilisation", "storage", "compressible pores"}


class Derived:
    """Evaluates a state; ``local`` is the physical local vector."""

    def __init__(self, model: Model, x: PETSc.Vec) -> None:
        self.model, self.x = model, x
        self.comm = model.mesh.comm
        self.local = model.system.physical(model.dofs.to_local(x))
        self.film = next((t for t in model.system.terms if isinstance(t, Film)), None)
        if model.surface is not None:
            self.surface = self.at(model.surface.domain)
            self.nodes = model.mesh.boundary_nodes(model.surface.name)
            self.mine = self.nodes[model.mesh.owned[self.nodes]]

    def at(self, domain: Domain) -> Points:
        finite = self.model.system.finite
        return Points(domain, self.model.dofs, self.local, slice(None), finite)

    def total(self, value: float) -> float:
        return float(self.comm.allreduce(float(value)))

    def extreme(self, values: Array, largest: bool) -> float:
        op, start = (MPI.MAX, -np.inf) if largest else (MPI.MIN, np.inf)
        found = values.max(initial=start) if largest else values.min(initial=start)
        return float(self.comm.allreduce(float(found), op=op))

    # -- nodal values on the mesh's nodes -------------------------------------------------
    def nodal(self, name: str) -> Array:
        """(nnode, components) of a field, 0 where it does not live."""
        f = self.model.dofs.fields[name]
        out = np.zeros((len(self.model.mesh.coordinates), f.components))
        out[self.model.dofs.nodes[name]] = self.model.dofs.field(name, self.local)
        return out

    def gap(self) -> Array:
        """(nnode,) gap to the plane, scaled (of use on the lubricated surface only)."""
        plane, mesh = self.model.plane, self.model.mesh
        assert plane is not None
        places = mesh.coordinates + (self.nodal("u") if "u" in self.model.dofs.fields else 0.0)
        return plane.offset - places @ np.asarray(plane.toward) - self.approach()

    def thickness(self) -> Array:
        """(nnode,) thickness of the film, scaled: exactly zero where nodes are in contact."""
        gap = np.maximum(self.gap(), 0.0)
        if "l" in self.model.dofs.fields:
            gap[self.contact_pressure() > 0.0] = 0.0
        return gap

    def approach(self) -> float:
        if "v0" in self.model.dofs.fields:
            return self.model.dofs.scalar_value("v0", self.x)
        return self.model.operation.approach

    def contact_pressure(self) -> Array:
        """(nnode,) contact pressure, exactly zero at open nodes (scaled)."""
        pressure = self.nodal("l")[:, 0]
        return np.where(pressure > np.maximum(self.gap(), 0.0), pressure, 0.0)

    def arc(self) -> Array:
        """(nnode,) signed arc position along the lubricated surface from its middle, scaled."""
        mesh = self.model.mesh
        if mesh.shape is None:
            circle = None if self.model.surface is None else self.model.surface.circle
            return mesh.coordinates[:, 0] if circle is None else circle.arc(mesh.coordinates)
        return (mesh.logical(mesh.coordinates)[:, 0] - 0.5) * mesh.shape.length

    # -- groups of summary keys -------------------------------------------------------------
    def loads(self) -> dict[str, float | None]:
        s, model = self.model.scales, self.model
        solid = fluid = 0.0
        if model.surface is not None and "l" in model.dofs.fields:
            solid = self.total(self.nodal("l")[self.mine, 0] @ model.surface.weights[self.mine])
        if model.surface is not None and "p" in model.dofs.fields:
            fluid = self.total((self.surface.weights * self.surface.value("p")).sum())
        if abs(solid) < ROUNDING * abs(fluid):  # of open nodes: nothing touches
            solid = 0.0
        total = solid + fluid
        target = model.operation.force
        error = abs(total - target) / abs(target) if target else None
        ratio = fluid / solid if solid > 0 else None
        return {"load_total": total * s.force, "load_solid": solid * s.force,
                "load_fluid": fluid * s.force, "load_ratio": ratio,
                "load_balance_error": error}

    def friction(self, loads: dict[str, Any]) -> dict[str, float | None]:
        """mu = (mu_s L_s + T_f) / (L_s + L_f); the fluid's part from the film's shear stress.

        Both act along the local direction of the motion and are summed over the reference surface,
        as the loads are: for a plane that slides, the force that opposes it.  Where a body rotates
        in 3D they are weighted with their distance from the axis over that of the farthest point
        of the surface: the moment about the axis over the radius, for a barrel its largest.
        """
        contact = self.model.scene.contact
        solid = (contact.friction if contact is not None else 0.0) * loads["load_solid"]
        fluid = 0.0
        if solid and self.turns_in_space:
            model = self.model
            assert model.surface is not None
            arms = self.arms(model.mesh.coordinates[self.mine])
            pressure = self.nodal("l")[self.mine, 0] * model.surface.weights[self.mine]
            solid = contact.friction * self.total(pressure @ arms) * model.scales.force
        if self.film is not None:
            at = self.surface
            h, _ = film_thickness(self.film.plane.gap(at))
            U = self.film.operation.entrainment(at.position, at.normal)
            speed = np.linalg.norm(U, axis=-1)
            along = U / np.where(speed > 0, speed, 1.0)[..., None]
            slope = np.einsum("...d,...d->...", at.grad("p"), along)
            stress = self.film.law.shear_stress(h, slope, speed)
            if self.turns_in_space:
                stress = stress * self.arms(at.position)
            fluid = self.total((at.weights * stress).sum()) * self.model.scales.force
        return {"friction_coefficient": _ratio(solid + fluid, loads, "load_total"),
                "friction_fluid": _ratio(fluid, loads, "load_fluid")}

    @property
    def turns_in_space(self) -> bool:
        return self.model.mesh.dim == 3 and self.model.operation.kind == "rotation"

    def arms(self, X: Array) -> Array:
        """(...) distances of points (..., 3) from the axis over the surface's farthest one's."""
        unit = replace(self.model.operation, speed=1.0)  # its velocities are distances
        places = self.model.mesh.coordinates[self.mine]
        farthest = self.extreme(np.linalg.norm(unit.body_velocity(places), axis=-1), True)
        return np.linalg.norm(unit.body_velocity(X), axis=-1) / farthest

    def contact(self) -> dict[str, float | None]:
        model, length = self.model, self.model.scales.length
        out: dict[str, float | None] = dict.fromkeys(
            ("approach", "film_min", "contact_length", "contact_left", "contact_right",
             "penetration_length", "contact_pressure_max"))
        if model.mesh.dim == 3:
            out |= {"contact_area": None, "contact_width": None}
        if model.surface is None:
            return out
        circle = model.surface.circle
        radius = circle.radius * length if circle is not None else None
        v0 = self.approach() * length
        gap = self.thickness()[self.mine]
        out |= {"approach": v0, "film_min": self.extreme(gap, False) * length}
        if radius:
            out["penetration_length"] = 2.0 * np.sqrt(v0 * (2 * radius - v0)) if v0 > 0 else 0.0
        if "l" not in model.dofs.fields:
            return out
        pressure = self.contact_pressure()[self.mine]
        out["contact_pressure_max"] = self.extreme(pressure, True) * model.scales.pressure
        if model.mesh.dim == 3:
            out |= self._patch(pressure > 0.0)
        s = self.arc()[self.mine][pressure > 0.0] * length
        left, right = self.extreme(s, False), self.extreme(s, True)
        out["contact_length"] = 0.0
        if left <= right:
            out |= {"contact_left": left, "contact_right": right}
            chord = (lambda a: radius * np.sin(a / radius)) if radius else (lambda a: a)
            out["contact_length"] = float(chord(right) - chord(left))
        return out

    def _patch(self, closed: NDArray[np.bool_]) -> dict[str, float | None]:
        """What only a contact in 3D has; ``closed`` tells of the nodes ``mine``."""
        model, length = self.model, self.model.scales.length
        assert model.surface is not None
        z = model.mesh.coordinates[self.mine[closed], 2]
        width = self.extreme(z, True) - self.extreme(z, False)
        return {"contact_area": self.total(model.surface.weights[self.mine] @ closed) * length**2,
                "contact_width": max(width, 0.0) * length}

    def exchange(self) -> Array:
        """(nnode,) V, flow out of the layer per area (scaled), at the pressure nodes."""
        flow, weights = self.outflow(), self.pressure_weights()
        heavy = weights > 1e-9 * weights.max(initial=0.0)  # corners of triangle6 weigh nothing
        return np.divide(flow, weights, out=np.zeros_like(flow), where=heavy)

    def outflow(self) -> Array:
        """(nnode,) flow out of the layer (scaled) by pressure node.

        The consistent nodal flux: what the fluid mass rows of the layer alone leave over.
        """
        model = self.model
        out = np.zeros(len(model.mesh.coordinates))
        if model.scene.pores is not None:
            r = model.dofs.sum_local(model.system.local_residual(self.local, BULK))
            nodes = np.intersect1d(self.nodes, model.dofs.nodes["p"])
            out[nodes] = -r[model.dofs.base["p"][nodes]]
        return out

    def pressure_weights(self) -> Array:
        """(nnode,) integral of each pressure basis function over the surface."""
        dofs, domain = self.model.dofs, self.surface.domain
        values = domain.tables(dofs.fields["p"].degree).value[domain.variant]
        share = np.einsum("eq,eqi->ei", domain.weights, values).ravel()
        entity = dofs.entity_dofs("p", domain).ravel()
        local = np.zeros(dofs.size_local)
        np.add.at(local, entity[entity >= 0], share[entity >= 0])
        total = dofs.sum_local(local)
        weights = np.zeros(len(self.model.mesh.coordinates))
        weights[dofs.nodes["p"]] = dofs.field("p", total)[:, 0]
        return weights

    def flows(self) -> dict[str, float | None]:
        """Mass flows through the surface, left and right of the middle, and their balance."""
        keys = ("inflow_left", "inflow_right", "outflow_left", "outflow_right")
        model = self.model
        if "p" not in model.dofs.fields:
            return dict.fromkeys((*keys, "mass_balance_error"))
        out: dict[str, float | None] = dict.fromkeys(keys, 0.0)
        through = 0.0
        if self.model.surface is not None and model.scene.pores is not None:
            flow, s = self.outflow()[self.mine], self.arc()[self.mine]
            unit = model.scales.volume_flow * model.scene.fluid_density
            # a node in the middle belongs to both sides, so that reversed motion mirrors them
            right = 0.5 + 0.5 * np.where(np.abs(s) < 1e-9, 0.0, np.sign(s))
            for side, part in (("left", 1.0 - right), ("right", right)):
                out[f"inflow_{side}"] = -self.total(part @ np.minimum(flow, 0.0)) * unit
                out[f"outflow_{side}"] = self.total(part @ np.maximum(flow, 0.0)) * unit
            through = self.total(np.abs(flow).sum())
        found = self.balance()
        found = replace(found, through=found.through + through)
        return out | {"mass_balance_error": found.error}

    def balance(self) -> FluidBalance:
        """What the pores and the film hold, and what enters through all boundaries."""
        return fluid_balance(self.model, self.local, self.held)

    @cached_property
    def held(self) -> dict[str, Array]:
        """Contents by term; needed in time only."""
        system = self.model.system
        return system.content(self.local) if system.rate else {}

    def extremes(self) -> dict[str, float | None]:
        model = self.model
        out: dict[str, float | None] = {"pressure_max": None, "pressure_min": None}
        if "p" in model.dofs.fields:
            p = model.dofs.field("p", self.local) * model.scales.pressure
            out = {"pressure_max": self.extreme(p, True), "pressure_min": self.extreme(p, False)}
        return out


def _ratio(force: float, loads: dict[str, Any], load: str) -> float | None:
    """A force over a load; None where that load is no more than rounding."""
    size = abs(loads["load_solid"]) + abs(loads["load_fluid"])
    return force / loads[load] if abs(loads[load]) > 1e-10 * size else None


def scalars(model: Model, x: PETSc.Vec) -> dict[str, Any]:
    """All physical scalars of the summary."""
    return scalars_of(Derived(model, x))


def scalars_of(d: Derived) -> dict[str, Any]:
    """As ``scalars``, of a state that is evaluated already."""
    loads = d.loads()
    return {**loads, **d.friction(loads), **d.contact(), **d.flows(), **d.extremes()}


