"""A scene with nothing left to assume: every key, defaults included, with SI units."""

import hashlib
import json
from functools import lru_cache
from pathlib import Path
from typing import TYPE_CHECKING, Any

import tomli_w

from porolub.scene.geometry import MeshFile

if TYPE_CHECKING:
    from porolub.scene.scene import Scene

LENGTH_OF_RUN = ("end", "until", "repeat_tolerance", "frames")


def resolved(scene: "Scene") -> dict[str, Any]:
    """Return the scene as the tables of a scene file; read again it gives an equal scene.

    Absent sections and keys that do not apply to the shape are left out.
    """
    tables = scene.model_dump(
        mode="json", exclude_none=True, context={"dimension": scene.dimension}
    )
    mesh = tables["mesh"]
    if isinstance(scene.geometry, MeshFile):
        del mesh["along"], mesh["across"], mesh["element"]
    if isinstance(scene.geometry, MeshFile) or scene.dimension == 2:
        del mesh["deep"]
    for boundary in tables["boundary"].values():
        if scene.dimension == 2 and isinstance(boundary.get("traction"), dict):
            boundary["traction"].pop("z", None)
    if scene.dimension == 2:
        tables.get("motion", {}).pop("axis", None)
    if not tables["boundary"]:
        del tables["boundary"]
    return tables


def write_resolved(scene: "Scene", path: str | Path) -> None:
    """Write the resolved scene as TOML."""
    Path(path).write_text(tomli_w.dumps(resolved(scene)), encoding="utf-8")


def digest(scene: "Scene") -> str:
    """Return a SHA-256 of all that changes the answer: a mesh file or table by its content.

    Left out are the title, the solver and what only decides how long a run is followed and what
    is kept of it.
    """
    tables = resolved(scene)
    del tables["scene"]["title"], tables["solver"]
    for key in LENGTH_OF_RUN:
        tables.get("time", {}).pop(key, None)
    if isinstance(scene.geometry, MeshFile):
        tables["geometry"]["path"] = _content(scene.geometry.path)
    text = json.dumps(tables, sort_keys=True, separators=(",", ":"))
    return hashlib.sha256(text.encode()).hexdigest()


def _content(path: Path) -> str:
    """Return a SHA-256 of a file; the cases of a sweep ask for the same one often."""
    status = path.stat()
    return _hashed(path, status.st_mtime_ns, status.st_size)


@lru_cache(maxsize=64)
def _hashed(path: Path, changed: int, size: int) -> str:
    return hashlib.sha256(path.read_bytes()).hexdigest()
