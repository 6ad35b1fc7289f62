"""Scenes to test with: small ones as tables, and hypothesis strategies for all others."""

import copy
from typing import Any

from hypothesis import strategies as st

ROLLING: dict[str, Any] = {
    "scene": {"title": "rolling", "dimension": 2},
    "geometry": {
        "shape": "sector",
        "outer_radius": "100 mm",
        "thickness": "1 mm",
        "half_angle": "5 deg",
    },
    "mesh": {"along": 300, "across": 30},
    "solid": {"law": "neo-hookean", "shear_modulus": "0.5 MPa", "bulk_modulus": "5 MPa"},
    "pores": {
        "biot": 0.9,
        "permeability": "1 um^3/mm",
        "viscosity": "1 mPa*s",
        "storage": "2.08 1/GPa",
        "carry": True,
    },
    "film": {"viscosity": "1 mPa*s"},
    "contact": {"friction": 0.45},
    "motion": {"kind": "rotation", "speed": "1 rad/s"},
    "load": {"force": "1.5 kN/m"},
}

CUBE: dict[str, Any] = {
    "scene": {"title": "pressed cube", "dimension": 3},
    "geometry": {"shape": "block", "width": "2 mm", "thickness": "1 mm", "depth": "3 mm"},
    "mesh": {"along": 4, "across": 2, "deep": 3},
    "solid": {"law": "linear", "young_modulus": "3 MPa", "poisson_ratio": 0.25},
    "contact": {},
    "load": {"force": "3 kN"},
}


def changed(tables: dict[str, Any], **sections: Any) -> dict[str, Any]:
    """Return a copy with keys of sections changed; a value None takes the section or key away."""
    result = copy.deepcopy(tables)
    for section, keys in sections.items():
        if keys is None:
            result.pop(section, None)
            continue
        table = result.setdefault(section, {})
        for key, value in keys.items():
            if value is None:
                table.pop(key, None)
            else:
                table[key] = value
    return result


def amount(unit: str, low: float, high: float) -> st.SearchStrategy[str]:
    """Quantities in a unit, with all the digits a float has."""
    return st.floats(low, high).map(lambda value: f"{value!r} {unit}")


def _table(required: dict[str, Any], optional: dict[str, Any]) -> st.SearchStrategy[dict[str, Any]]:
    return st.fixed_dictionaries(required, optional=optional)


def _harmonic(unit: str, low: float, high: float, share: float) -> st.SearchStrategy[Any]:
    """Harmonics about means in a range; the amplitude is at most a share of the lowest mean."""
    return _table(
        {
            "mean": amount(unit, low, high),
            "amplitude": amount(unit, -share * abs(low), share * abs(low)),
            "frequency": amount("Hz", 1e-3, 1e3),
        },
        {"shape": st.sampled_from(["sine", "cosine"]), "phase": amount("deg", -360, 360)},
    )


@st.composite
def sample_tables(draw: st.DrawFn, unit: str, low: float, high: float) -> dict[str, Any]:
    """Tables of samples with values in a range, repeated or not."""
    gaps = draw(st.lists(st.floats(1e-3, 10), min_size=1, max_size=6))
    times, values = [draw(st.floats(0, 2))], [draw(st.floats(low, high))]
    for gap in gaps:
        times.append(times[-1] + gap)
        values.append(draw(st.floats(low, high)))
    repeat = draw(st.booleans())
    if repeat:
        values[-1] = values[0]
    return {
        "times": [f"{t!r} s" for t in times],
        "values": [f"{v!r} {unit}" for v in values],
        "interpolation": draw(st.sampled_from(["linear", "smooth"])),
        "repeat": repeat,
    }


def histories(unit: str, low: float, high: float, share: float = 1.0) -> st.SearchStrategy[Any]:
    """Constants, harmonics and samples; with share < 1 none of them changes sign."""
    return (
        amount(unit, low, high) | _harmonic(unit, low, high, share) | sample_tables(unit, low, high)
    )


def _loads(unit: str) -> st.SearchStrategy[Any]:
    gait = _table(
        {
            "profile": st.just("gait"),
            "scale": amount(unit, 1, 1e4),
            "frequency": amount("Hz", 1, 9),
        },
        {"peak": st.floats(4, 20), "trough": st.floats(0.1, 3)},
    )
    return histories(unit, 0.1, 1e4, share=0.9) | gait


_MODULI = st.one_of(
    _table({"shear_modulus": amount("MPa", 0.01, 10), "bulk_modulus": amount("kPa", 1, 1e5)}, {}),
    _table({"young_modulus": amount("MPa", 0.01, 10), "poisson_ratio": st.floats(-0.9, 0.49)}, {}),
)


