"""The base of all scene models, and the two ways a value is refused."""

from pathlib import Path
from typing import Any

from pydantic import BaseModel, BeforeValidator, ConfigDict, ValidationInfo
from pydantic_core import PydanticCustomError


class Section(BaseModel):
    """A table of the scene file: unknown keys are refused, values cannot change once read."""

    model_config = ConfigDict(extra="forbid", frozen=True)


def refused(reason: str, key: str = "") -> PydanticCustomError:
    """Return the error for one value; the key and the value are put before ``reason``.

    ``key`` names the culprit among the keys of a table.
    """
    return PydanticCustomError("refused", "{reason}", {"reason": reason, "key": key})


def broken(*sentences: str) -> PydanticCustomError:
    """Return the error for broken rules; each sentence names its keys in full."""
    return PydanticCustomError("rule", "{text}", {"text": "\n".join(sentences)})


def _whole(value: Any) -> Any:
    """Refuse true and 2.0, which equal whole numbers in Python."""
    if type(value) is not int:
        raise refused("a whole number is needed")
    return value


Whole = BeforeValidator(_whole)


def beside_scene(path: Path, info: ValidationInfo) -> Path:
    """Return the full path of a file that a scene names relative to itself."""
    base = (info.context or {}).get("base_dir") or Path()
    return (Path(base) / path.expanduser()).resolve()
