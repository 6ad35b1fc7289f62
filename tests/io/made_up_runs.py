"""Made-up transient runs of the reference scene: histories and frames that look like Case 3."""

from pathlib import Path

import numpy as np

from porolub.solve.report import Array, FieldData, FrameData, SurfaceData

RADIUS, THICKNESS, HALF_ANGLE = 0.1, 1e-3, np.radians(5.0)
LOAD, PERIOD = 1500.0, 1.0


def times(periods: float, step: float = 0.01) -> Array:
    """Times of steps that are half as long around the reversals, at 1/4 and 3/4 of a period."""
    count = round(2 * periods / step)
    even = np.linspace(0.0, periods * PERIOD, count + 1)
    return even - 0.5 * PERIOD * np.sin(4 * np.pi * even / PERIOD) / (4 * np.pi)


def case3(periods: float = 5.0, step: float = 0.01) -> dict[str, Array]:
    """History of a constant load and an oscillating rotation that has settled."""
    t = times(periods, step)
    angle = 2 * np.pi * t / PERIOD
    speed = np.cos(angle)
    late = np.cos(angle - 0.15)
    settling = 0.03 * np.exp(-3 * t / PERIOD)
    mu = 0.205 - 0.03 * np.abs(late) ** 1.2 + settling
    solid = mu * LOAD / 0.45
    anticlockwise, clockwise = np.maximum(late, 0), np.maximum(-late, 0)
    steps = np.diff(t, prepend=np.nan)
    return {
        "time": t,
        "load_total": np.full_like(t, LOAD),
        "load_solid": solid,
        "load_fluid": LOAD - solid,
        "load_ratio": (LOAD - solid) / solid,
        "friction_coefficient": mu,
        "approach": 114.5e-6 + 2e-6 * (mu - 0.19) / 0.015,
        "film_min": np.zeros_like(t),
        "contact_length": 9.07e-3 + 8e-3 * (mu - 0.19),
        "penetration_length": 9.57e-3 + 4e-3 * (mu - 0.19),
        "inflow_left": 1e-4 * (0.25 + 1.5 * anticlockwise**1.5 + 0.1 * clockwise),
        "inflow_right": 1e-4 * (0.25 + 1.5 * clockwise**1.5 + 0.1 * anticlockwise),
        "outflow_left": 1e-4 * (0.05 + 0.6 * clockwise**2),
        "outflow_right": 1e-4 * (0.05 + 0.6 * anticlockwise**2),
        "pressure_max": 1.8e5 - 6e5 * (mu - 0.19),
        "time_step": steps,
        "order": np.where(np.isnan(steps), np.nan, 2.0),
        "newton_iterations": np.where(np.isnan(steps), np.nan, 3.0 + (np.arange(len(t)) % 4 == 0)),
        "rejected_steps": np.where(np.isnan(steps), np.nan, 1.0 * (np.arange(len(t)) % 50 == 7)),
        "speed": speed,
        "load_applied": np.full_like(t, LOAD),
    }


def case4(periods: float = 5.0) -> dict[str, Array]:
    """History of a load and a rotation that both oscillate."""
    data = case3(periods)
    angle = 2 * np.pi * data["time"] / PERIOD
    load = LOAD * (1 + 0.5 * np.sin(angle))
    solid = LOAD * (0.42 + 0.1 * np.sin(angle - 0.9) + 0.03 * np.cos(2 * angle))
    return data | {
        "load_applied": load,
        "load_total": load,
        "load_solid": solid,
        "load_fluid": load - solid,
        "load_ratio": (load - solid) / solid,
        "friction_coefficient": 0.45 * solid / load,
        "contact_length": 9e-3 * (load / LOAD) ** 0.4,
        "penetration_length": 9.5e-3 * (np.roll(load, 8) / LOAD) ** 0.35,
    }


def consolidation() -> dict[str, Array]:
    """A layer at rest under a constant load it feels from t = 0 on; six decades of time."""
    t = np.geomspace(1e-4, 100.0, 61)
    fluid = LOAD * np.exp(-((t / 3.0) ** 0.6))
    return {
        "time": t,
        "load_total": np.full_like(t, LOAD),
        "load_solid": LOAD - fluid,
        "load_fluid": fluid,
        "load_ratio": fluid / (LOAD - fluid),
        "friction_coefficient": 0.45 * (LOAD - fluid) / LOAD,
        "contact_length": 8e-3 + 2e-3 * (1 - fluid / LOAD),
        "penetration_length": 9e-3 + 1e-3 * (1 - fluid / LOAD),
        **{f"{way}flow_{side}": 1e-4 * (way == "out") * fluid / LOAD
           for way in ("in", "out") for side in ("left", "right")},
        "time_step": np.diff(t, prepend=0.0),
        "load_applied": np.full_like(t, LOAD),
    }  # fmt: skip


