"""What the keys of a scene are, for the axes that change them."""

from typing import get_args

from pydantic import BaseModel

from porolub.scene import Scene
from porolub.scene.base import Whole

WORLDS = ("scene", "geometry", "mesh", "conventions", "solver", "time")
"""Sections whose values change the model itself, not what acts on it.

The state of one case is no start for another where they differ.
"""


def is_whole(key: str) -> bool:
    """Return whether a key of the scene takes whole numbers, such as ``mesh.along``."""
    section, _, name = key.partition(".")
    field = Scene.model_fields.get(section)
    members = (field.annotation, *get_args(field.annotation)) if field is not None else ()
    models = [t for t in members if isinstance(t, type) and issubclass(t, BaseModel)]
    return any(
        Whole in model.model_fields[name].metadata for model in models if name in model.model_fields
    )


def parts_worlds(key: str) -> bool:
    """Return whether cases that differ in this key are no neighbours, whatever its values."""
    section, _, name = key.partition(".")
    return not name or section in WORLDS
