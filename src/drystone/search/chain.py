"""One chain of walls, annealed.

A part of the wall is taken down with all that rests on it, and built up again with other craft
weights; or, where it was planned, upper courses are planned again or laid again.  Better walls are
kept, worse ones with a probability that falls with the temperature.
"""

import math
from collections.abc import Iterator
from dataclasses import dataclass, field, replace

import numpy as np
from numpy.random import Generator

from drystone.planner.build import Build
from drystone.planner.deadline import NEVER, Deadline
from drystone.planner.dropping import wedge_limits
from drystone.planner.replay import Replayed, replayed
from drystone.planner.search_settings import SearchSettings
from drystone.planner.settings import PlannerSettings
from drystone.planner.solves import Solves
from drystone.planner.workshop import Workshop
from drystone.search.archive import archived
from drystone.search.built_up import built_up
from drystone.search.by_courses import newly_planned, relaid, replanned
from drystone.search.found import Found
from drystone.search.operators import NEW, RECREATED, REPLANNED, Credits, shares
from drystone.search.packed import Packed, found_again
from drystone.search.ruin import RUINS, taken_down
from drystone.search.wedging import wedged_up


@dataclass(frozen=True, eq=False)
class Link:
    """Where a chain is."""

    number: int  # Of the chain
    done: int  # How many walls it has built
    now: Found  # The wall that it goes on from
    best: Packed  # The best that it found
    solves: Solves  # What trouble there was with all of them
    kept: tuple[Packed, ...] = ()  # Those of the last ones that none of them beats in every figure
    # Which changes have helped in all chains, and in this one since then
    known: Credits = field(default_factory=Credits)
    learnt: Credits = field(default_factory=Credits)


def lengthened(
    link: Link,
    count: int,
    seed: int,
    workshop: Workshop,
    settings: PlannerSettings,
    until: Deadline = NEVER,
) -> Iterator[Link]:
    """Build some more walls of a chain."""
    search = settings.search
    for _ in range(count):
        until.look()
        position, length = in_cycle(link.done, search.cycle)
        if position == 0 and link.best.courses is not None:
            link = replace(link, now=found_again(link.best, workshop, settings, until))
        rng = np.random.default_rng([seed, 3_000_000 + link.number, link.done])
        planned = link.now.courses is not None
        usual = shares(planned, search.polish)
        operator = (link.known + link.learnt).drawn(usual, rng)
        # A part of a planned wall that is built up freely has no plan any more.
        aside = planned and operator == RECREATED
        base = found_again(link.best, workshop, settings, until) if aside else link.now
        found = _changed(base, operator, workshop, settings, rng, until)
        now = link.now
        floor = math.inf if aside else _floor(now, position / length, search, rng)
        worth_wedges = link.best.merit - search.wedge_below
        # What a wall carries without dilatancy takes long to find, and only lowers its merit.
        if found.merit > min(floor, worth_wedges):
            found = found.judged(workshop, settings, until=until)
        if found.merit > worth_wedges:
            found = wedged(found, workshop, settings, until)
        if found.merit >= floor:
            now = found
        link = Link(
            link.number,
            link.done + 1,
            now,
            Packed.of(found) if found.merit > link.best.merit + 1e-12 else link.best,
            link.solves + found.solves,
            archived(link.kept, [Packed.of(found)]),
            link.known,
            link.learnt.after(operator, found.merit > base.merit + 1e-12),
        )
        yield link


def _changed(
    base: Found,
    operator: str,
    workshop: Workshop,
    settings: PlannerSettings,
    rng: Generator,
    until: Deadline,
) -> Found:
    """Change a wall; where nothing can be planned, lay it again."""
    if operator == RECREATED:
        return recreated(base, workshop, settings, rng, until)
    new: Found | None = None
    if operator == NEW:
        new = newly_planned(workshop, settings, rng, until)
    elif operator == REPLANNED:
        new = replanned(base, workshop, settings, rng, until)
    return relaid(base, workshop, settings, rng, until) if new is None else new


def wedged(
    found: Found, workshop: Workshop, settings: PlannerSettings, until: Deadline = NEVER
) -> Found:
    """Put small wedges into the gaps of a wall of outlines, where that makes it better.

    The wall is judged by both flow rules.
    """
    found = found.judged(workshop, settings, until=until)
    wedges = settings.search.wedges
    may = settings.stabilise.method in ("both", "wedge")
    if found.build.wall.outlines is None or not (wedges and may and found.build.actions):
        return found
    limits = wedge_limits(settings, workshop.stock, workshop.site)
    build, solves = wedged_up(found.build, workshop, settings, limits, wedges, until)
    found = replace(found, solves=found.solves + solves)
    if build is found.build:
        return found
    again = Found.measured(build, workshop, settings, found.solves, found.courses)
    if again.merit > found.merit:
        again = again.judged(workshop, settings, until=until)
    return again if again.merit > found.merit else found


def in_cycle(done: int, first: int) -> tuple[int, int]:
    """Return the position in a cycle of annealing, and its length; each is twice the one before."""
    length = first
    while done >= length:
        done -= length
        length *= 2
    return done, length


def _floor(now: Found, share: float, search: SearchSettings, rng: Generator) -> float:
    """Draw the merit from which on a chain goes on from a wall that it finds (Metropolis)."""
    temperature = search.warm * (search.cold / search.warm) ** share
    return float(now.merit + temperature * math.log(1.0 - rng.random()))


def recreated(
    found: Found,
    workshop: Workshop,
    settings: PlannerSettings,
    rng: Generator,
    until: Deadline = NEVER,
) -> Found:
    """Take a part of a wall down and build it up again."""
    solves = Solves()
    if found.figures is None:
        build = found.build
    elif settings.order == "given":
        states = found.build.states()  # as many of the last stones as any ruin may choose
        most = max(1, round(settings.search.largest * len(found.build.actions)))
        build = states[-1 - int(rng.integers(1, most + 1))]
    else:
        names = list(RUINS)
        ruin = RUINS[names[int(rng.integers(len(names)))]]
        gone = taken_down(found.build, ruin, settings.search, rng)
        build, _, solves = without(found.build, gone, workshop, settings, until)
    return Found.of(built_up(build, workshop, settings, rng, until), before=solves)


def without(
    build: Build,
    gone: frozenset[int],
    workshop: Workshop,
    settings: PlannerSettings,
    until: Deadline = NEVER,
) -> Replayed:
    """Return a wall without some stones; those that do not stand without them go as well."""
    groups = build.wall.groups
    first = next((k for k, g in enumerate(groups) if g.placement.stone_id in gone), len(groups))
    kept = [g for g in groups[first:] if g.placement.stone_id not in gone]
    start = build.states()[first]
    heights = build.course_heights_px()
    return replayed(start, kept, heights, workshop, settings, strict=False, until=until)
