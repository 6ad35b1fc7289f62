"""Tables of Case 1 and its relatives on small meshes."""

from typing import Any


def rolling(along: int = 100, across: int = 6, *, base: str = "sliding", speed: float = 1.0,
            traction: str = "balanced", friction: bool = False, **changes: dict[str, Any]
            ) -> dict[str, Any]:
    """Case 1; `changes` are put over the keys of the sections they name."""
    tables: dict[str, dict[str, Any]] = {
        "geometry": {"shape": "sector", "outer_radius": "100 mm", "thickness": "1 mm",
                     "half_angle": "5 deg"},
        "mesh": {"along": along, "across": across},
        "solid": {"law": "neo-hookean", "shear_modulus": "0.5 MPa", "bulk_modulus": "5 MPa",
                  "base": base},
        "pores": {"biot": 0.9, "permeability": "1 um^3/mm", "viscosity": "1 mPa*s",
                  "storage": "2.08 1/GPa", "carry": True},
        "film": {"viscosity": "1 mPa*s"},
        "contact": {"friction": 0.45, "friction_traction": friction},
        "motion": {"kind": "rotation", "speed": f"{speed} rad/s"},
        "load": {"force": "1.5 kN/m"},
        "conventions": {"surface_traction": traction},
    }
    for section, keys in changes.items():
        tables[section] = {**tables.get(section, {}), **keys}
    return tables
