"""What the user asks for: a TOML file in, a checked, frozen Scene out. Knows no solver."""

from porolub.scene.compare import MAY_CHANGE, differences
from porolub.scene.effects import effects
from porolub.scene.history import History, value_at
from porolub.scene.read import load_scene, scene_from_dict
from porolub.scene.resolved import write_resolved
from porolub.scene.scene import Scene
from porolub.scene.unknowns import estimate_unknowns

__all__ = [
    "MAY_CHANGE",
    "History",
    "Scene",
    "differences",
    "effects",
    "estimate_unknowns",
    "load_scene",
    "scene_from_dict",
    "value_at",
    "write_resolved",
]
