"""Turns what pydantic reports into sentences: the key, the value as given, what is allowed."""

import difflib
from collections.abc import Callable
from typing import Any, get_args, get_origin

from pydantic import BaseModel, ValidationError
from pydantic.fields import FieldInfo
from pydantic_core import ErrorDetails

from porolub.scene.conditions import Boundary, Displacement, Traction
from porolub.scene.describe import toml_value
from porolub.scene.geometry import Barrel, Block, MeshFile, Sector
from porolub.scene.histories import FORMS, keys_of
from porolub.scene.operation import Rotation, Sliding
from porolub.scene.scene import Scene
from porolub.scene.units import Quantity

MOST = 5  # sentences reported at once

_TAGGED: dict[str, dict[str, type[BaseModel]]] = {
    "geometry": {"sector": Sector, "block": Block, "barrel": Barrel, "file": MeshFile},
    "motion": {"rotation": Rotation, "sliding": Sliding},
}
_TAG_KEY = {"geometry": "shape", "motion": "kind"}
NEEDED = {
    "int_type": "a whole number is needed",
    "int_from_float": "a whole number is needed",
    "bool_type": "true or false is needed",
    "string_type": "a text is needed",
    "path_type": "a text is needed",
    "model_type": "a table of keys is needed",
    "model_attributes_type": "a table of keys is needed",
    "dict_type": "a table of keys is needed",
    "tuple_type": "an array in brackets is needed",
}
Loc = tuple[int | str, ...]


def sentences(error: ValidationError, context: dict[str, Any]) -> list[str]:
    """Return at most five sentences, then a count of the rest."""
    details = error.errors(include_url=False)
    unknown = [d for d in details if d["type"] == "extra_forbidden"]
    meant = {(*d["loc"][:-1], near) for d in unknown if (near := _nearest_key(d["loc"]))}
    lines = [
        line
        for d in details
        if not (d["type"] == "missing" and d["loc"] in meant)  # the misspelt key was named
        for line in _sentence(d, context).split("\n")
    ]
    more = len(lines) - MOST
    return lines[:MOST] + ([f"... and {more} more."] if more > 0 else [])


def _key(loc: Loc) -> str:
    """Return the key as the user writes it: without the tags pydantic puts into unions."""
    parts = [p for p in loc if isinstance(p, str) and not p.startswith("<")]
    if parts and parts[0] in _TAGGED and len(parts) > 1:
        del parts[1]
    entry = f" (no. {loc[-1] + 1})" if loc and isinstance(loc[-1], int) else ""  # of an array
    key = ".".join(parts) if len(parts) > 1 else f"[{parts[0]}]" if parts else "the scene"
    return key + entry


def _model(loc: Loc) -> type[BaseModel]:
    """Return the model whose keys stand at ``loc``."""
    if not loc:
        return Scene
    if loc[-1] == "<components>":
        return Traction
    if loc[-1] in FORMS:
        form = FORMS[str(loc[-1])]
        annotation = _model(loc[:-2]).model_fields[str(loc[-2])].annotation
        return _find(annotation, lambda p: isinstance(p, type) and issubclass(p, form)) or form
    if loc[0] == "boundary":
        return Displacement if len(loc) > 2 else Boundary
    if loc[0] in _TAGGED:
        return _TAGGED[str(loc[0])][str(loc[1])]
    return _models(Scene.model_fields[str(loc[0])].annotation)[0]


def _models(annotation: Any) -> list[type[BaseModel]]:
    """Return the models among the members of an annotation."""
    members = (annotation, *get_args(annotation))
    return [t for t in members if isinstance(t, type) and issubclass(t, BaseModel)]


def _allowed(loc: Loc) -> list[str]:
    """Return the keys that may stand at ``loc``."""
    return list(keys_of(str(loc[-1])) if loc and loc[-1] in FORMS else _model(loc).model_fields)


def _nearest_key(loc: Loc) -> str | None:
    near = difflib.get_close_matches(str(loc[-1]), _allowed(loc[:-1]), 1)
    return near[0] if near else None


