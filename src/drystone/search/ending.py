"""The walls that a search ends with, and why nothing more is placed on them."""

from collections.abc import Callable
from typing import TypeVar

from drystone.planner.events import Stopped
from drystone.planner.planner import Planner
from drystone.search.found import Found
from drystone.search.packed import Packed, found_again

Result = TypeVar("Result")


def insisted(work: Callable[[], Result]) -> Result:
    """Do some work in spite of one interrupt, so that a search is not lost at its end."""
    try:
        return work()
    except KeyboardInterrupt:
        return work()


def as_found(planner: Planner, wall: Packed) -> tuple[Planner, Stopped]:
    """Return a planner with a wall as a search has found it, and why nothing is added.

    Parameters
    ----------
    planner : Planner
        Of the first wall.
    wall : Packed
        From the search.
    """
    last = _planner_of(planner, wall)
    return last, last.finished or Stopped("search", "kept as the search found it")


def with_the_rest(planner: Planner, best: Packed) -> tuple[Planner, Stopped]:
    """Return a planner with the best wall of a search, and why nothing more is placed on it.

    The passes of a search have weights of their own: a stone that found no place by those may
    find one by the settings'.  It stays if the wall is better with it.  An interrupt keeps the
    wall as it was found.

    Parameters
    ----------
    planner : Planner
        Of the first wall.
    best : Packed
        From the search.
    """
    last = insisted(lambda: _planner_of(planner, best))
    found = last.build
    try:
        for _ in last.steps():
            pass
        better = last.build is found or Found.of(last).merit > best.merit
    except KeyboardInterrupt:
        return insisted(lambda: as_found(planner, best))
    assert last.stopped is not None  # noqa: S101 - steps() ended by itself
    if better:
        return last, last.stopped
    last.build = found
    return last, Stopped("search", "no stone that is left makes the wall better")


def _planner_of(planner: Planner, wall: Packed) -> Planner:
    workshop, settings = planner.workshop, planner.settings
    last = Planner(
        workshop.stones,
        workshop.site,
        seed=planner.seed,
        settings=settings,
        workshop=workshop,
        profile=planner.profile,
    )
    last.build = found_again(wall, workshop, settings).build
    return last
