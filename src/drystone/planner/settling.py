"""Proposals on outlines: dropped onto a height profile, then settled exactly (DESIGN 4.9)."""

import math
from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from operator import attrgetter

from drystone.kernels.drops import DropTerms, drops
from drystone.kernels.polygons import Points
from drystone.kernels.profiles import OVER, HeightProfile, StoneProfile, bare, raised
from drystone.model.placement import Side
from drystone.model.pose import PosedStone
from drystone.model.wall import outlined
from drystone.planner.build import Build, Proposal
from drystone.planner.craft import action_craft
from drystone.planner.profile import Profile
from drystone.planner.proposing import Apply, Key, Trial
from drystone.planner.settings import PlannerSettings
from drystone.planner.stock import Stock
from drystone.planner.workshop import Workshop
from drystone.selection.scored import craft_cost
from drystone.settle.placing import settled_placement, settled_wedge
from drystone.settle.rest import Repose, Scene, come_to_rest
from drystone.settle.settings import SettleSettings
from drystone.settle.wedge import WedgeLimits
from drystone.settle.wedged import wedged
from drystone.stabilise.stabilise import Stabilised

SLACK = 0.15
"""A stone may stand out over the wall's height by so many mean stone sizes where it is dropped."""

UNBALANCED = 2.0
"""Cost of a centroid that is beside what carries a dropped stone, in widths of the stone."""


@dataclass(frozen=True, eq=False)
class Drop:
    """A place where a stone could be let go.

    Parameters
    ----------
    trial : Trial
        Stone and side.
    spot : int
        Which place of the trial's pose.
    start : (float, float)
        Of its centroid, in the view, source px.
    rank : (float, tuple)
        Estimated cost, and what tells it from the others of a step: sorts the cheapest first.
    """

    trial: Trial
    spot: int
    start: tuple[float, float]
    rank: tuple[float, tuple[Key, int]]

    @property
    def key(self) -> tuple[Key, int]:
        """What tells it from the others of a step."""
        return self.rank[1]


