"""Where the time of a plan goes: by step, and by part of the work."""

import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from typing import Literal, get_args

Part = Literal[
    "preparation", "placement", "stabilisation", "contacts", "limit analysis", "indices", "metrics",
    "search",
]  # fmt: skip
"""Stones turned and clustered (once); trial positions; rotating and wedging; Pic-to-Ri; both
tilts of the wall; the indices of the actions; figures of merit, for methods that look at them;
all that is built after the first wall, by the clock."""

PARTS: tuple[Part, ...] = get_args(Part)[:-1]
"""The parts of the work on a wall: all but the search, which is many walls."""


@dataclass(frozen=True)
class StepTime:
    """What one step took."""

    stones: int  # stones that were there before it
    candidates: int  # how many candidates were evaluated
    seconds: float  # from its first attempt to its action
    # s by part, of all threads, waiting included; the rest is sampling, selection, keeping books
    parts: dict[Part, float]


class Profile:
    """Times of a planner at work, by any clock; :attr:`drystone.planner.planner.Planner.profile`.

    Examples
    --------
    >>> import drystone as ds
    >>> import numpy as np
    >>> bricks = ds.generate.BrickSettings(count=6, height_px=10, aspect=2)
    >>> stones = ds.generate.brick_stones(bricks, np.random.default_rng(1))
    >>> profile = ds.plan_wall(stones, 60, 20, scale=1.0, method="paper").profile
    >>> [step.stones for step in profile.steps]
    [0, 1, 2, 3, 4, 5]
    >>> profile.total("placement") > 0
    True
    """

    def __init__(self, clock: Callable[[], float] = time.perf_counter) -> None:
        self._clock = clock
        self.steps: list[StepTime] = []
        # Appending is one operation: threads may do it without a lock.
        self._pending: list[tuple[Part, float]] = []
        self._other: list[tuple[Part, float]] = []
        self._since = self._clock()
        self._candidates_in_vain = 0

    @contextmanager
    def part(self, name: Part) -> Iterator[None]:
        """Return a context whose duration counts for a part."""
        since, into = self._clock(), self._pending
        try:
            yield
        finally:
            into.append((name, self._clock() - since))

    def begin_step(self) -> None:
        """Say that an attempt at a new action begins; what came before belongs to no step."""
        self._other += self._pending
        self._pending = []
        self._since = self._clock()

    def end_step(self, stones: int, candidates: int) -> None:
        """Say that the action is chosen."""
        seconds = self._clock() - self._since
        self.steps.append(StepTime(stones, candidates, seconds, _sums(self._pending)))
        self._pending = []

    def end_without_action(self, candidates: int) -> None:
        """Say that there is no further action, after so many candidates."""
        self._candidates_in_vain += candidates

    @property
    def candidates(self) -> int:
        """How many candidates were evaluated, those of attempts without an action included."""
        return self._candidates_in_vain + sum(step.candidates for step in self.steps)

    def total(self, part: Part) -> float:
        """Return the seconds of a part, all steps and what is outside of steps together."""
        rest = _sums(self._other + self._pending)
        return sum(step.parts.get(part, 0.0) for step in self.steps) + rest.get(part, 0.0)


def _sums(times: list[tuple[Part, float]]) -> dict[Part, float]:
    sums: dict[Part, float] = {}
    for part, seconds in times:
        sums[part] = sums.get(part, 0.0) + seconds
    return sums
