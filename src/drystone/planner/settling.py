"""Proposals on outlines: dropped onto a height profile, then settled exactly (DESIGN 4.9)."""

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from functools import cached_property, partial
from itertools import chain, islice

import numpy as np

from drystone.kernels.drops import DropTerms, Wanted, drops
from drystone.kernels.profiles import OVER, HeightProfile, StoneProfile, in_a_row
from drystone.model.placement import Side
from drystone.planner.build import Proposal
from drystone.planner.dropping import Drop, Dropped, drop_terms, in_order, shortlist
from drystone.planner.proposing import Apply, Key, Proposer, StoneTrial, one_by_one
from drystone.planner.views import SideView
from drystone.settle.placing import settled_in
from drystone.settle.rest import come_to_rest
from drystone.settle.wedge import wedged

CHUNK = 256
"""So many trials of one side are dropped together."""

TOGETHER = 6
"""So many drops are settled together: most of that holds the interpreter's lock, and threads that
hand it over more often lose more than they gain."""


@dataclass(frozen=True, eq=False)
class ExactProposer(Proposer):
    """Stones settle on the outlines of others.

    Where selection goes by cost, the cheapest drops of all trials are settled, and where none of
    them can be used the next ones; Algorithm 2 compares all trials, each where its first drop
    rests.
    """

    _views: dict[Side, SideView] = field(default_factory=dict, init=False)
    _settled: dict[tuple[Key, int], Proposal | None] = field(default_factory=dict, init=False)

    def proposals(self, trials: Sequence[StoneTrial], apply: Apply) -> Iterator[list[Proposal]]:
        """See :class:`drystone.planner.proposing.Proposer`."""
        if self.settings.selection_rule == "score":
            for batch in self.batches(trials, apply):
                new = [drop for drop in batch if drop.key not in self._settled]
                groups = [new[k : k + TOGETHER] for k in range(0, len(new), TOGETHER)]
                settled = apply(partial(one_by_one, self._settle), groups)
                self._settled.update(zip([drop.key for drop in new], chain(*settled), strict=True))
                yield [found for drop in batch if (found := self._settled[drop.key]) is not None]
        else:
            drops = self.drops(trials, apply)
            yield [proposal for proposal in apply(self._first, drops) if proposal is not None]

    def drops(self, trials: Sequence[StoneTrial], apply: Apply) -> list[tuple[Drop, ...]]:
        """Return the best places of each trial, the cheapest first."""
        self._drop(trials, apply, math.inf)
        book = self.workshop.outlines
        return [tuple(in_order([self.tried[trial.key]], book)) for trial in trials]

    def batches(self, trials: Sequence[StoneTrial], apply: Apply) -> Iterator[list[Drop]]:
        """List the cheapest drops of all trials, then the next ones, and so on."""
        given: set[tuple[Key, int]] = set()
        settings, needed = self.settings.settle, -math.inf
        while True:
            self._drop(trials, apply, needed)
            known = in_order([self.tried[t.key] for t in trials], self.workshop.outlines)
            batch = shortlist((drop for drop in known if drop.key not in given), settings)
            needed = batch[-1].cost if len(batch) == settings.shortlist else math.inf
            if any(self.tried[trial.key].limit < needed for trial in trials):
                continue  # cheaper ones than some of these may be missing
            if not batch:
                return
            given.update(drop.key for drop in batch)
            yield batch

    def view(self, side: Side) -> SideView:
        """Return what is built and how high it is, as it is seen from a side."""
        if side not in self._views:
            built, site = self.build.wall.exact.polygons, self.build.wall.site
            self._views[side] = self.workshop.views.of(
                built, side, self.settings.mu, site.width_px, 1.0 / site.scale
            )
        return self._views[side]

    @cached_property
    def _terms(self) -> DropTerms:
        site, stock = self.build.wall.site, self.workshop.stock
        return drop_terms(site, stock, self.rest, self.settings)

    def _drop(self, trials: Sequence[StoneTrial], apply: Apply, needed: float) -> None:
        """Drop the stones of the trials of which not all drops up to a cost are known.

        At first, when none is needed yet, what may be among the cheapest is looked for; later all.
        """
        known = self.tried
        lacking = [t for t in trials if t.key not in known or known[t.key].limit < needed]
        cheapest = self.settings.settle.shortlist if needed == -math.inf else 0
        chunks = []
        for side in dict.fromkeys(trial.landscape.side for trial in lacking):
            self.view(side)
            mine = [trial for trial in lacking if trial.landscape.side == side]
            chunks += [mine[k : k + CHUNK] for k in range(0, len(mine), CHUNK)]
        _ = lacking and self._terms  # before the threads ask for them, all at once
        for found in apply(partial(self._dropped_together, cheapest), chunks):
            known.update((one.trial.key, one) for one in found)

    def _dropped_together(self, cheapest: int, trials: Sequence[StoneTrial]) -> list[Dropped]:
        side, settings = trials[0].landscape.side, self.settings.settle
        poses = [posed for trial in trials for posed in trial.poses]
        with self.profile.part("placement"):
            book = self.workshop.outlines
            hung = [book.hung(posed.stone, posed.angle_deg, side) for posed in poses]
            wanted = Wanted(
                settings.spots,
                settings.apart * np.array([one.turned.size_px for one in hung]),
                np.array([posed.stone.id for posed in poses], np.int64),
                cheapest,
                settings.per_stone,
            )
            stones = in_a_row([one.profile for one in hung])
            constants = self.workshop.costs.of(poses, self.settings.score)
            places, limit = drops(self.view(side).profile, stones, self._terms, constants, wanted)
        next_ones = iter(places)
        return [
            Dropped(trial, tuple(islice(next_ones, len(trial.poses))), limit) for trial in trials
        ]

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
        scene, profile = self.view(side).scene, self.view(side).profile
        hung = self.workshop.outlines.hung(posed.stone, posed.angle_deg, side)
        start = self._beside(drop.start, hung.profile, profile)
        method, settings = self.settings.stabilise.method, self.settings.settle
        with self.profile.part("stabilisation"):
            turns, wedge = method in ("both", "rotation"), None
            repose = come_to_rest(hung.turned, scene, start, settings, turns=turns)
            if repose is None and method in ("both", "wedge"):  # rotation first (§3.7)
                found = wedged(hung.turned, scene, start, settings, self.workshop.limits)
                repose, wedge = found or (None, None)
            highest = self.build.wall.site.extent_px[1] + settings.beyond_px
            if repose is None or repose.settled.corners[:, 1].max() > highest:
                return None
            number = self.workshop.next_wedge(self.build)
            stabilised = settled_in(
                self.build.wall, posed.stone, side, repose, wedge, wedge_id=number
            )
        if stabilised is None:  # it fills no pixel
            return None
        cost = self._cost(drop.trial, stabilised)
        return Proposal(stabilised, posed.angle_deg, cost=cost, spot=drop.spot)

    def _beside(
        self, start: tuple[float, float], stone: StoneProfile, profile: HeightProfile
    ) -> tuple[float, float]:
        """Move a stone away from the neighbour on the building side that it may overlap a little.

        A profile leaves out what reaches into a column by little.
        """
        x, y = start
        left = x + stone.left
        reach = left + OVER / self.build.wall.site.scale
        beside = [
            right
            for _, bottom, right, top in profile.boxes.tolist()
            if left < right < reach and bottom < y + stone.top and top > y + stone.bottom
        ]
        clear = 2.0 * self.settings.settle.clearance_px
        return (max(beside) + clear - stone.left, y) if beside else start
