"""How far the numbers of a steady solve are from those of an infinitely fine mesh.

The solve goes through meshes of ever more elements anyway; what a number changed by from each to
the next says how far it still is from its limit, whatever the number is (a goal-oriented estimate
that costs nothing).  With order p it is |q_h - q_2h| / (2^p - 1); p is at least 1 where the meshes
resolve what happens, so the last change itself is taken for the error: rather too large, by 3 for
order 2.  Roache (1994) calls the like a grid convergence index.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

QUANTITIES = ("friction_coefficient", "friction_fluid", "load_total", "load_solid", "load_fluid",
              "load_ratio", "approach", "film_min", "contact_length", "penetration_length",
              "inflow_left", "inflow_right", "outflow_left", "outflow_right", "pressure_max",
              "contact_pressure_max")
"""Numbers of a summary that have an error estimate."""

SLOWEST = 1.2  # ratio of two changes below which convergence is not believed
FASTEST = 4.0  # of order 2; above it the last change is small by chance

Numbers = Mapping[str, float | None]


def mesh_error(levels: Sequence[Numbers], node: float) -> dict[str, float]:
    """Absolute error of each of QUANTITIES on the last mesh, SI.

    ``levels``: the numbers on meshes of which each has twice the elements of the one before, along
    and across, coarsest first (of graded meshes the first may be one that is not graded yet); ``node``: size of the elements where contact ends (m), for its ends
    are nodes.  Empty with fewer than two; quantities without a number are left out.
    """
    if len(levels) < 2:
        return {}
    found = {}
    for name in QUANTITIES:
        values = [v for level in levels[-3:] if (v := level.get(name)) is not None]
        if len(values) == len(levels[-3:]):
            found[name] = _error([float(v) for v in values])
    if found.get("contact_length") is not None and levels[-1]["contact_length"]:
        found["contact_length"] = max(found["contact_length"], node)
    return found


def _error(values: Sequence[float]) -> float:
    """Of the last of two or three values."""
    last = abs(values[-1] - values[-2])
    if len(values) == 2:
        return last
    before = abs(values[-2] - values[-3])
    last = max(last, before / FASTEST)
    ratio = before / last if last > 0.0 else FASTEST
    return last / (max(ratio, SLOWEST) - 1.0) if ratio < 2.0 else last


def relative(errors: Numbers, numbers: Numbers) -> dict[str, float]:
    """Errors over the numbers they belong to; those of numbers that are 0 or missing left out."""
    return {k: e / abs(v) for k, e in errors.items() if e is not None and (v := numbers.get(k))}


def absolute(relative_errors: Numbers, numbers: Numbers) -> dict[str, float]:
    """Relative errors times the numbers; those of numbers that are missing left out."""
    return {k: e * abs(v) for k, e in relative_errors.items()
            if e is not None and (v := numbers.get(k)) is not None}


def of_neighbours(known: Sequence[Numbers], numbers: Numbers) -> dict[str, float]:
    """Absolute errors of numbers that were found next to others on a mesh like theirs.

    ``known``: relative errors of the others; the largest of them counts.
    """
    names = [k for k in QUANTITIES if all(k in errors for errors in known)]
    return absolute({k: max(float(e[k] or 0.0) for e in known) for k in names}, numbers)
