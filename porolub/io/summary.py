"""summary.json: the numbers of a run, in SI units."""

import json
import math
from pathlib import Path
from typing import Any

import numpy as np

from porolub.errors import SceneError
from porolub.io.atomic import write_text

KEYS = (
    "status",
    "message",
    "load_total",
    "load_solid",
    "load_fluid",
    "load_ratio",
    "friction_coefficient",
    "friction_fluid",
    "approach",
    "film_min",
    "contact_length",
    "contact_left",
    "contact_right",
    "penetration_length",
    "inflow_left",
    "inflow_right",
    "outflow_left",
    "outflow_right",
    "pressure_max",
    "pressure_min",
    "contact_pressure_max",
    "von_mises_max",
    "jacobian_min",
    "mass_balance_error",
    "load_balance_error",
    "error_estimate",
    "warnings",
    "effects",
    "dofs",
    "ranks",
    "newton_iterations",
    "linear_iterations",
    "time_steps",
    "rejected_steps",
    "wall_time",
    "peak_memory",
    "versions",
)
"""Keys every summary has, in this order; null where a scene does not define the number."""
IN_SPACE = ("contact_area", "contact_width")
"""Keys three-dimensional scenes have, behind contact_right."""
ORDER = tuple(k for key in KEYS for k in ((key, *IN_SPACE) if key == "contact_right" else (key,)))


def write_summary(path: Path, summary: dict[str, Any]) -> None:
    """Write the summary: all of KEYS (null where missing), those of IN_SPACE there are, then any
    further keys.

    What JSON has no number for (NaN, infinity) becomes null. Raises TypeError for a value that
    is no number, text, list or dict of those.
    """
    ordered = {key: summary.get(key) for key in ORDER if key in KEYS or key in summary}
    ordered |= {key: value for key, value in summary.items() if key not in ORDER}
    write_text(path, json.dumps(_plain(ordered), indent=2, allow_nan=False) + "\n")


def read_summary(path: Path) -> dict[str, Any]:
    """Read a summary. Raises SceneError where the file is missing or damaged."""
    try:
        found = json.loads(path.read_text(encoding="utf-8"))
    except FileNotFoundError:
        raise SceneError(
            f"{path.parent}: there is no summary.json, so this is no output of a finished run."
        ) from None
    except (OSError, ValueError) as error:
        raise SceneError(f"{path}: this file is damaged or cannot be read.") from error
    if not isinstance(found, dict):
        raise SceneError(f"{path}: this file holds no summary of a run.")
    return found


def number(summary: dict[str, Any], key: str) -> float | None:
    """Return a number of the summary, None where it is missing, null or not finite."""
    value = summary.get(key)
    if isinstance(value, bool) or not isinstance(value, int | float | np.number):
        return None
    return float(value) if math.isfinite(value) else None


def _plain(value: Any) -> Any:
    """Return the value made of what JSON knows."""
    if isinstance(value, dict):
        return {str(key): _plain(item) for key, item in value.items()}
    if isinstance(value, list | tuple):
        return [_plain(item) for item in value]
    if isinstance(value, np.ndarray | np.generic):
        return _plain(value.tolist())
    if isinstance(value, float) and not math.isfinite(value):
        return None
    return value
