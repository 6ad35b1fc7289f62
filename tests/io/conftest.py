"""Made-up results: a small layer of the reference scene with simple fields on it."""

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from porolub.scene import Scene, scene_from_dict
from porolub.solve.report import FieldData, Report, StepRecord, SurfaceData

RADIUS, THICKNESS, HALF_ANGLE, APPROACH = 0.1, 1e-3, np.radians(5.0), 95e-6


def scene_tables(**changes: Any) -> dict[str, Any]:
    """Tables of a scene file; a section given as None is left out."""
    tables: dict[str, Any] = {
        "scene": {"title": "Case 1: steady rotation under constant load"},
        "geometry": {
            "shape": "sector",
            "outer_radius": "100 mm",
            "thickness": "1 mm",
            "half_angle": "5 deg",
        },
        "mesh": {"along": 6, "across": 2},
        "solid": {"law": "neo-hookean", "shear_modulus": "0.5 MPa", "bulk_modulus": "5 MPa"},
        "pores": {"biot": 0.9, "permeability": "1 um^3/mm", "viscosity": "1 mPa*s"},
        "film": {"viscosity": "1 mPa*s"},
        "contact": {"friction": 0.45},
        "motion": {"kind": "rotation", "speed": "1 rad/s"},
        "load": {"force": "1.5 kN/m"},
    }
    tables |= changes
    return {name: table for name, table in tables.items() if table is not None}


@pytest.fixture
def scene() -> Scene:
    """The reference scene on a tiny mesh."""
    return scene_from_dict(scene_tables())


@pytest.fixture
def dry_scene() -> Scene:
    """The same layer without fluid."""
    title = {"title": "Dry contact"}
    return scene_from_dict(scene_tables(scene=title, pores=None, film=None, motion=None))


@pytest.fixture
def fields() -> FieldData:
    """6 x 2 quad9 cells of the sector; the part below the plane is pushed up to it."""
    nx, ny = 6, 2
    angle, height = np.meshgrid(
        np.linspace(-HALF_ANGLE, HALF_ANGLE, 2 * nx + 1),
        np.linspace(0.0, 1.0, 2 * ny + 1),  # 0 bone, 1 surface
        indexing="ij",
    )
    radius = RADIUS - THICKNESS * (1 - height)
    nodes = np.stack([radius * np.sin(angle), RADIUS - radius * np.cos(angle)], axis=-1)
    nodes = nodes.reshape(-1, 2)
    number = np.arange(len(nodes)).reshape(2 * nx + 1, 2 * ny + 1)
    i, j = np.meshgrid(2 * np.arange(nx), 2 * np.arange(ny), indexing="ij")
    vtk = [(0, 0), (2, 0), (2, 2), (0, 2), (1, 0), (2, 1), (1, 2), (0, 1), (1, 1)]
    cells = np.stack([number[i + a, j + b] for a, b in vtk], axis=-1).reshape(-1, 9)
    push = np.maximum(APPROACH - RADIUS * (1 - np.cos(angle)), 0.0) * height
    displacement = np.stack([np.zeros_like(push), push], axis=-1).reshape(-1, 2)
    x = nodes[:, 0]
    return FieldData(
        nodes=nodes,
        cells=cells,
        cell_type="quad",
        degree=2,
        displacement=displacement,
        pressure=1.6e5 * (1 - (x / 9e-3) ** 2),
        jacobian=1 - push.ravel() / THICKNESS,
        von_mises=2e5 * np.exp(-((x / 4e-3) ** 2)),
        flux=np.stack([1e-6 * x, -2e-6 * x], axis=-1),
    )


@pytest.fixture
def dry_fields(fields: FieldData) -> FieldData:
    """The fields of a scene without fluid."""
    return replace(fields, pressure=None, flux=None)


@pytest.fixture
def surface() -> SurfaceData:
    """Contact within 4 mm of the middle, film outside, reversed flow right of the contact."""
    s = np.linspace(-8e-3, 8e-3, 81)
    contact = np.abs(s) <= 4e-3 + 1e-9
    h = np.where(contact, 0.0, (s**2 - 16e-6) / (2 * RADIUS))
    return SurfaceData(
        s=s,
        x=RADIUS * np.sin(s / RADIUS),
        p=np.where(contact, 1.6e5 * (1 - s**2 / 16e-6), 0.0),
        p_c=np.where(contact, 1.1e5 * (1.01 - s**2 / 16e-6), 0.0),
        h=h,
        Q=0.05 * h * np.where((s > 0) & (s < 4.5e-3), -0.2, 1.0),
        V=np.where(contact, 0.0, 5e-6 * np.sign(s)),
    )


@pytest.fixture
def summary() -> dict[str, Any]:
    """Numbers as a solve reports them, SI."""
    return {
        "status": "converged",
        "message": "Converged in 14 Newton iterations.",
        "load_total": 1500.0,
        "load_solid": 562.5,
        "load_fluid": 937.5,
        "load_ratio": 937.5 / 562.5,
        "friction_coefficient": 0.1686,
        "friction_fluid": 3.2e-4,
        "approach": APPROACH,
        "film_min": 0.0,
        "contact_length": 8.125e-3,
        "contact_left": -4.125e-3,
        "contact_right": 4.0e-3,
        "penetration_length": 8.718e-3,
        "inflow_left": 1.5e-4,
        "inflow_right": 0.25e-4,
        "outflow_left": 0.5e-5,
        "outflow_right": 6.5e-5,
        "pressure_max": 1.657e5,
        "pressure_min": -2.0e4,
        "contact_pressure_max": 1.1e5,
        "von_mises_max": 2.4e5,
        "jacobian_min": 0.9512,
        "mass_balance_error": 3e-12,
        "load_balance_error": 1.2e-13,
        "effects": ["solid", "pores", "film", "contact", "rotation", "load"],
        "dofs": {"u": 130, "p": 21, "l": 13, "v0": 1, "total": 165},
        "ranks": 2,
        "newton_iterations": 14,
        "linear_iterations": 15,
        "time_steps": 0,
        "rejected_steps": 0,
        "wall_time": {
            "setup": 1.2,
            "assembly": 2.31,
            "linear_solve": 71.9,
            "output": 0.9,
            "total": 76.31,
        },
        "peak_memory": 6.5e8,
        "versions": {"porolub": "0.1.0"},
    }


@pytest.fixture
def report(summary: dict[str, Any], fields: FieldData, surface: SurfaceData) -> Report:
    """All of it."""
    history = [StepRecord(0.0, {"load_total": 1500.0})]
    return Report(summary=summary, fields=fields, surface=surface, history=history)


@pytest.fixture
def dry_report(summary: dict[str, Any], dry_fields: FieldData, surface: SurfaceData) -> Report:
    """A run without fluid: contact pressure and gap are all there is on the surface."""
    zero = np.zeros_like(surface.s)
    fluid = ("load_fluid", "inflow", "outflow", "pressure_m", "friction_fluid", "mass")
    numbers = {key: v for key, v in summary.items() if not key.startswith(fluid)}
    dry = replace(surface, p=zero, Q=zero, V=zero)
    return Report(summary=numbers, fields=dry_fields, surface=dry)
