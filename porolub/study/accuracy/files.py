"""accuracy.json and accuracy.csv: all that an accuracy study found, SI."""

from __future__ import annotations

import csv
import io
import json
import math
from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Any

from porolub.io.atomic import write_text
from porolub.study.accuracy.measured import Measured, Trial
from porolub.study.accuracy.tables import unit_of

if TYPE_CHECKING:
    from porolub.study.accuracy.study import Study

JSON = "accuracy.json"
CSV = "accuracy.csv"
COLUMNS = ("quantity", "unit", "strategy", "level", "changes", "status", "unknowns", "time_steps",
           "newton_iterations", "wall", "value", "limit", "error", "relative_error", "order",
           "error_estimate")  # fmt: skip


def write_accuracy(directory: Path, study: Study) -> None:
    """Write both files. In accuracy.csv a row is a setting and a quantity. Raises OSError."""
    write_text(directory / JSON, json.dumps(_plain(_tables(study)), indent=2) + "\n")
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(COLUMNS)
    for row in rows(study):
        writer.writerow(["" if row[c] is None else row[c] for c in COLUMNS])
    write_text(directory / CSV, text.getvalue())


def rows(study: Study) -> Iterator[dict[str, Any]]:
    """Yield a row for each quantity and setting, by COLUMNS; None where there is no value."""
    for found in study.found:
        for n, trial in enumerate(study.trials):
            absolute = found.errors[n] * found.scale
            yield _plain({
                "quantity": found.quantity,
                "unit": unit_of(found.quantity, study),
                **_setting(trial),
                **_cost(trial),
                "value": found.values[n],
                "limit": found.limit,
                "error": absolute,
                "relative_error": found.errors[n] if found.relative else None,
                "order": found.orders[n],
                "error_estimate": found.estimates[n] * found.scale,
            })  # fmt: skip


def _setting(trial: Trial) -> dict[str, Any]:
    setting = trial.setting
    return {"strategy": setting.strategy, "level": setting.level,
            "changes": setting.options, "status": trial.status}  # fmt: skip


def _cost(trial: Trial) -> dict[str, Any]:
    return {"unknowns": trial.unknowns, "time_steps": trial.steps,
            "newton_iterations": trial.newton, "wall": trial.wall}  # fmt: skip


def _tables(study: Study) -> dict[str, Any]:
    return {
        "title": study.title,
        "scene": study.scene,
        "set": study.overrides,
        "varied": study.varied,
        "side_by_side": study.side_by_side,
        "settings": [
            _setting(t) | {"size": t.setting.size, "message": t.message} | _cost(t)
            for t in study.trials
        ],
        "quantities": {m.quantity: _quantity(m, study) for m in study.found},
        "recommendation": [
            {
                "target": advice.target,
                "reached": advice.trial is not None,
                "error": advice.error,
                **({} if advice.trial is None else _recommended(study, advice.trial)),
            }
            for advice in study.advice
        ],
    }


def _recommended(study: Study, number: int) -> dict[str, Any]:
    trial = study.trials[number]
    return {"setting": trial.setting.name, "changes": trial.setting.changes, "wall": trial.wall,
            "command": study.command(trial.setting)}  # fmt: skip


def _quantity(found: Measured, study: Study) -> dict[str, Any]:
    scale = found.scale
    return {
        "unit": unit_of(found.quantity, study),
        "limit": found.limit,
        "limit_uncertainty": found.uncertain * scale,
        "limit_from": found.source,
        "limits": {
            name: {"limit": e.limit, "uncertainty": e.uncertain, "order": e.order}
            for name, e in found.limits.items()
        },
        "values": found.values,
        "errors": found.errors * scale,
        "relative_errors": found.errors if found.relative else None,
        "orders": found.orders,
        "error_estimates": found.estimates * scale,
    }


def _plain(value: Any) -> Any:
    """Return the value made of what JSON knows: None for NaN and infinities."""
    if isinstance(value, dict):
        return {key: _plain(item) for key, item in value.items()}
    if isinstance(value, list | tuple):
        return [_plain(item) for item in value]
    if hasattr(value, "tolist"):
        return _plain(value.tolist())
    if isinstance(value, float):
        if not math.isfinite(value):
            return None
        return int(value) if value.is_integer() and abs(value) >= 1 else value
    return value
