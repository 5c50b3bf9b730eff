"""What the processes of a search do: whole walls, from what fits into a message."""

import pickle
from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from drystone.planner.deadline import Deadline, TimeIsUp
from drystone.planner.planner import Planner
from drystone.planner.settings import PlannerSettings
from drystone.planner.workshop import Workshop
from drystone.search.by_courses import newly_planned
from drystone.search.chain import Link, lengthened, wedged
from drystone.search.found import Found
from drystone.search.packed import Packed, found_again
from drystone.search.standing import PackedLink


@dataclass(frozen=True, eq=False)
class Job:
    """What all tasks of a search share."""

    tools: bytes  # Stones, site and settings, pickled
    seed: int  # Of the search
    until: Deadline  # Looked at inside every wall


def one_pass(job: Job, number: int, planned_share: float) -> Packed | None:
    """Build a first wall from its seed; None when time is up before it is whole."""
    try:
        found = _first_wall(job, number, planned_share)
    except TimeIsUp:
        return None
    return Packed.of(found)


def _first_wall(job: Job, number: int, planned_share: float) -> Found:
    """Build a first wall; see :func:`one_pass`."""
    workshop, settings = _opened(job.tools)
    job.until.look()
    rng = np.random.default_rng([job.seed, 4_000_000 + number])
    if planned_first(settings) and rng.random() < planned_share:
        planned = newly_planned(workshop, settings, rng, job.until)
        if planned is not None:
            return wedged(planned, workshop, settings, job.until)
    seed = int(rng.integers(2**31))
    planner = Planner(
        workshop.stones, workshop.site, seed=seed, settings=settings, workshop=workshop
    )
    for _ in planner.steps(job.until):
        pass
    return wedged(Found.of(planner), workshop, settings, job.until)


def planned_first(settings: PlannerSettings) -> bool:
    """Say whether courses may be planned: in quarter turns, laid from both ends.

    Plans know quarter turns of the initial pose, which other sets of orientations need not have.
    """
    return settings.orientations == "quarter" and settings.order == "free" and settings.two_sided


def more_links(job: Job, link: PackedLink, count: int) -> PackedLink | None:
    """Build some more walls of a chain, fewer when time is up; None when there is no time."""
    workshop, settings = _opened(job.tools)
    end = None
    try:
        begun = found_again(link.now, workshop, settings, job.until)
        start = Link(link.number, link.done, begun, link.best, link.solves, known=link.known)
        for end in lengthened(start, count, job.seed, workshop, settings, job.until):  # noqa: B007
            pass
    except TimeIsUp:
        pass
    if end is None:
        return None
    now = Packed.of(end.now)
    return PackedLink(
        end.number, end.done, now, end.best, end.solves, end.kept, end.known, end.learnt
    )


def forget() -> None:
    """Let go of what this process has prepared."""
    _opened.cache_clear()


@lru_cache(maxsize=1)
def _opened(tools: bytes) -> tuple[Workshop, PlannerSettings]:
    """Prepare what the tasks of a search share, once in each process."""
    stones, site, settings = pickle.loads(tools)  # noqa: S301 - packed by the same program
    return Workshop.prepare(stones, site, settings), settings
