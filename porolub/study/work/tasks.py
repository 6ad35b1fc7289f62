"""Which cases of a sweep are to do, under way and done. No MPI here.

A case may begin when those it starts from are done.  So which case starts from which is settled
before the work begins, and the results do not depend on who is quickest.
"""

from __future__ import annotations

import logging
import threading
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from typing import Any

from porolub.errors import PorolubError
from porolub.study.plan.cases import Case

log = logging.getLogger(__name__)
Row = Mapping[str, Any]
Starts = tuple[tuple[int, str, float], ...]
"""Number, key and weight of the cases another starts from."""


@dataclass(frozen=True)
class Task:
    """A case to compute, what it starts from, and whether others will start from it."""

    case: Case
    starts: Starts
    wanted: bool


@dataclass(frozen=True)
class Wait:
    """Nothing can begin before something else is done."""


@dataclass(frozen=True)
class End:
    """There is no more work."""


class Work:
    """Hands out cases in their order; safe to use from several threads.

    ``rows``: of cases done before, by key. ``begun`` and ``note`` are called, one at a time, with
    each case that begins and each row that comes in, and the group; an error of theirs ends the
    work and is kept in ``problem``, or groups would wait for an answer for ever.  ``refresh``
    renews what is shown.
    """

    def __init__(self, cases: Iterable[Case], rows: Mapping[str, Row],
                 begun: Callable[[Case, int], None] = lambda case, group: None,
                 note: Callable[[Row, int], None] = lambda row, group: None,
                 refresh: Callable[[], None] = lambda: None) -> None:
        self._cases = {case.index: case for case in cases}
        self._converged = {i: rows[c.key]["status"] == "converged"
                           for i, c in self._cases.items() if c.key in rows}
        waiting = [c for i, c in self._cases.items() if i not in self._converged]
        self._waiting = {c.index: c for c in sorted(waiting, key=lambda c: c.order)}
        self._children = {parent for c in waiting for parent, _ in c.parents}
        self._begun, self._note, self._refresh = begun, note, refresh
        self._stuck = False  # whether nothing can begin before a row comes in
        self._lock = threading.Lock()
        self.problem: PorolubError | None = None

    @property
    def left(self) -> int:
        """Cases that have not begun."""
        return len(self._waiting)

    def stop(self, problem: PorolubError) -> None:
        """Hand out no more; the first reason counts."""
        with self._lock:
            self.problem = self.problem or problem

    def done(self, row: Row, group: int) -> None:
        """A group has computed this row."""
        with self._lock:
            self._converged[row["case"]] = row["status"] == "converged"
            self._stuck = False
            self._tell(lambda: self._note(row, group))

    def next(self, group: int) -> Task | Wait | End:
        """What a group does next."""
        with self._lock:
            if self.problem is not None or not self._waiting:
                return End()
            if self._stuck:
                return Wait()
            ready = next((c for c in self._waiting.values() if self._is_ready(c)), None)
            if ready is None:
                self._stuck = True
                return Wait()
            del self._waiting[ready.index]
            self._tell(lambda: self._begun(ready, group))
            return Task(ready, self._starts(ready), ready.index in self._children)

    def refresh(self) -> None:
        """Renew what is shown."""
        with self._lock:
            self._tell(self._refresh)

    def _is_ready(self, case: Case) -> bool:
        return all(parent in self._converged for parent, _ in case.parents)

    def _starts(self, case: Case) -> Starts:
        """Its parents that converged, their weights made to sum to 1."""
        found = [(i, self._cases[i].key, w) for i, w in case.parents if self._converged[i]]
        total = sum(w for *_, w in found)
        return tuple((i, key, w / total) for i, key, w in found if w > 0.0)

    def _tell(self, work: Callable[[], None]) -> None:
        try:
            work()
        except PorolubError as problem:
            self.problem = self.problem or problem
        except Exception as error:
            log.exception("the rows could not be kept")
            self.problem = self.problem or PorolubError(f"{type(error).__name__}: {error}; log.txt "
                                                        "or stderr says where.")
