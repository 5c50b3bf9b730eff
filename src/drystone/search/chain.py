"""First walls, and chains of walls, annealed: what the processes of a search do.

A part of the wall is taken down with all that rests on it, and built up again with other craft
weights; or, where it was planned, upper courses are planned again or laid again.  Better walls are
kept, worse ones with a probability that falls with the temperature.
"""

import math
import pickle
from contextlib import suppress
from dataclasses import dataclass, replace
from functools import lru_cache

import numpy as np
from numpy.random import Generator

from drystone.planner.build import Build, Solves
from drystone.planner.deadline import Deadline, TimeIsUp
from drystone.planner.replay import Replayed
from drystone.planner.settings import PlannerSettings
from drystone.planner.vary import CHAIN_DRAWS, FIRST_DRAWS
from drystone.planner.workshop import Workshop
from drystone.search.by_courses import newly_planned, relaid, replanned
from drystone.search.goal import FoundWall
from drystone.search.operators import NEW, RECREATED, REPLANNED, Credits, shares
from drystone.search.packed import PackedWall, archived, found_again
from drystone.search.ruin import RUINS, taken_down
from drystone.search.state import Link
from drystone.search.wedging import wedged_up
from drystone.search.yard import Yard


@dataclass(frozen=True)
class Job:
    """What all tasks of a search share."""

    tools: bytes  # stones, site and settings, pickled
    seed: int
    until: Deadline

    @classmethod
    def of(cls, yard: Yard, seed: int) -> "Job":
        """Return what tasks need to build with what walls are built with here."""
        workshop = yard.workshop
        tools = pickle.dumps((workshop.stones, workshop.site, yard.settings))
        return cls(tools, seed, yard.until)

    @property
    def yard(self) -> Yard:
        """What walls are built with here."""
        return Yard(*_opened(self.tools), self.until)


@lru_cache(maxsize=1)
def _opened(tools: bytes) -> tuple[Workshop, PlannerSettings]:
    """Prepare what the tasks of a search share, once in each process."""
    stones, site, settings = pickle.loads(tools)  # noqa: S301 - packed by the same program
    return Workshop.prepare(stones, site, settings), settings


def forget() -> None:
    """Let go of what this process has prepared."""
    _opened.cache_clear()


def one_pass(job: Job, number: int, planned_share: float) -> PackedWall | None:
    """Build a first wall from its seed; None when time is up before it is whole.

    With a probability it is planned course by course, where walls may be.
    """
    try:
        yard = job.yard
        job.until.look()
        rng = np.random.default_rng([job.seed, FIRST_DRAWS + number])
        yard = yard.jointed(number)
        found = None
        if planned_first(yard.settings) and rng.random() < planned_share:
            found = newly_planned(yard, rng)
        if found is None:
            planner = yard.planner(int(rng.integers(2**31)))
            for _ in planner.steps(job.until):
                pass
            found = FoundWall.of(planner)
        return PackedWall.of(wedged(found, yard))
    except TimeIsUp:
        return None


def planned_first(settings: PlannerSettings) -> bool:
    """Say whether courses may be planned: in quarter turns, laid from both ends.

    Plans know quarter turns of the initial pose, which other sets of orientations need not have.
    """
    return settings.orientations == "quarter" and settings.order == "free" and settings.two_sided


def more_links(job: Job, link: Link, count: int) -> Link | None:
    """Build some more walls of a chain, fewer when time is up; None when there is no time."""
    begun = link.done
    now: FoundWall | None = None
    with suppress(TimeIsUp):
        yard = job.yard
        link, now = replace(link, kept=(), learnt=Credits()), found_again(link.now, yard)
        for _ in range(count):
            job.until.look()
            link, now = _lengthened(link, now, job.seed, yard)
    if now is None or link.done == begun:
        return None
    return replace(link, now=PackedWall.of(now))


