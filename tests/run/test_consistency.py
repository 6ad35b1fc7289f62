"""What the files of a run say about each other, and the balances that hold in every scene."""

import numpy as np
import pytest

from tests.run.output import Output

R = 0.1  # m, outer radius of Case 1
DENSITY = 1000.0


def elements(s: np.ndarray) -> np.ndarray:
    """Lengths of the elements along the surface; nodes are ends and middles in turn."""
    return np.diff(s[::2])


def vertex_weights(s: np.ndarray) -> np.ndarray:
    """Integrals of the linear basis functions of the vertices."""
    size = elements(s)
    return (np.append(size, 0.0) + np.insert(size, 0, 0.0)) / 2


def simpson(s: np.ndarray, values: np.ndarray) -> float:
    """Integral of a field that is quadratic on every element."""
    return elements(s) @ (values[:-1:2] + 4 * values[1::2] + values[2::2]) / 6


def test_the_loads_are_the_integrals_of_the_profiles(case1: Output) -> None:
    surface, summary = case1.surface, case1.summary
    assert vertex_weights(surface.s) @ surface.p[::2] == pytest.approx(
        summary["load_fluid"], rel=1e-8)
    assert simpson(surface.s, surface.p_c) == pytest.approx(summary["load_solid"], rel=1e-8)
    total = summary["load_solid"] + summary["load_fluid"]
    assert summary["load_total"] == pytest.approx(total, rel=1e-14)
    assert summary["load_ratio"] == pytest.approx(
        summary["load_fluid"] / summary["load_solid"], rel=1e-14)


def test_the_load_is_the_one_asked_for(case1: Output) -> None:
    assert case1.summary["load_total"] == pytest.approx(1500.0, rel=1e-8)
    assert case1.summary["load_balance_error"] < 1e-8


def test_fluid_is_conserved(case1: Output) -> None:
    assert case1.summary["mass_balance_error"] < 1e-8


def test_the_film_carries_what_the_layer_gives_and_takes(case1: Output) -> None:
    """dQ/ds = V: in the middle of an element Q is the element's own flux."""
    surface = case1.surface
    gained = np.diff(surface.Q[1::2])
    given = (surface.V[::2] * vertex_weights(surface.s))[1:-1]
    np.testing.assert_allclose(gained, given, atol=1e-9 * np.abs(given).max())
    assert np.abs(given).max() > 0.0


def test_the_exchange_adds_up_to_the_flows(case1: Output) -> None:
    surface, summary = case1.surface, case1.summary
    flow = DENSITY * surface.V[::2] * vertex_weights(surface.s)
    out = summary["outflow_left"] + summary["outflow_right"]
    into = summary["inflow_left"] + summary["inflow_right"]
    assert flow[flow > 0].sum() == pytest.approx(out, rel=1e-8)
    assert -flow[flow < 0].sum() == pytest.approx(into, rel=1e-8)
    left = surface.s[::2] < -1e-9
    inward = np.minimum(flow, 0.0)
    middle = inward[len(flow) // 2]  # shared by both sides
    assert -(inward[left].sum() + middle / 2) == pytest.approx(summary["inflow_left"], rel=1e-8)


def test_extremes_are_those_of_the_profiles_and_fields(case1: Output) -> None:
    surface, summary, fields = case1.surface, case1.summary, case1.fields
    assert summary["film_min"] == surface.h.min()
    assert summary["contact_pressure_max"] == pytest.approx(surface.p_c.max(), rel=1e-14)
    assert summary["von_mises_max"] == pytest.approx(fields.von_mises.max(), rel=1e-14)
    assert summary["pressure_max"] == pytest.approx(fields.pressure.max(), rel=1e-12)
    assert summary["pressure_min"] == pytest.approx(fields.pressure.min(), rel=1e-12)
    closed = surface.s[surface.p_c > 0.0]
    assert summary["contact_left"] == pytest.approx(closed.min(), rel=1e-12)
    assert summary["contact_right"] == pytest.approx(closed.max(), rel=1e-12)
    chord = R * (np.sin(closed.max() / R) - np.sin(closed.min() / R))
    assert summary["contact_length"] == pytest.approx(chord, rel=1e-9)
    v0 = summary["approach"]
    assert summary["penetration_length"] == pytest.approx(2 * np.sqrt(v0 * (2 * R - v0)), rel=1e-12)


def test_the_surface_is_the_edge_of_the_fields(case1: Output) -> None:
    surface, fields = case1.surface, case1.fields
    radius = np.hypot(fields.nodes[:, 0], R - fields.nodes[:, 1])
    edge = np.flatnonzero(np.abs(radius - R) < 1e-9)
    edge = edge[np.argsort(fields.nodes[edge, 0])]
    np.testing.assert_allclose(fields.nodes[edge, 0], surface.x, atol=1e-15)
    np.testing.assert_allclose(fields.pressure[edge], surface.p, rtol=1e-9, atol=1e-6)
    np.testing.assert_allclose(np.maximum(case1.gap()[edge], 0.0), surface.h, atol=1e-15)


def test_nothing_penetrates_pulls_or_turns_inside_out(case1: Output) -> None:
    """Gap >= -1e-9 m and p_c >= 0 at every node, one of them zero; J > 0."""
    surface = case1.surface
    assert case1.gap().min() > -1e-9
    assert surface.p_c.min() >= 0.0
    open_ = surface.h > 1e-12
    assert np.all(surface.p_c[open_] == 0.0)
    assert 0.0 < open_.mean() < 1.0
    assert case1.summary["jacobian_min"] > 0.0
    assert case1.fields.jacobian.min() > 0.0
    # the contact is one zone
    closed = np.flatnonzero(surface.p_c > 0.0)
    np.testing.assert_array_equal(np.diff(closed), 1)


def test_the_bath_is_at_ambient_pressure(case1: Output) -> None:
    assert case1.surface.p[0] == 0.0
    assert case1.surface.p[-1] == 0.0


def test_friction_is_dry_friction_on_the_solid_load_and_the_films(case1: Output) -> None:
    summary, dry = case1.summary, case1.scene.contact.friction
    force = dry * summary["load_solid"] + summary["friction_fluid"] * summary["load_fluid"]
    total = summary["friction_coefficient"] * summary["load_total"]
    assert total == pytest.approx(force, rel=1e-12)
