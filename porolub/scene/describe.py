"""Quantities and histories in words, for reports and messages."""

import json
import math
from typing import Any

from porolub.scene.gait import Gait
from porolub.scene.harmonic import Harmonic
from porolub.scene.history import History, highest_of, lowest_of
from porolub.scene.samples import Samples

_PREFIXES = ((1e9, "G"), (1e6, "M"), (1e3, "k"), (1.0, ""), (1e-3, "m"), (1e-6, "u"), (1e-9, "n"))
_NO_PREFIX = ("rad/s", "m/s")


def readable(value: float, unit: str) -> str:
    """Write an SI value with a prefix, for instance ``58.2 um``."""
    factor, prefixed = _scaled(value, unit)
    return f"{value / factor:.4g} {prefixed}"


def toml_value(value: Any) -> str:
    """Write a value as it stands in a TOML file, shortened if it is long."""
    if isinstance(value, dict):
        text = "{" + ", ".join(f"{k} = {toml_value(v)}" for k, v in value.items()) + "}"
    elif isinstance(value, list | tuple):
        text = "[" + ", ".join(toml_value(v) for v in value) + "]"
    elif isinstance(value, bool | str):
        text = json.dumps(value, ensure_ascii=False)
    else:
        text = str(value)
    return text if len(text) <= 80 else text[:77] + "..."


def describe(history: float | History, unit: str) -> str:
    """Write a constant or a history, for instance ``+- 1 rad/s cosine, 1 Hz``; SI units."""
    if isinstance(history, Harmonic):
        return _harmonic(history, unit)
    if isinstance(history, Samples):
        return _samples(history, unit)
    if isinstance(history, Gait):
        return f"gait {_range(history, unit)}, {readable(history.frequency, 'Hz')}"
    assert isinstance(history, float)
    return readable(history, unit)


def _harmonic(history: Harmonic[float], unit: str) -> str:
    factor, prefixed = _scaled(max(abs(history.mean), abs(history.amplitude)), unit)
    mean = f"{history.mean / factor:.4g} {prefixed} " if history.mean else ""
    swing = f"+- {history.amplitude / factor:.4g} {prefixed} {history.shape}"
    phase = f", phase {math.degrees(history.phase):.4g} deg" if history.phase else ""
    return f"{mean}{swing}, {readable(history.frequency, 'Hz')}{phase}"


def _samples(history: Samples[float], unit: str) -> str:
    span = readable(history.times[-1] - history.times[0], "s")
    smooth = "smooth " if history.interpolation == "smooth" else ""
    repeat = ", repeated" if history.repeat else ""
    count = len(history.times)
    return f"{count} {smooth}samples over {span}, {_range(history, unit)}{repeat}"


def _range(history: History, unit: str) -> str:
    """Write from where to where a history goes."""
    low, high = lowest_of(history).value, highest_of(history).value
    factor, prefixed = _scaled(max(abs(low), abs(high)), unit)
    return f"{low / factor:.4g} ... {high / factor:.4g} {prefixed}"


def _scaled(value: float, unit: str) -> tuple[float, str]:
    """Return the factor and the unit with prefix that suit a value."""
    if unit in _NO_PREFIX:
        return 1.0, unit
    size = abs(value)
    factor, prefix = next((p for p in _PREFIXES if size >= p[0] * 0.9999999), (1.0, ""))
    return factor, f"{prefix}{unit}"