@st.composite
def scene_tables(draw: st.DrawFn) -> dict[str, Any]:
    """All kinds of valid scenes that need no mesh file."""
    dimension = draw(st.sampled_from([2, 3]))
    shape = draw(st.sampled_from(["sector" if dimension == 2 else "barrel", "block"]))
    small, large = amount("mm", 0.1, 10), amount("cm", 2, 50)
    if shape == "block":
        sides = {"width": large, "thickness": small} | ({"depth": large} if dimension == 3 else {})
        geometry = draw(_table(sides, {}))
    else:
        arc = {
            "outer_radius": large,
            "thickness": small,
            "half_angle": amount("deg", 0.1, 80),
        }
        barrel = {"width": small} if shape == "barrel" else {}
        crown = {"crown_radius": large} if shape == "barrel" else {}
        geometry = draw(_table(arc | barrel, crown))
    count = st.integers(1, 500)
    counts = {"along": count, "across": count} | ({"deep": count} if dimension == 3 else {})
    mesh = draw(_table(counts, {"degree": st.just(2), "pressure_degree": st.sampled_from([1, 2])}))
    solid = draw(_MODULI) | draw(
        _table(
            {"law": st.sampled_from(["linear", "neo-hookean"])},
            {
                "base": st.sampled_from(["sliding", "bonded"]),
                "density": amount("g/cm^3", 0.5, 3),
            },
        )
    )
    tables = {
        "scene": {"title": draw(st.text(max_size=20)), "dimension": dimension},
        "geometry": {"shape": shape} | geometry,
        "mesh": mesh,
        "solid": solid,
    }
    if draw(st.booleans()):
        tables["film"] = draw(
            _table(
                {"viscosity": amount("mPa*s", 0.01, 100)},
                {"shear_film_min": amount("nm", 1, 1000), "squeeze": st.booleans()},
            )
        )
    if draw(st.booleans()):
        tables["contact"] = draw(_table({}, {"friction": st.floats(0, 1)}))
    if "film" in tables or "contact" in tables:
        kind = draw(st.sampled_from(["force", "approach"]))
        loads = _loads("N" if dimension == 3 else "N/m")
        tables["load"] = {kind: draw(loads if kind == "force" else histories("um", -100, 100))}
    if shape != "block" and draw(st.booleans()):
        tables["motion"] = {"kind": "rotation", "speed": draw(histories("rpm", -20, 20))}
    elif draw(st.booleans()):
        tables["motion"] = {"kind": "sliding", "speed": draw(histories("mm/s", -200, 200))}
    if draw(st.booleans()):
        tables["pores"] = draw(
            _table(
                {
                    "biot": st.floats(0.01, 1),
                    "permeability": amount("um^2", 1e-9, 1),
                    "viscosity": amount("Pa*s", 1e-4, 10),
                },
                {"storage": amount("1/GPa", 0, 10), "fluid_density": amount("kg/l", 0.5, 2)},
            )
        )
        if draw(st.booleans()):
            chi = {"porosity": 0.8, "compressibility": "0.1 1/GPa", "storage": "2.08 1/GPa"}
            tables["pores"] |= chi
        tables["pores"]["carry"] = tables.get("motion", {}).get("kind") == "rotation"
        inlet = "inlet" if shape != "block" else "left"
        tables["boundary"] = {
            inlet: draw(
                _table(
                    {},
                    {
                        "displacement": _table({"normal": histories("um", -10, 10)}, {}),
                        "traction": _table({"y": histories("kPa", -10, 10)}, {}),
                        "pressure": histories("kPa", 0, 100),
                    },
                )
            )
        }
    tables["conventions"] = draw(
        _table(
            {},
            {
                "surface_traction": st.sampled_from(["paper", "balanced"]),
                "frame": st.sampled_from(["spatial", "material"]),
                "entering": st.sampled_from(["computed", "fresh"]),
            },
        )
    )
    if draw(st.booleans()):
        tables["time"] = draw(
            _table(
                {"end": amount("min", 0.01, 10)},
                {
                    "tolerance": st.floats(1e-6, 0.5),
                    "order": st.sampled_from([1, 2, 3]),
                    "step_max": amount("s", 1e-3, 1),
                    "first_step": amount("us", 1, 1000),
                    "start": st.sampled_from(["steady", "rest"]),
                    "repeat_tolerance": st.floats(1e-6, 0.5),
                    "frames": st.integers(0, 100),
                },
            )
        )
        if "density" in tables["solid"] and tables["time"].get("order") != 3:
            tables["solid"]["inertia"] = draw(st.booleans())
    return tables
