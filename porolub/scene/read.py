"""From a TOML file to a checked scene."""

import tomllib
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from pydantic import ValidationError

from porolub.errors import SceneError
from porolub.scene.overrides import apply_overrides
from porolub.scene.scene import Scene
from porolub.scene.sentences import sentences


def load_scene(path: str | Path, overrides: Sequence[str] = ()) -> Scene:
    """Read and check a scene file.

    ``overrides`` are changes such as ``load.force=3 kN/m`` (see porolub.scene.overrides). Raises
    SceneError: one sentence per mistake, with the key, the value and what is allowed.
    """
    path = Path(path)
    return scene_from_dict(apply_overrides(read_tables(path), overrides), path.parent)


def scene_from_dict(d: dict[str, Any], base_dir: str | Path | None = None) -> Scene:
    """Check the tables of a scene file; mesh files are found relative to ``base_dir``."""
    header = d.get("scene")
    dimension = header.get("dimension", 2) if isinstance(header, dict) else 2
    context = {"dimension": dimension, "base_dir": base_dir}
    try:
        return Scene.model_validate(d, context=context)
    except ValidationError as error:
        raise SceneError("\n".join(sentences(error, context))) from error


def read_tables(path: Path, what: str = "scene file") -> dict[str, Any]:
    """Return the tables of a TOML file, unchecked. Raises SceneError; ``what`` says what it is."""
    try:
        with path.open("rb") as file:
            return tomllib.load(file)
    except FileNotFoundError:
        raise SceneError(f"{path}: there is no such {what}.") from None
    except OSError as error:
        raise SceneError(f"{path}: the {what} cannot be read ({error.strerror}).") from error
    except UnicodeDecodeError as error:
        raise SceneError(f"{path}: the {what} must be UTF-8 text.") from error
    except tomllib.TOMLDecodeError as error:
        raise SceneError(f"{path}: this is not valid TOML: {error}.") from error
