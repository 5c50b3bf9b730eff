"""A wall of outlines half built, and stones that are let go on it."""

from dataclasses import dataclass
from functools import cache
from itertools import islice

import numpy as np

from benchmarks.scenes import Stock
from drystone.kernels.drops import DropTerms
from drystone.kernels.polygons import Points, Polygons
from drystone.kernels.profiles import HeightProfile
from drystone.kernels.settling import Settling, SettlingRules, Status, settle
from drystone.model.landscape import Landscape
from drystone.planner.dropping import Drop
from drystone.planner.planner import Planner
from drystone.planner.proposing import StoneTrial, one_by_one
from drystone.planner.settings import method_settings
from drystone.planner.settling import ExactProposer
from drystone.settle.book import Hung
from drystone.settle.rest import SettlingScene, settled_at, ways
from drystone.settle.settings import SettleSettings

CELL = 2.0
"""Source px in a working px: the resolution of the paper."""


@dataclass(frozen=True, eq=False)
class LetGo:
    """A stone that is let go."""

    hung: Hung  # The stone
    start: tuple[float, float, float]  # Its pose
    rules: SettlingRules  # How it settles


@dataclass(frozen=True, eq=False)
class OutlineScene:
    """A wall half built, seen from the left, and what is asked about it."""

    name: str  # In words
    scene: SettlingScene  # What is built
    profile: HeightProfile  # How high it is
    terms: DropTerms  # What drops cost
    settings: SettleSettings  # How stones settle
    let_go: tuple[LetGo, ...]  # Stones that the planner would let go next

    @property
    def polygons(self) -> Polygons:
        """What is built."""
        return self.scene.polygons

    @property
    def outlines(self) -> list[Points]:
        """What is built, one by one."""
        return [self.polygons.polygon(index) for index in range(len(self.polygons))]

    def settled(self, one: LetGo) -> Settling:
        """Let a stone go."""
        stone, scene = one.hung.turned, self.scene
        return settle(
            stone.corners, stone.edges, one.start, scene.polygons, scene.width_px, one.rules
        )

    def resting(self) -> list[Points]:
        """Return the stones that rest, where they do."""
        found = [(one, self.settled(one)) for one in self.let_go]
        return [
            settled_at(one.hung.turned.corners, float(np.degrees(end.angle)), end.x, end.y).corners
            for one, end in found
            if end.status is Status.RESTS
        ]


@cache
def outline_scene(stones: Stock) -> OutlineScene:
    """Return the first half of a wall that `best` builds of outlines, and the stones left."""
    settings = method_settings("best")
    planner = Planner(stones.stones, stones.site(1.0 / CELL), seed=1, settings=settings)
    for _ in islice(planner.steps(), len(stones.stones) // 2):
        pass
    workshop, build = planner.workshop, planner.build
    proposer = ExactProposer(workshop, settings, build, planner.profile)
    view = proposer.view("left")
    scene, profile = view.scene, view.profile
    landscape = Landscape.of(build.wall)
    trials = [
        StoneTrial((posed,), landscape)
        for stone in workshop.remaining(build)
        for posed in workshop.poses(stone)
    ]
    chosen = next(proposer.batches(trials, one_by_one), [])

    def let_go(drop: Drop) -> LetGo:
        posed = drop.trial.poses[0]
        hung = workshop.outlines.hung(posed.stone, posed.angle_deg, "left")
        return LetGo(hung, (*drop.start, 0.0), ways(hung.turned, scene, settings.settle)[0])

    return OutlineScene(
        f"{stones.name}, {len(scene.polygons)} placed",
        scene,
        profile,
        proposer._terms,  # noqa: SLF001 - what drops cost is asked for nowhere else
        settings.settle,
        tuple(let_go(drop) for drop in chosen),
    )