class ExactProposer:
    """Stones settle on the outlines of others.

    Where selection goes by cost, the cheapest drops of all trials are settled, and where none of
    them can be used the next ones; Algorithm 2 compares all trials, each where its first drop
    rests.

    Parameters
    ----------
    workshop : Workshop
        Stones and site.
    settings : PlannerSettings
        All parameters.
    build : Build
        What is built.
    profile : Profile
        Told where the time goes.
    """

    def __init__(
        self, workshop: Workshop, settings: PlannerSettings, build: Build, profile: Profile
    ) -> None:
        self._workshop = workshop
        self._settings = settings
        self._build = build
        self._profile = profile
        self._views: dict[Side, tuple[Scene, HeightProfile]] = {}
        self._limits = wedge_limits(settings, workshop.stock, build.wall.site.scale)
        self._drops: dict[Key, tuple[Drop, ...]] = {}
        self._settled: dict[tuple[Key, int], Proposal | None] = {}

    @property
    def tried(self) -> int:
        """See :class:`drystone.planner.proposing.Proposer`."""
        return len(self._drops)

    def proposals(self, trials: Sequence[Trial], apply: Apply) -> Iterator[list[Proposal]]:
        """See :class:`drystone.planner.proposing.Proposer`."""
        drops = self.drops(trials, apply)
        if self._settings.selection_rule == "score":
            yield from self._cheapest([drop for mine in drops for drop in mine], apply)
        else:
            yield [proposal for proposal in apply(self._first, drops) if proposal is not None]

    def drops(self, trials: Sequence[Trial], apply: Apply) -> list[tuple[Drop, ...]]:
        """Return the best places of each trial, the cheapest first."""
        for side in dict.fromkeys(trial.landscape.side for trial in trials):
            self.view(side)
        _ = self._terms  # before the threads ask for it, all at once
        new = [trial for trial in trials if trial.key not in self._drops]
        found = apply(self._dropped, new)
        self._drops.update(zip([trial.key for trial in new], found, strict=True))
        return [self._drops[trial.key] for trial in trials]

    def view(self, side: Side) -> tuple[Scene, HeightProfile]:
        """Return what is built and how high it is, as it is seen from a side."""
        if side not in self._views:
            site, outlines = self._build.wall.site, self._build.wall.outlines
            assert outlines is not None  # noqa: S101 - the planner builds on outlines
            scene = Scene.of(outlines.polygons, site.extent_px[0], side, self._settings.mu)
            profile = bare(site.width_px)
            for index in range(len(scene.polygons)):
                corners = scene.polygons.polygon(index)
                profile = raised(profile, corners, index, 1.0 / site.scale)
            self._views[side] = scene, profile
        return self._views[side]

    def _dropped(self, trial: Trial) -> tuple[Drop, ...]:
        """Return the best places of the poses of a trial, the cheapest first."""
        side, settings = trial.landscape.side, self._settings.settle
        terms = self._terms
        _, profile = self.view(side)
        found = []
        with self._profile.part("placement"):
            for posed in trial.poses:
                hung = self._workshop.outlines.hung(posed.stone, posed.angle_deg, side)
                size_px = hung.turned.size_px
                constant = _pose_cost(posed, self._workshop.stock, self._settings)
                places = drops(
                    profile, hung.profile, terms, constant, settings.spots, settings.apart * size_px
                )
                one = replace(trial, poses=(posed,))
                key, left = one.key, hung.profile.left
                found += [
                    Drop(one, spot, (x - left, y), (round(cost, 12), (key, spot)))
                    for spot, (x, y, cost, _) in enumerate(places.tolist())
                ]
        return tuple(sorted(found, key=attrgetter("rank")))

    @cached_property
    def _terms(self) -> DropTerms:
        """What drops cost in this state of construction."""
        site, stock, score = self._build.wall.site, self._workshop.stock, self._settings.score
        rest = self._workshop.rest(self._build)
        return DropTerms(
            cell_px=1.0 / site.scale,
            width_px=site.extent_px[0] + 2.0 * self._settings.settle.beyond_px,
            height_px=site.extent_px[1],
            slack_px=SLACK * stock.mean_area_px**0.5 / site.scale,
            clearance_px=2.0 * self._settings.settle.clearance_px,
            narrowest_px=stock.narrowest_px / site.scale,
            mean_height_px=stock.mean_height_px / site.scale,
            mean_area_px=stock.mean_area_px / site.scale**2,
            height=score.height,
            void=score.void,
            gap=score.gap,
            slot=score.slot,
            headroom=score.headroom,
            step=score.step,
            joint=score.joint,
            unbalanced=UNBALANCED,
            rest_width_px=rest.width_px,
            rest_height_px=rest.height_px,
        )

    def _cheapest(self, drops: list[Drop], apply: Apply) -> Iterator[list[Proposal]]:
        """Settle the cheapest drops, then the next ones, and so on."""
        while drops:
            batch, drops = shortlist(drops, self._settings.settle)
            yield [proposal for proposal in self._all_settled(batch, apply) if proposal]

    def _all_settled(self, drops: Sequence[Drop], apply: Apply) -> list[Proposal | None]:
        new = [drop for drop in drops if drop.key not in self._settled]
        self._settled.update(zip([d.key for d in new], apply(self._settle, new), strict=True))
        return [self._settled[drop.key] for drop in drops]

    def _first(self, drops: Sequence[Drop]) -> Proposal | None:
        """Settle the drops of a trial until one rests."""
        for drop in drops:
            if drop.key not in self._settled:
                self._settled[drop.key] = self._settle(drop)
            if self._settled[drop.key] is not None:
                return self._settled[drop.key]
        return None

    def _settle(self, drop: Drop) -> Proposal | None:
        """Let a stone go where it was dropped; None when it does not rest inside the wall."""
        side, posed = drop.trial.landscape.side, drop.trial.poses[0]
        scene, profile = self.view(side)
        hung = self._workshop.outlines.hung(posed.stone, posed.angle_deg, side)
        start = self._beside(drop.start, hung.profile, profile)
        method, settings = self._settings.stabilise.method, self._settings.settle
        with self._profile.part("stabilisation"):
            stabilised = None
            repose = come_to_rest(
                hung.turned, scene, start, settings, turns=method in ("both", "rotation")
            )
            if repose is not None:
                stabilised = self._stabilised(drop, repose)
            elif method in ("both", "wedge"):  # rotation first, wedging second (§3.7)
                found = wedged(hung.turned, scene, start, settings, self._limits)
                if found is not None:
                    stabilised = self._stabilised(drop, found.repose, found.wedge)
        if stabilised is None:
            return None
        cost = 0.0
        if self._settings.weighs_craft:
            assert drop.trial.rest is not None  # noqa: S101 - the attempt gives it then
            with self._profile.part("indices"):
                craft = action_craft(
                    drop.trial.landscape, stabilised, self._workshop.stock, drop.trial.rest
                )
            cost = craft_cost(craft, self._settings.score)
        return Proposal(stabilised, posed.angle_deg, cost=cost, spot=drop.spot)

    def _beside(
        self, start: tuple[float, float], stone: StoneProfile, profile: HeightProfile
    ) -> tuple[float, float]:
        """Move a stone away from the neighbour on the building side that it may overlap a little.

        A profile leaves out what reaches into a column by little.
        """
        x, y = start
        left = x + stone.left
        reach = left + OVER / self._build.wall.site.scale
        beside = [
            right
            for _, bottom, right, top in profile.boxes.tolist()
            if left < right < reach and bottom < y + stone.top and top > y + stone.bottom
        ]
        clear = 2.0 * self._settings.settle.clearance_px
        return (max(beside) + clear - stone.left, y) if beside else start

    def _stabilised(
        self, drop: Drop, repose: Repose, wedge: Points | None = None
    ) -> Stabilised | None:
        """Return a stone that rests, with the pixels that it fills; None when it is too high."""
        wall, posed = self._build.wall, drop.trial.poses[0]
        assert wall.outlines is not None  # noqa: S101 - the planner builds on outlines
        beyond_px = self._settings.settle.beyond_px
        if repose.settled.corners[:, 1].max() > wall.site.extent_px[1] + beyond_px:
            return None
        placement = settled_placement(
            wall.outlines,
            wall.site,
            posed.stone,
            repose.angle_deg,
            repose.settled,
            drop.trial.landscape.side,
            int(repose.turned),
        )
        if placement is None or wedge is None:
            return None if placement is None else Stabilised(placement)
        number = self._workshop.next_wedge(self._build)
        with_stone = wall.outlines.added(outlined(placement, ()), wall.site.scale)
        under = settled_wedge(with_stone, wall.site, number, posed.stone.id, wedge)
        return Stabilised(placement, (under,))


