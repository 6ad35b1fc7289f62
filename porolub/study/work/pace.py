"""How long a sweep will still take, from what its cases have taken so far."""

import statistics


class SweepPace:
    """Estimates the wall time left with ``todo`` cases to do and ``groups`` of ranks at work."""

    def __init__(self, todo: int, groups: int) -> None:
        self._todo, self._groups = todo, groups
        self._walls: list[float] = []
        self._since: dict[int, float] = {}  # when each busy group began, by group

    def started(self, group: int, now: float) -> None:
        """A group begins a case as the clock shows ``now`` (s)."""
        self._since[group] = now

    def finished(self, group: int | None, wall: float | None) -> None:
        """A case is done, in ``wall`` s; None for both where nothing was computed."""
        self._todo -= 1
        if group is not None:
            self._since.pop(group, None)
        if wall is not None:
            self._walls.append(wall)

    def left(self, now: float) -> float | None:
        """Return the wall time left, s: as if each case took the mean; None before the first."""
        if not self._walls:
            return None
        mean = statistics.fmean(self._walls)
        running = [max(since + mean - now, 0.0) for since in self._since.values()]
        waiting = max(self._todo - len(running), 0)
        sides = max(min(self._groups, waiting + len(running)), 1)
        return max((waiting * mean + sum(running)) / sides, max(running, default=0.0))