def _sentence(detail: ErrorDetails, context: dict[str, Any]) -> str:
    loc, kind, ctx = detail["loc"], detail["type"], detail.get("ctx", {})
    key, value = _key(loc), detail["input"]
    given = f"{key} = {toml_value(value)}"
    if kind == "rule":
        where = f"[{key}]: " if loc and loc[0] == "boundary" else ""
        return where + str(ctx["text"])
    if kind == "refused" and ctx["key"]:
        return f"{key}.{ctx['key']} = {toml_value(value[ctx['key']])}: {ctx['reason']}."
    if kind == "refused":
        return f"{given}: {ctx['reason']}."
    if kind == "missing" and key == "[geometry]":
        return f"[geometry] is missing: geometry.shape is one of {', '.join(_TAGGED['geometry'])}."
    if kind == "missing":
        return f"{key} is missing{_what(_model(loc[:-1]).model_fields[str(loc[-1])], context)}."
    if kind == "extra_forbidden":
        return _unknown_key(loc, given)
    if kind == "literal_error":
        return f"{given}: {one_of(expected(ctx['expected']), value)}."
    if kind in ("union_tag_invalid", "union_tag_not_found"):
        tag_key, tags = _TAG_KEY[str(loc[0])], list(_TAGGED[str(loc[0])])
        if kind == "union_tag_not_found":
            return f"{loc[0]}.{tag_key} is missing: allowed are {', '.join(tags)}."
        tag = value[tag_key]
        return f"{loc[0]}.{tag_key} = {toml_value(tag)}: {one_of(tags, tag)}."
    if kind in ("greater_than_equal", "less_than_equal"):
        bound = f"at least {ctx['ge']}" if "ge" in ctx else f"at most {ctx['le']}"
        return f"{given}: the value must be {bound}."
    return f"{given}: {NEEDED.get(kind, detail['msg'])}."


def _unknown_key(loc: Loc, given: str) -> str:
    name, allowed = str(loc[-1]), _allowed(loc[:-1])
    what = "section" if len(loc) == 1 else "key"
    near, elsewhere = _nearest_key(loc), _sections_with(name)
    if near:
        hint = f"did you mean {_key((*loc[:-1], near))}?"
    elif elsewhere and loc[0] not in elsewhere:
        hint = f"did you mean {elsewhere[0]}.{name}?"
    else:
        tagged = loc[0] in _TAGGED and len(loc) == 3
        variant = f' for {_TAG_KEY[str(loc[0])]} = "{loc[1]}"' if tagged else ""
        hint = f"allowed{variant} are {', '.join(allowed)}."
    shown = given if what == "key" else _key(loc)
    return f"{shown}: there is no such {what}; {hint}"


def _sections_with(name: str) -> list[str]:
    """Return the sections that know a key of this name."""
    return [
        section
        for section, field in Scene.model_fields.items()
        if any(
            name in model.model_fields
            for model in (*_TAGGED.get(section, {}).values(), *_models(field.annotation))
        )
    ]


def one_of(allowed: list[str], value: Any) -> str:
    """Say what is allowed, and which of it was meant."""
    near = difflib.get_close_matches(str(value), allowed, 1)
    hint = f" (did you mean {near[0]}?)" if near else ""
    return f"allowed are {', '.join(allowed)}{hint}"


def expected(text: str) -> list[str]:
    """Split pydantic's "'a', 'b' or 'c'"."""
    return [part.strip().strip("'") for part in text.replace(" or ", ",").split(",")]


def _what(field: FieldInfo, context: dict[str, Any]) -> str:
    """Say what a missing key should hold."""
    marker = _find((field.annotation, *field.metadata), lambda part: isinstance(part, Quantity))
    if marker is not None:
        kind = marker.kind_in(context)
        example = kind.example if not kind.unit else f'"{kind.example}"'
        if get_origin(field.annotation) is tuple:
            return f": an array is needed, each entry {kind.name}, such as [{example}, ...]"
        return f": {kind.name} is needed, such as {example}"
    choices = [str(c) for c in get_args(field.annotation) if isinstance(c, str | int)]
    return f": allowed are {', '.join(choices)}" if choices else ""


def _find(annotation: Any, wanted: Callable[[Any], bool]) -> Any:
    """Return the first part of a nested annotation that is wanted, or None."""
    if wanted(annotation):
        return annotation
    inner = annotation if isinstance(annotation, tuple) else get_args(annotation)
    for part in (*inner, *getattr(annotation, "__metadata__", ())):
        if (found := _find(part, wanted)) is not None:
            return found
    return None