def shortlist(drops: Sequence[Drop], settings: SettleSettings) -> tuple[list[Drop], list[Drop]]:
    """Take the cheapest drops, only so many of one stone; return those and the others."""
    taken: list[Drop] = []
    left: list[Drop] = []
    counts: Counter[int] = Counter()
    for drop in sorted(drops, key=attrgetter("rank")):
        stone_id = drop.key[0][0]
        if len(taken) < settings.shortlist and counts[stone_id] < settings.per_stone:
            counts[stone_id] += 1
            taken.append(drop)
        else:
            left.append(drop)
    return taken, left


def _pose_cost(posed: PosedStone, stock: Stock, settings: PlannerSettings) -> float:
    """Return what a pose costs wherever it goes."""
    score = settings.score
    upright = max(0.0, 1.0 - posed.width_px / posed.height_px)
    return math.fsum(
        [
            score.roughness * posed.top_roughness_px / stock.mean_height_px,
            score.upright * upright,
            -score.area * posed.area_px / stock.mean_area_px,
            -score.thickness * min(posed.width_px, posed.height_px) / stock.mean_height_px,
        ]
    )


def wedge_limits(settings: PlannerSettings, stock: Stock, scale: float) -> WedgeLimits:
    """Return what wedges may be, in source px.

    Parameters
    ----------
    settings : PlannerSettings
        Sizes in working px and in mean stone heights.
    stock : Stock
        Sizes of the stones, working px.
    scale : float
        Working resolution over source resolution.
    """
    sizes, settle = settings.stabilise, settings.settle
    smallest = sizes.min_wedge_px / scale
    return WedgeLimits(
        smallest_px=smallest,
        largest_px=max(smallest, sizes.max_wedge_height * stock.mean_height_px / scale),
        margin=sizes.margin,
        mu=settings.mu,
        clearance_px=settle.clearance_px,
        contact_px=0.5 * settle.contact_px,
        rest=settle.margin,
        steep=settle.steep,
    )
