"""What the processes of a search do: whole walls, from what fits into a message."""

import pickle
import time
from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from drystone.planner.planner import Planner
from drystone.planner.settings import PlannerSettings
from drystone.planner.workshop import Workshop
from drystone.search.by_courses import newly_planned
from drystone.search.chain import Link, lengthened, wedged
from drystone.search.found import Found, Solves
from drystone.search.packed import Packed, found_again

GREEDY_EVERY = 4
"""Every so many first walls on outlines is built stone by stone; the others are planned first."""


@dataclass(frozen=True, eq=False)
class Job:
    """What all tasks of a search share.

    Parameters
    ----------
    tools : bytes
        Stones, site and settings, pickled.
    seed : int
        Of the search.
    deadline : float
        When it is too late for another wall, in the seconds of :func:`time.time`.
    """

    tools: bytes
    seed: int
    deadline: float

    def late(self) -> bool:
        """Say whether it is too late for another wall."""
        return time.time() > self.deadline


@dataclass(frozen=True, eq=False)
class PackedLink:
    """Where a chain is (:class:`drystone.search.chain.Link`)."""

    number: int
    done: int
    now: Packed
    best: Packed
    solves: Solves


def one_pass(job: Job, number: int) -> Packed | None:
    """Build a first wall from its seed; None when it is too late."""
    workshop, settings = _opened(job.tools)
    if job.late():
        return None
    seed = job.seed + number
    if settings.geometry == "exact" and number % GREEDY_EVERY:
        planned = newly_planned(workshop, settings, np.random.default_rng([seed, 4_000_000]))
        if planned is not None:
            return Packed.of(wedged(planned, workshop, settings))
    planner = Planner(
        workshop.stones, workshop.site, seed=seed, settings=settings, workshop=workshop
    )
    for _ in planner.steps():
        pass
    return Packed.of(wedged(Found.of(planner), workshop, settings))


def more_links(job: Job, link: PackedLink, count: int) -> PackedLink | None:
    """Build some more walls of a chain; None when it became too late."""
    workshop, settings = _opened(job.tools)
    now = found_again(link.now, workshop, settings)
    start = Link(link.number, link.done, now, link.best, link.solves)
    end = lengthened(start, count, job.seed, workshop, settings, job.late)
    if end is None:
        return None
    return PackedLink(end.number, end.done, Packed.of(end.now), end.best, end.solves)


@lru_cache(maxsize=1)
def _opened(tools: bytes) -> tuple[Workshop, PlannerSettings]:
    """Prepare what the tasks of a search share, once in each process."""
    stones, site, settings = pickle.loads(tools)  # noqa: S301 - packed by the same program
    return Workshop.prepare(stones, site, settings), settings
