"""The base of all scene models, and the two ways a value is refused."""

from typing import Any

from pydantic import BaseModel, BeforeValidator, ConfigDict
from pydantic_core import PydanticCustomError


class Section(BaseModel):
    """A table of the scene file: unknown keys are refused, values cannot change once read."""

    model_config = ConfigDict(extra="forbid", frozen=True)


def refused(reason: str) -> PydanticCustomError:
    """Return the error for one value; the key and the value are put before ``reason``."""
    return PydanticCustomError("refused", "{reason}", {"reason": reason})


def broken(*sentences: str) -> PydanticCustomError:
    """Return the error for broken rules; each sentence names its keys in full."""
    return PydanticCustomError("rule", "{text}", {"text": "\n".join(sentences)})


def _whole(value: Any) -> Any:
    """Refuse true and 2.0, which equal whole numbers in Python."""
    if type(value) is not int:
        raise refused("a whole number is needed")
    return value


Whole = BeforeValidator(_whole)
