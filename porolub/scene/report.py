"""What ``porolub check`` shows: the scene as a tribologist reads it, and what it will cost."""

import math

from rich.console import Group, RenderableType
from rich.table import Table
from rich.text import Text

from porolub.scene.cost import expected_cost, preset_used
from porolub.scene.cost_table import cost_table
from porolub.scene.derived import derived
from porolub.scene.describe import describe, readable
from porolub.scene.effects import effects
from porolub.scene.geometry import MeshFile
from porolub.scene.history import period_of
from porolub.scene.material import Pores
from porolub.scene.scene import Scene
from porolub.scene.transient import Time
from porolub.scene.unknowns import estimate_unknowns

_FIELDS = {
    "displacement": "layer",
    "velocity": "layer (rate of displacement, for inertia)",
    "pore_pressure": "layer, surface included",
    "volume_change": "layer (J - 1 on the pressure's nodes, stabilises carry)",
    "film_pressure": "lubricated surface",
    "contact_pressure": "lubricated surface",
    "approach": "the rigid plane",
}

_READINGS = {
    "surface_traction": {
        "balanced": "skeleton carries p_c + (1 - a) p: the layer feels the whole load",
        "paper": "skeleton carries p_c only, as printed",
    },
    "frame": {
        "spatial": "grad p and Darcy flow in the deformed layer",
        "material": "grad p and Darcy flow in the undeformed layer, as printed",
    },
    "entering": {
        "computed": "material enters with the J that is computed there",
        "fresh": "material enters undeformed, J = 1",
    },
}


def report(scene: Scene) -> RenderableType:
    """Return the report on a checked scene, to be printed with rich."""
    cost = estimate_unknowns(scene)
    preset = preset_used(scene.solver.preset, scene.dimension, cost["total"])
    parts: list[RenderableType] = [
        Text(scene.title, style="bold"),
        Text(_summary(scene)),
        "",
        _effects_table(scene, cost),
        "",
        _unknowns_table(scene, cost),
        "",
        cost_table(expected_cost(scene), preset),
        "",
    ]
    if scene.boundary:
        parts += [_boundaries_table(scene), ""]
    if scene.pores is not None:  # all of them are about the fluid in the pores
        parts.append(_conventions_table(scene))
    notes = [Text(note) for note in _notes(scene)]
    return Group(*parts, *([""] if notes else []), *notes)


def _summary(scene: Scene) -> str:
    shape = scene.geometry
    words = ["plane strain" if scene.dimension == 2 else "three-dimensional", shape.shape]
    sizes = [
        f"{key.replace('_', ' ')} {readable(getattr(shape, key), 'm')}"
        for key in ("outer_radius", "width", "thickness", "depth", "crown_radius")
        if getattr(shape, key, None) is not None
    ]
    if hasattr(shape, "half_angle"):
        sizes.append(f"half angle {math.degrees(shape.half_angle):.4g} deg")
    if isinstance(shape, MeshFile):
        sizes.append(str(shape.path))
    return f"{' '.join(words)}: {', '.join(sizes)}"


def _effects_table(scene: Scene, cost: dict[str, int]) -> Table:
    table = Table(title="Effects", title_justify="left")
    table.add_column("effect")
    table.add_column("on")
    table.add_column("in this scene")
    table.add_column("what it adds")
    on = effects(scene)
    for name, setting, adds in _rows(scene, cost):
        if name in ("squeeze", "inertia") and scene.time is None:
            continue  # they need time
        if name in on:
            table.add_row(name, "[green]yes[/]", setting, adds)
        else:
            table.add_row(name, "no", "", "nothing", style="dim")
    return table


def _rows(scene: Scene, cost: dict[str, int]) -> list[tuple[str, str, str]]:
    """Return effect, its setting and its cost; motion and load only in the form they have."""
    solid, pores, film, contact = scene.solid, scene.pores, scene.film, scene.contact

    def unknowns(field: str) -> str:
        return f"{cost.get(field, 0):,} unknowns"

    stiffness = ""
    if solid is not None:
        g, k = readable(solid.shear_modulus, "Pa"), readable(solid.bulk_modulus, "Pa")
        stiffness = f"{solid.law}, G {g}, K {k}, {solid.base} base"
    film_cost = "acts on the pore pressure at the surface" if pores else unknowns("film_pressure")
    key = "approach" if scene.load is not None and scene.load.approach is not None else "force"
    load_kind = "approach" if key == "approach" else "load"
    load_unit = "m" if load_kind == "approach" else "N/m" if scene.dimension == 2 else "N"
    load = describe(getattr(scene.load, key), load_unit) if scene.load else ""
    motion_kind = scene.motion.kind if scene.motion else "rotation"
    speed_unit = "rad/s" if motion_kind == "rotation" else "m/s"
    speed = describe(scene.motion.speed, speed_unit) if scene.motion else ""
    return [
        ("solid", stiffness, f"{unknowns('displacement')}; stiffness block"),
        (
            "inertia",
            f"density {solid.density:g} kg/m^3" if solid and solid.density else "",
            f"{unknowns('velocity')}; mass block",
        ),
        (
            "pores",
            f"a {pores.biot:g}, kappa {pores.permeability:.4g} m^2" if pores else "",
            f"{unknowns('pore_pressure')}; flow block, coupling to the solid",
        ),
        ("compressibility", _compressible(pores), "density follows pressure in storage and flow"),
        ("carry", "v . grad J", f"{unknowns('volume_change')}; coupling pressure to displacement"),
        ("film", f"eta {readable(film.viscosity, 'Pa s')}" if film else "", film_cost),
        ("squeeze", "dh/dt", "coupling in time"),
        (
            "contact",
            f"friction {contact.friction:g}" if contact else "",
            f"{unknowns('contact_pressure')}; one condition a node",
        ),
        ("friction_traction", _shear(scene), "unsymmetric coupling"),
        (motion_kind, speed, "nothing by itself"),
        (load_kind, load, "1 unknown, the approach" if load_kind == "load" else "nothing"),
        ("time", _time(scene.time), "many steps instead of one"),
    ]


