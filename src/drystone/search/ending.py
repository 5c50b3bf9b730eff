"""The walls that a search ends with, and why nothing more is placed on them."""

from collections.abc import Iterable
from itertools import islice

from drystone.planner.events import Stopped
from drystone.planner.planner import Planner
from drystone.search.found import Found
from drystone.search.interrupts import insisted
from drystone.search.packed import Packed, found_again
from drystone.statics.flow.flow_search import NonassociativeSettings

_FOUND = Stopped("search", "kept as the search found it")

THOROUGH = NonassociativeSettings()
"""How the load without dilatancy is looked for at the end."""

JUDGED_AGAIN = 4
"""So many of the best walls of a search are looked at thoroughly at most."""


def surest(planner: Planner, walls: Iterable[Packed]) -> Packed | None:
    """Return the best of some walls once their load without dilatancy is looked for thoroughly.

    Parameters
    ----------
    planner : Planner
        Of the first wall.
    walls : iterable of Packed
        From a search, the best first; of none there is no best.
    """
    workshop, settings = planner.workshop, planner.settings
    best: Packed | None = None
    for wall in islice(walls, JUDGED_AGAIN):
        if best is not None and wall.merit <= best.merit:
            break
        again = found_again(wall, workshop, settings).judged(workshop, settings, THOROUGH)
        if best is None or again.merit > best.merit:
            best = Packed.of(again)
    return best


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
    return last, last.finished or _FOUND


def with_the_rest(planner: Planner, best: Packed) -> tuple[Planner, Stopped, bool]:
    """Return a planner with the best wall of a search, and why nothing more is placed on it.

    The passes of a search have weights of their own: a stone that found no place by those may
    find one by the weights of the first wall.  As many stay as make the wall best.

    Parameters
    ----------
    planner : Planner
        Of the first wall.
    best : Packed
        From the search.

    Returns
    -------
    planner : Planner
        With the wall.
    stopped : Stopped
        Why no more.
    interrupted : bool
        Not all was tried.
    """
    last = insisted(lambda: _planner_of(planner, best))
    build, merit, interrupted = last.build, best.merit, False
    try:
        for _ in last.steps():
            now = Found.of(last)
            if now.merit > merit:
                now = now.judged(planner.workshop, planner.settings, THOROUGH)
            if now.merit > merit:
                build, merit = last.build, now.merit
    except KeyboardInterrupt:
        interrupted = True
    if last.stopped is not None and last.build is build:
        return last, last.stopped, interrupted
    last.build = build
    if interrupted:
        return last, last.finished or _FOUND, True
    return last, Stopped("search", "the stones that are left do not make the wall better"), False


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