def write(path: Path, history: dict[str, Array]) -> None:
    """Write a history.csv; NaN becomes an empty cell."""
    rows = zip(*(values.tolist() for values in history.values()), strict=True)
    cells = [",".join("" if v != v else repr(v) for v in row) for row in rows]
    path.write_text("\n".join([",".join(history), *cells]) + "\n", encoding="utf-8")


class MadeUpFrames:
    """Frames of Case 3 at the given times; the pressure follows speed and load."""

    def __init__(self, times: Array, along: int = 60, across: int = 6) -> None:
        self.times = np.asarray(times, dtype=float)
        self._mesh = _mesh(along, across)

    def load(self, k: int) -> FrameData:
        """Return frame k."""
        return frame(k, self.times[k], *self._mesh)


def frame(number: int, time: float, nodes: Array, cells: Array, angle: Array,
          height: Array) -> FrameData:  # fmt: skip
    """One moment on a given mesh; angle along and height (0 bone, 1 surface) of its nodes."""
    phase = 2 * np.pi * time / PERIOD
    rest, speed = 1 - abs(np.cos(phase)), np.cos(phase)
    approach = 115e-6 + 2e-6 * rest
    s = RADIUS * angle
    half = np.sqrt(2 * RADIUS * approach) * 0.95
    push = np.maximum(approach - RADIUS * (1 - np.cos(angle)), 0.0) * height
    push -= 8e-6 * height * np.exp(-(((np.abs(s) - 1.2 * half) / 6e-4) ** 2))
    skew = 1 + 0.15 * speed * s / half
    inside = np.clip(1 - (s / half) ** 2, 0, None)
    suction = 2e4 * np.abs(speed) * np.exp(-(((s - np.sign(speed) * 1.05 * half) / 4e-4) ** 2))
    pressure = (1.6e5 - 1.5e4 * rest) * inside * skew * (0.85 + 0.15 * height) - suction
    fields = FieldData(
        nodes=nodes,
        cells=cells,
        cell_type="quad",
        degree=2,
        displacement=np.stack([np.zeros_like(push), push], axis=-1),
        pressure=pressure,
        jacobian=1 - push / THICKNESS,
        von_mises=2e5 * np.exp(-((s / 4e-3) ** 2)),
        flux=np.zeros((len(s), 2)),
    )
    top = np.flatnonzero(height == 1)
    top = top[np.argsort(s[top])]
    touching = np.abs(s[top]) < half
    gap = np.maximum(RADIUS * (1 - np.cos(angle[top])) + push[top] - approach, 1e-7)
    gap[touching] = 0.0
    surface = SurfaceData(
        s=s[top],
        x=RADIUS * np.sin(angle[top]),
        p=pressure[top],
        p_c=np.where(touching, 1.1e5 * inside[top] * (1 + 0.05 * rest), 0.0),
        h=gap,
        Q=0.05 * speed * gap,
        V=5e-6 * speed * np.sign(s[top]) * ~touching,
    )
    return FrameData(number, time, fields, surface)


def _mesh(nx: int, ny: int) -> tuple[Array, Array, Array, Array]:
    """Nodes, quad9 cells in VTK's order, angle and height of each node of the sector."""
    angle, height = np.meshgrid(
        np.linspace(-HALF_ANGLE, HALF_ANGLE, 2 * nx + 1),
        np.linspace(0.0, 1.0, 2 * ny + 1),
        indexing="ij",
    )
    radius = RADIUS - THICKNESS * (1 - height)
    nodes = np.stack([radius * np.sin(angle), RADIUS - radius * np.cos(angle)], axis=-1)
    number = np.arange(angle.size).reshape(angle.shape)
    i, j = np.meshgrid(2 * np.arange(nx), 2 * np.arange(ny), indexing="ij")
    vtk = [(0, 0), (2, 0), (2, 2), (0, 2), (1, 0), (2, 1), (1, 2), (0, 1), (1, 1)]
    cells = np.stack([number[i + a, j + b] for a, b in vtk], axis=-1).reshape(-1, 9)
    return nodes.reshape(-1, 2), cells, angle.ravel(), height.ravel()
