"""The walls that a search ends with, and why nothing more is placed on them."""

from collections.abc import Iterable, Sequence
from itertools import islice

from drystone.planner.build import Build
from drystone.planner.deadline import NEVER, Deadline, TimeIsUp
from drystone.planner.events import Stopped
from drystone.planner.planner import Planner
from drystone.planner.sturdy import ROUNDS
from drystone.search.found import Found
from drystone.search.packed import Packed, found_again
from drystone.statics.flow.flow_search import NonassociativeSettings
from drystone.statics.flow.release import fall_of
from drystone.statics.lp.program import assemble

_FOUND = Stopped("search", "kept as the search found it")

THOROUGH = NonassociativeSettings()
"""How the load without dilatancy is looked for at the end."""

JUDGED_AGAIN = 4
"""So many of the best walls of a search are looked at thoroughly at most."""


def surest(
    planner: Planner, walls: Iterable[Packed], until: Deadline = NEVER
) -> tuple[Packed | None, bool]:
    """Return the best of some walls once their load without dilatancy is looked for thoroughly.

    A wall that falls when it is let go after some step is taken only where all do.
    """
    workshop, settings = planner.workshop, planner.settings
    sound: list[Packed] = []
    fallen: list[Packed] = []
    for wall in islice(walls, JUDGED_AGAIN):
        if sound and wall.merit <= _best(sound).merit:
            break
        try:
            again = found_again(wall, workshop, settings, until)
            judged = Packed.of(again.judged(workshop, settings, THOROUGH, until))
            (sound if stays_at_every_step(again.build, until) else fallen).append(judged)
        except TimeIsUp:
            return _best(sound or fallen or [wall]), True
    looked_at = sound or fallen
    return _best(looked_at) if looked_at else None, False


def stays_at_every_step(build: Build, until: Deadline = NEVER) -> bool:
    """Return whether a wall on outlines stays as it is when all of it is let go after each step.

    Forces that would hold it may exist that do not arise (DESIGN 4.8).  For the newest stone alone
    that is asked whenever a stone is placed; for all, which takes longer, only here.
    """
    if build.wall.outlines is None:
        return True
    models = (action.model for action in build.actions)
    return all(fall_of(m, assemble(m), ROUNDS, until.look) is None for m in models)


def _best(walls: Sequence[Packed]) -> Packed:
    return max(walls, key=lambda one: one.merit)


def as_found(planner: Planner, wall: Packed, until: Deadline = NEVER) -> tuple[Planner, Stopped]:
    """Return a planner with a wall as a search has found it, and why nothing is added."""
    last = _planner_of(planner, wall, until)
    return last, last.finished or _FOUND


def with_the_rest(
    planner: Planner, best: Packed, until: Deadline = NEVER
) -> tuple[Planner, Stopped, bool]:
    """Return a planner with the best wall of a search, and why nothing more is placed on it.

    The passes of a search have weights of their own: a stone that found no place by those may
    find one by the weights of the first wall.  As many stay as make the wall best.
    """
    last = _planner_of(planner, best, NEVER)
    build, merit, cut = last.build, best.merit, False
    try:
        for _ in last.steps(until):
            now = Found.of(last)
            if now.merit > merit:
                now = now.judged(planner.workshop, planner.settings, THOROUGH, until)
            if now.merit > merit:
                build, merit = last.build, now.merit
    except TimeIsUp:
        cut = True
    if last.stopped is not None and last.build is build:
        return last, last.stopped, cut
    last.build = build
    if cut:
        return last, last.finished or _FOUND, True
    return last, Stopped("search", "the stones that are left do not make the wall better"), False


def _planner_of(planner: Planner, wall: Packed, until: Deadline) -> Planner:
    workshop, settings = planner.workshop, planner.settings
    last = Planner(
        workshop.stones,
        workshop.site,
        seed=planner.seed,
        settings=settings,
        workshop=workshop,
        profile=planner.profile,
    )
    last.build = found_again(wall, workshop, settings, until).build
    return last