def _compressible(pores: Pores | None) -> str:
    if pores is None or pores.compressibility is None:
        return ""
    return f"chi {pores.compressibility:.4g} 1/Pa, porosity {pores.porosity:g}"


def _shear(scene: Scene) -> str:
    if scene.contact is None or scene.time is None:
        return "shears the layer"
    return f"shears the layer; passes zero speed within {scene.contact.friction_speed:g} m/s"


def _time(time: Time | None) -> str:
    """Write from where to where time runs, how exactly, and when it stops."""
    if time is None:
        return ""
    start = "the steady state" if time.start == "steady" else "rest"
    if time.approach is not None:
        start += f" (plane at {readable(time.approach, 'm')})"
    until = ", until periodic" if time.until == "periodic" else ""
    return (
        f"from {start} to {readable(time.end, 's')}{until}; "
        f"tolerance {time.tolerance:g}, order {time.order}"
    )


def _unknowns_table(scene: Scene, cost: dict[str, int]) -> Table:
    table = Table(title="Unknowns", title_justify="left", show_footer=True)
    table.add_column("field", footer="total")
    table.add_column("where")
    table.add_column("unknowns", justify="right", footer=f"{cost['total']:,}")
    for field, count in cost.items():
        if field != "total":
            table.add_row(field, _FIELDS[field], f"{count:,}")
    return table


def _boundaries_table(scene: Scene) -> Table:
    table = Table(title="Boundary values", title_justify="left")
    table.add_column("boundary")
    table.add_column("key")
    table.add_column("value")
    for path, history in scene.histories().items():
        section, _, rest = path.partition(".")
        if section == "boundary":
            name, _, key = rest.partition(".")
            unit = "m" if key.startswith("displacement") else "Pa"
            table.add_row(name, key, describe(history, unit))
    return table


def _conventions_table(scene: Scene) -> Table:
    table = Table(title="Conventions in force", title_justify="left")
    table.add_column("convention")
    table.add_column("reading")
    table.add_column("meaning")
    for key, meanings in _READINGS.items():
        reading = getattr(scene.conventions, key)
        if key == "entering" and "carry" not in effects(scene):
            continue
        table.add_row(key, reading, meanings[reading])
    return table


def _part_modelled(scene: Scene) -> list[str]:
    """Say which part of the thing is modelled, and what that makes of its loads."""
    planes, half = scene.geometry.symmetry, getattr(scene.geometry, "half", None)
    if not planes:
        return []
    part = "half of the width" if half else "the part between them" if len(planes) > 1 else "half"
    are = "is a symmetry plane" if len(planes) == 1 else "are symmetry planes"
    return [f"{' and '.join(planes)} {are}: loads, flows and contact are those of {part}."]


def _notes(scene: Scene) -> list[str]:
    d, notes = derived(scene), _part_modelled(scene)
    if scene.varies and scene.time is None:
        notes.append("Without [time] all that changes with time is taken at t = 0.")
    if scene.varies and scene.time is not None:
        period = scene.period
        notes.append(
            "What changes with time has no common period."
            if period is None
            else f"All that changes with time repeats after {readable(period, 's')}."
        )
    begin = " at t = 0" if scene.motion is not None and period_of(scene.motion.speed) else ""
    if d.surface_speed is not None:
        notes.append(f"The surfaces slide past each other at {d.surface_speed:.3g} m/s{begin}.")
    if d.consolidation is not None and d.confined_modulus is not None:
        notes.append(
            f"Stiffness in confined compression {readable(d.confined_modulus, 'Pa')}, "
            f"consolidation coefficient {d.consolidation:.3g} m^2/s."
        )
    if d.peclet is not None and d.outlet_layer is not None:
        notes.append(
            f"Peclet number over the thickness {d.peclet:.3g}; "
            f"outlet boundary layer {readable(d.outlet_layer, 'm')}."
        )
        length = d.element_length
        if length is not None and scene.mesh.grading == "none" and length > d.outlet_layer:
            notes.append(
                f"Elements along the surface are {readable(length, 'm')} long, "
                f"{length / d.outlet_layer:.2g} times that layer: expect the outlet to be "
                'smoothed, or set mesh.grading = "contact".'
            )
    return notes
