"""Proposals on outlines: dropped onto a height profile, then settled exactly (DESIGN 4.9)."""

from collections.abc import Iterator, Sequence
from dataclasses import replace
from functools import cached_property
from operator import attrgetter

from drystone.kernels.drops import DropTerms, drops
from drystone.kernels.polygons import Points
from drystone.kernels.profiles import OVER, HeightProfile, StoneProfile, bare, raised
from drystone.model.placement import Side
from drystone.model.wall import outlined
from drystone.planner.build import Build, Proposal
from drystone.planner.dropping import Drop, drop_terms, pose_cost, shortlist, wedge_limits
from drystone.planner.profile import Profile
from drystone.planner.proposing import Apply, Key, Trial, action_cost
from drystone.planner.settings import PlannerSettings
from drystone.planner.workshop import Workshop
from drystone.settle.placing import settled_placement, settled_wedge
from drystone.settle.rest import Repose, Scene, come_to_rest
from drystone.settle.wedged import wedged
from drystone.stabilise.stabilise import Stabilised


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
                constant = pose_cost(posed, self._workshop.stock, self._settings)
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
        rest = self._workshop.rest(self._build)
        return drop_terms(self._build.wall.site, self._workshop.stock, rest, self._settings)

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
        with self._profile.part("indices"):
            cost = action_cost(drop.trial, stabilised, self._workshop, self._settings)
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
