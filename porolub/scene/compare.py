"""What differs between two scenes, for a run that is to go on from a checkpoint."""

from collections.abc import Iterator
from typing import Any

MAY_CHANGE = frozenset(
    {
        "scene.title",
        "solver.preset",
        "time.end",
        "time.until",
        "time.repeat_tolerance",
        "time.frames",
        "time.step_max",
        "time.tolerance",
        "time.first_step",
    }
)
"""Keys a restarted run may have changed: how far, how finely and by what solver to go on."""


def differences(before: dict[str, Any], now: dict[str, Any]) -> list[str]:
    """Return the keys by which two resolved scenes give different answers, sorted.

    ``before`` and ``now`` are what ``Scene.resolved`` returns, or the file it was written to. A key
    or section that only one of them has counts too; keys in MAY_CHANGE do not. A mesh file counts
    by its path; whether its content is the same only ``Scene.digest`` tells.
    """
    return sorted(key for key in _differing(before, now, "") if key not in MAY_CHANGE)


def _differing(before: dict[str, Any], now: dict[str, Any], path: str) -> Iterator[str]:
    for key in {**before, **now}:
        one, other = before.get(key), now.get(key)
        if isinstance(one, dict) and isinstance(other, dict):
            yield from _differing(one, other, f"{path}{key}.")
        elif one != other:
            yield f"{path}{key}"
