"""Changes to a scene from the command line: ``section.key=value``.

The value is TOML (``mesh.along=600``, ``motion.speed={mean="1 rad/s", ...}``); what is not TOML is
taken as text (``load.force=3 kN/m``). ``film=none`` or ``film=false`` takes a whole section away,
an empty value (``load.force=``) a single key.
"""

import copy
import tomllib
from collections.abc import Sequence
from typing import Any

from porolub.errors import SceneError


def apply_overrides(tables: dict[str, Any], overrides: Sequence[str]) -> dict[str, Any]:
    """Return the tables of a scene file with the overrides made, in order. Raises SceneError."""
    result = copy.deepcopy(tables)
    for text in overrides:
        _apply(result, text)
    return result


def assign(tables: dict[str, Any], path: str, value: Any) -> None:
    """Set the key at the dotted ``path`` of ``tables`` to a TOML value, as an override does.

    "none" and false take a whole section away, "" a single key. Raises SceneError where the path
    leads through a value that is no table.
    """
    keys = path.split(".")
    is_section = len(keys) == 1 or (keys[0] == "boundary" and len(keys) == 2)
    remove = value == "" or (is_section and value in ("none", False))
    table = tables
    for depth, key in enumerate(keys[:-1]):
        if key not in table and remove:
            return
        table = table.setdefault(key, {})
        if not isinstance(table, dict):
            parent = ".".join(keys[: depth + 1])
            raise SceneError(f"{path} cannot be set: {parent} is no table of keys.")
    if remove:
        table.pop(keys[-1], None)
    else:
        table[keys[-1]] = value


def path_of(text: str) -> str:
    """Return the dotted key that the override ``text`` sets. Raises SceneError if it has none."""
    path, separator, _ = text.partition("=")
    keys = [key.strip() for key in path.split(".")]
    if not separator or not all(keys):
        raise SceneError(
            f'the override "{text}" must be written section.key=value, '
            'for instance load.force="3 kN/m".'
        )
    return ".".join(keys)


def _apply(tables: dict[str, Any], text: str) -> None:
    path = path_of(text)
    try:
        assign(tables, path, _value(text.partition("=")[2]))
    except SceneError as error:
        raise SceneError(f'the override "{text}" does not fit: {error}') from error


def _value(raw: str) -> Any:
    text = raw.strip()
    try:
        parsed = tomllib.loads(f"value = {text}")
    except tomllib.TOMLDecodeError:
        return text
    return parsed["value"] if len(parsed) == 1 else text
