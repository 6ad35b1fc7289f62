"""cases/NNNN of a sweep that keeps results: each says whose it is, for the numbers may change.

With more points on an axis cases get other numbers.  The file KEY in a directory has the key of its
case, so that it is found again, wherever a killed job has left it.
"""

from __future__ import annotations

import shutil
from collections.abc import Iterable
from pathlib import Path
from typing import Any

from porolub.errors import SceneError
from porolub.io.atomic import reported, write_text
from porolub.io.directory import SUMMARY
from porolub.study.plan.cases import Case
from porolub.study.work.journal import PARTS
from porolub.together import on_root

RESULTS = "cases"
KEY = ".case"
_ASIDE, _OTHER = ".", "other-"  # in front of a key: under way; of a case the sweep has no more


def case_directory(sweep: Path, case: Case) -> Path:
    """Where a case has its results."""
    return sweep / RESULTS / f"{case.index:04d}"


def claim(directory: Path, case: Case, comm: Any) -> None:
    """Make a case's directory. Collective. Raises SolveError where it cannot be written."""

    def make() -> None:
        with reported(directory, "the results"):
            directory.mkdir(parents=True, exist_ok=True)
            write_text(directory / KEY, case.key)

    on_root(comm, make)


def arrange(sweep: Path, cases: Iterable[Case]) -> None:
    """Bring the directories that are there to the numbers their cases have now.

    Those of cases that the sweep has no more are kept by another name. Raises SceneError where
    that is impossible. May be stopped at any moment and done again.
    """
    root, numbers = sweep / RESULTS, {case.key: f"{case.index:04d}" for case in cases}
    try:
        owned = {key: place for place, key in _owned(root)}
        names = {key: numbers.get(key, f"{_OTHER}{key[:12]}") for key in owned}
        moved = {key: place for key, place in owned.items() if place.name != names[key]}
        for key, place in moved.items():
            place.rename(root / f"{_ASIDE}{key}")
        for key in moved:
            target = root / names[key]
            if target.exists():  # of nobody, or half taken away
                shutil.rmtree(target)
            (root / f"{_ASIDE}{key}").rename(target)
    except OSError as error:
        raise SceneError(f"{root}: the directories of the cases cannot be given the numbers these "
                         f"have now ({error.strerror}).") from error


def with_results(sweep: Path) -> set[str]:
    """Keys of the cases that have a whole directory, in the sweep or in a part of it."""
    roots = [sweep / RESULTS, *sweep.glob(f"{PARTS}/{RESULTS}")]
    return {key for root in roots for place, key in _owned(root) if (place / SUMMARY).exists()}


def _owned(root: Path) -> list[tuple[Path, str]]:
    """Directories and the keys of their cases."""
    found = sorted(root.glob(f"*/{KEY}")) if root.is_dir() else []
    return [(path.parent, path.read_text(encoding="utf-8")) for path in found]
