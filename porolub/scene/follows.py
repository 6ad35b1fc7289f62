"""Defaults that follow from other sections of a scene."""

from typing import Any

Tables = dict[str, Any]


def with_what_follows(tables: Tables) -> Tables:
    """Return the tables of a scene file with the defaults that follow from others filled in."""
    for follow in (_symmetry, _entering, _start, _approach):
        tables = follow(tables)
    return tables


def _symmetry(tables: Tables) -> Tables:
    """A cuboid and a straight barrel are slices of something long; a crown has real ends."""
    header, shape = tables.get("scene", {}), tables.get("geometry", {})
    solid = isinstance(header, dict) and header.get("dimension", 2) == 3
    straight = isinstance(shape, dict) and shape.get("shape") in ("block", "barrel")
    if not solid or not straight or "crown_radius" in shape:
        return tables
    return _filled(tables, "geometry", "symmetry", ["front", "back"])


def _entering(tables: Tables) -> Tables:
    """A bonded layer is undisturbed far away: what enters is fresh unless asked otherwise."""
    solid = tables.get("solid")
    if isinstance(solid, dict) and solid.get("base") == "bonded":
        return _filled(tables, "conventions", "entering", "fresh")
    return tables


def _start(tables: Tables) -> Tables:
    """What moves has been moving; what is only loaded starts undeformed (see Time)."""
    if "time" not in tables:
        return tables
    return _filled(tables, "time", "start", "steady" if "motion" in tables else "rest")


def _approach(tables: Tables) -> Tables:
    """Under a load from rest the plane starts just clear of a film, or where it touches."""
    time, load = tables.get("time"), tables.get("load")
    from_rest = isinstance(time, dict) and time.get("start") == "rest"
    if not from_rest or not isinstance(load, dict) or "force" not in load:
        return tables
    if "film" in tables:
        return _filled(tables, "time", "approach", "-10 um")
    return _filled(tables, "time", "approach", "0 um") if "contact" in tables else tables


def _filled(tables: Tables, section: str, key: str, value: Any) -> Tables:
    """Return the tables with a key set that the user left out."""
    keys = tables.get(section, {})
    if not isinstance(keys, dict) or key in keys:
        return tables
    return {**tables, section: {**keys, key: value}}