def _lengthened(link: Link, now: FoundWall, seed: int, yard: Yard) -> tuple[Link, FoundWall]:
    """Build one more wall of a chain, and return from which wall it goes on.

    What is drawn for a wall depends on the seed, on the chain and on the number of the wall.
    """
    yard, search = yard.jointed(link.done), yard.settings.search
    position, length = in_cycle(link.done, search.cycle)
    if position == 0 and link.best.courses is not None:
        now = found_again(link.best, yard)
    rng = np.random.default_rng([seed, CHAIN_DRAWS + link.number, link.done])
    planned = now.courses is not None
    operator = (link.known + link.learnt).drawn(shares(planned, search.polish), rng)
    # A part of a planned wall that is built up freely has no plan any more.
    aside = planned and operator == RECREATED
    base = found_again(link.best, yard) if aside else now
    found = _changed(base, operator, yard, rng)
    floor = math.inf
    if not aside:  # from that merit on the chain goes on from what it finds (Metropolis)
        temperature = search.warm * (search.cold / search.warm) ** (position / length)
        floor = float(now.merit + temperature * math.log(1.0 - rng.random()))
    worth_wedges = link.best.merit - search.wedge_below
    # What a wall carries without dilatancy takes long to find, and only lowers its merit.
    if found.merit > min(floor, worth_wedges):
        found = found.judged(yard)
    if found.merit > worth_wedges:
        found = wedged(found, yard)
    packed = PackedWall.of(found)
    link = replace(
        link,
        done=link.done + 1,
        best=packed if found.merit > link.best.merit + 1e-12 else link.best,
        solves=link.solves + found.solves,
        kept=archived(link.kept, [packed]),
        learnt=link.learnt.after(operator, found.merit > base.merit + 1e-12),
    )
    return link, found if found.merit >= floor else now


def in_cycle(done: int, first: int) -> tuple[int, int]:
    """Return the position in a cycle of annealing, and its length; each is twice the one before."""
    length = first
    while done >= length:
        done -= length
        length *= 2
    return done, length


def _changed(base: FoundWall, operator: str, yard: Yard, rng: Generator) -> FoundWall:
    """Change a wall; where nothing can be planned, lay it again."""
    if operator == RECREATED:
        return recreated(base, yard, rng)
    new: FoundWall | None = None
    if operator == NEW:
        new = newly_planned(yard, rng)
    elif operator == REPLANNED:
        new = replanned(base, yard, rng)
    return relaid(base, yard, rng) if new is None else new


def recreated(found: FoundWall, yard: Yard, rng: Generator) -> FoundWall:
    """Take a part of a wall down and build it up again."""
    solves, search = Solves(), yard.settings.search
    if found.figures is None:
        build = found.build
    elif yard.settings.order == "given":
        states = found.build.states()  # as many of the last stones as any ruin may choose
        most = max(1, round(search.largest * len(found.build.actions)))
        build = states[-1 - int(rng.integers(1, most + 1))]
    else:
        ruin = RUINS[int(rng.integers(len(RUINS)))]
        gone = taken_down(found.build, ruin, search, rng)
        build, _, solves = without(found.build, gone, yard)
    return FoundWall.of(yard.built_up(build, rng), before=solves)


def without(build: Build, gone: frozenset[int], yard: Yard) -> Replayed:
    """Return a wall without some stones; those that do not stand without them go as well."""
    groups = build.wall.groups
    first = next((k for k, g in enumerate(groups) if g.placement.stone_id in gone), len(groups))
    kept = [g for g in groups[first:] if g.placement.stone_id not in gone]
    start = build.states()[first]
    return yard.replayed(start, kept, build.course_heights_px(), strict=False)


def wedged(found: FoundWall, yard: Yard) -> FoundWall:
    """Put small wedges into the gaps of a wall, where that makes it better.

    The wall is judged by both flow rules.
    """
    found = found.judged(yard)
    wedges = yard.settings.search.wedges
    may = yard.settings.stabilise.method in ("both", "wedge")
    if not (wedges and may and found.build.actions):
        return found
    build, solves = wedged_up(found.build, yard, wedges)
    found = replace(found, solves=found.solves + solves)
    if build is found.build:
        return found
    again = FoundWall.measured(build, yard, found.solves, found.courses)
    if again.merit > found.merit:
        again = again.judged(yard)
    return again if again.merit > found.merit else found
