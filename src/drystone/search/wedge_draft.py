"""A finished wall with wedges tried in it, before its steps are taken again with them."""

from collections.abc import Iterator
from dataclasses import dataclass, replace
from itertools import accumulate

import numpy as np

from drystone.contacts.settled import PlacedPolygons, model_with_outlines
from drystone.kernels.simplex import OPTIMAL
from drystone.planner.build import Build
from drystone.search.wedge_places import Motion, WedgePlace, wedge_places
from drystone.settle.wedge import WedgeLimits, in_order, met_below
from drystone.statics.incremental import IncrementalAnalysis, SimplexAnalysis
from drystone.statics.limit import lateral_resistance
from drystone.statics.model import GROUND, Direction, Interface, RigidBlockModel
from drystone.statics.result import LateralResistance

MOST_UNDER_ONE = 2
"""Wedges under one stone; ids are left for so many (:mod:`drystone.planner.workshop`)."""

MOST_BLOCKS = 400
"""Up to here the simplex kernel is the quickest; one wall is drafted at a time, memory is small."""

PROP_MU = 100.0
"""Friction of the prop that holds a wedge that shall not matter; no wall carries so much."""


@dataclass(frozen=True, eq=False)
class Draft:
    """A finished wall with more wedges, and with wedges that do nothing."""

    analysis: IncrementalAnalysis  # Of the wall; wedges that were added are its last blocks
    placed: PlacedPolygons  # All blocks, in the order of construction
    counts: tuple[int, ...]  # Wedges under the stone of each step
    width: float  # Of the wall, source px
    limits: WedgeLimits  # What wedges may be
    # For each step the places under its stone, once they were asked for; None before
    known: tuple[tuple[WedgePlace, ...] | None, ...]
    # (int, WedgePlace) Ids of the wedges that were added, and where they are
    added: tuple[tuple[int, WedgePlace], ...] = ()

    @classmethod
    def of(cls, build: Build, limits: WedgeLimits) -> "Draft":
        """Begin with a finished wall of outlines that knows its states."""
        outlines = build.wall.outlines
        assert outlines is not None  # noqa: S101 - its caller knows
        return cls(
            analysis_of(build),
            PlacedPolygons(outlines.ids, outlines.polygons),
            tuple(len(group.wedges) for group in build.wall.groups),
            build.wall.site.extent_px[0],
            limits,
            (None,) * len(build.wall.groups),
        )

    @property
    def resistance(self) -> LateralResistance:
        """What it carries."""
        return self.analysis.result.resistance

    @property
    def weaker(self) -> Direction:
        """The direction in which it carries less."""
        left, right = self.resistance.left.alpha, self.resistance.right.alpha
        assert left is not None  # noqa: S101 - its caller knows that the wall stands
        assert right is not None  # noqa: S101
        return "left" if left <= right else "right"

    @property
    def firsts(self) -> tuple[int, ...]:
        """Which blocks are the stones of the steps."""
        return tuple(accumulate((1 + count for count in self.counts[:-1]), initial=0))

    def looked_at(self, motion: Motion) -> "Draft":
        """Look for places under all stones that move in a mechanism, or rest on what moves."""
        known = list(self.known)
        boxes = self.placed.polygons.boxes
        for step, (first, count) in enumerate(zip(self.firsts, self.counts, strict=True)):
            if known[step] is None and count < MOST_UNDER_ONE:
                stone = self.placed.polygons.polygon(first)
                met = np.flatnonzero(met_below(stone, boxes, self.limits)).tolist()
                if not motion.stands_still([self.placed.ids[i] for i in met]):
                    places = wedge_places(self.placed, step, first, self.width, self.limits)
                    known[step] = tuple(places)
        return replace(self, known=tuple(known))

    def places(self) -> Iterator[WedgePlace]:
        """List the places that are known."""
        for places, count in zip(self.known, self.counts, strict=True):
            if places and count < MOST_UNDER_ONE:
                yield from places

    def model_with(self, number: int, place: WedgePlace) -> RigidBlockModel:
        """Return the model of the wall with one more wedge, whose id is given."""
        new, limits = [(number, place.corners)], self.limits
        return model_with_outlines(
            self.analysis.model, new, self.placed, limits.contact_px, limits.setback
        )

    def wedged(self, number: int, place: WedgePlace, model: RigidBlockModel) -> "Draft":
        """Return the wall with one more wedge; `model` is what :meth:`model_with` says."""
        at = self.firsts[place.step] + 1 + self.counts[place.step]
        counts = list(self.counts)
        counts[place.step] += 1
        ids, polygons = self.placed
        added = polygons.added([place.corners])
        order = [*range(at), len(ids), *range(at, len(ids))]
        known = list(self.known)
        for step, first in enumerate(self.firsts):
            if (
                known[step] is not None
                and met_below(polygons.polygon(first), added.boxes[-1:], self.limits)[0]
            ):
                known[step] = None
        return replace(
            self,
            analysis=self.analysis.extended(model),
            placed=PlacedPolygons((*ids[:at], number, *ids[at:]), in_order(added, order)),
            counts=tuple(counts),
            known=tuple(known),
            added=(*self.added, (number, place)),
        )

    def idle(self, wedge: int) -> RigidBlockModel:
        """Return the model of the wall in which a wedge touches nothing and is held from outside.

        It is the wall without the wedge, but can be solved from where the wall ended.
        """
        model = self.analysis.model
        block = next(block for block in model.blocks if block.id == wedge)
        closed = tuple(k for k, i in enumerate(model.interfaces) if wedge in (i.block, i.other))
        (x, y), half = block.centroid, 0.5 * block.area**0.5
        points = np.array([[x - half, y], [x + half, y]])
        prop = Interface(wedge, GROUND, points, (0.0, 1.0), PROP_MU)
        return model.with_added((), (prop,), closed)

    def without(self, model: RigidBlockModel) -> "Draft":
        """Return the wall in which a wedge does nothing; `model` is what :meth:`idle` says."""
        return replace(self, analysis=self.analysis.extended(model))

    def motion(self, direction: Direction) -> Motion | None:
        """Return the mechanism in one direction; None when the solver gives up."""
        analysis = self.analysis
        blocks = analysis.model.blocks
        centroids = {block.id: block.centroid for block in blocks}
        if isinstance(analysis, SimplexAnalysis):
            optimum = analysis.least if direction == "left" else analysis.greatest
            velocity = optimum.velocity.reshape(-1, 3) / [1.0, 1.0, analysis.program.units.length]
            ids = tuple(block.id for block in blocks)
        else:
            both = lateral_resistance(analysis.model, mechanism=True)
            mechanism = (both.left if direction == "left" else both.right).mechanism
            if mechanism is None:
                return None
            ids, velocity = mechanism.block_ids, mechanism.velocity
        fastest = float(np.abs(velocity).max())
        moving = dict(zip(ids, (velocity / fastest).tolist(), strict=True))
        return Motion.of(moving, centroids, analysis.model.mu)

    def alpha_with(self, model: RigidBlockModel, direction: Direction) -> float | None:
        """Return what a grown wall carries in one direction, not certified.

        None when it falls or the solver gives up.
        """
        analysis, addition = self.analysis, model.added
        assert addition is not None  # noqa: S101 - it was made by adding
        if isinstance(analysis, SimplexAnalysis):
            added = analysis.program.columns_of(addition, model.mu)
            optimum = analysis.least if direction == "left" else analysis.greatest
            answer = optimum.solved_with(added) if added is not None else None
            if answer is not None and answer.status == OPTIMAL:
                return max(0.0, optimum.sign * answer.alpha)
        found = analysis.resistance_with(model).resistance
        return (found.left if direction == "left" else found.right).alpha


def analysis_of(build: Build) -> IncrementalAnalysis:
    """Return the analysis of a wall that knows its states, by the simplex kernel if it can be."""
    states = build.states()
    last = len(states) - 1
    while last > 0 and not isinstance(states[last].analysis, SimplexAnalysis):
        last -= 1
    start = states[last].analysis
    if not isinstance(start, SimplexAnalysis):
        return states[-1].analysis  # the kernel is not compiled
    analysis: IncrementalAnalysis = replace(start, most=MOST_BLOCKS)
    for state in states[last + 1 :]:
        new = state.model.added
        assert new is not None  # noqa: S101 - it was made by adding
        model = analysis.model.with_added(new.blocks, new.interfaces, new.closed)
        analysis = analysis.extended(model)
    return analysis
