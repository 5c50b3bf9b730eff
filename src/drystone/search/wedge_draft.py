"""A finished wall with wedges tried in it, before its steps are taken again with them.

In an associative limit analysis a contact that is added can only raise the load multiplier, and
does so only if the mechanism in which the wall fails would close it, or slide along it without
opening it as much as friction asks for.
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from itertools import accumulate

import numpy as np
from numpy.typing import NDArray

from drystone.contacts.settled import PlacedPolygons, model_with_outlines
from drystone.kernels.meetings import meetings
from drystone.kernels.polygons import Points, area_and_centroid
from drystone.kernels.simplex import OPTIMAL
from drystone.model.wedge_shape import open_sides
from drystone.planner.build import Build
from drystone.settle.wedge import WedgeLimits, in_order, met_below, rests, wedges_below
from drystone.statics.incremental import IncrementalAnalysis, SimplexAnalysis
from drystone.statics.limit import lateral_resistance
from drystone.statics.model import GROUND, Direction, Interface, RigidBlockModel
from drystone.statics.result import LateralResistance

Ids = NDArray[np.int64]
Twist = tuple[float, float, float]
"""How a block moves: velocity of its point at the origin of the wall frame, rate of turning."""

STILL: Twist = (0.0, 0.0, 0.0)
SLOW = 1e-9
"""What moves no faster than this stands still; the fastest block has a velocity of 1."""

MOST_UNDER_ONE = 2
"""Wedges under one stone; ids are left for so many (:mod:`drystone.planner.workshop`)."""

MOST_BLOCKS = 400
"""Up to here the simplex kernel is the quickest; one wall is drafted at a time, memory is small."""


@dataclass(frozen=True, eq=False)
class WedgePlace:
    """A wedge that has room in a finished wall, and what it would touch."""

    step: int  # which step places the stone that would lie on it
    corners: Points  # (n, 2), its outline in the wall frame, counter-clockwise, source px
    # (m,), at each contact point, the id of the block that it touches; GROUND for the ground.
    others: Ids
    points: Points  # (m, 2), the contact points, and unit vectors into the wedge
    normals: Points

    @classmethod
    def of(
        cls, step: int, corners: Points, placed: PlacedPolygons, limits: WedgeLimits
    ) -> "WedgePlace":
        """Find what a wedge touches of all blocks of a wall."""
        found = meetings(corners, placed.polygons, limits.contact_px, limits.setback)
        ids = [placed.ids[other] if other >= 0 else GROUND for other in found.others.tolist()]
        # A contact at a point comes twice, which changes no rate.
        return cls(
            step,
            corners,
            np.repeat(np.array(ids, np.int64), 2),
            found.points.reshape(-1, 2),
            np.repeat(found.normals, 2, axis=0),
        )

    @cached_property
    def area_px(self) -> float:
        """Its area, square source px."""
        return area_and_centroid(self.corners)[0]

    @cached_property
    def carriers(self) -> Ids:
        """Ids of what it touches, each once, ascending."""
        return np.unique(self.others)


def wedge_places(
    placed: PlacedPolygons, step: int, first: int, width: float, limits: WedgeLimits
) -> Iterator[WedgePlace]:
    """List wedges under a stone of a finished wall.

    They overlap nothing that is there, rest on what was there before the stone, and have something
    beside them at both sides.
    """
    before = placed.polygons.leading(first)
    for corners in wedges_below(placed.polygons, first, limits):
        if rests(corners, before, width, limits) and not any(open_sides(corners, placed.polygons)):
            yield WedgePlace.of(step, corners, placed, limits)


@dataclass(frozen=True, eq=False)
class Motion:
    """How the blocks of a wall move in a mechanism."""

    twists: Mapping[int, Twist]  # of all blocks, by id, and of the ground
    mu: float

    @classmethod
    def of(
        cls,
        velocity: Mapping[int, Sequence[float]],
        centroids: Mapping[int, tuple[float, float]],
        mu: float,
    ) -> "Motion":
        """Make it of the velocities of centroids and the rates of turning of the free blocks."""
        twists = {GROUND: STILL}
        for block, (x, y) in centroids.items():
            along, up, turning = velocity.get(block, STILL)
            twists[block] = (along + turning * y, up - turning * x, turning)
        return cls(twists, mu)

    def stands_still(self, blocks: Sequence[int]) -> bool:
        """Say whether none of some blocks moves: nothing between them matters."""
        return all(max(map(abs, self.twists[block])) <= SLOW for block in blocks)

    def resisted_by(self, places: Sequence[WedgePlace]) -> NDArray[np.float64]:
        """Return how fast the mechanism violates the contacts of wedges, (k,).

        Of each at the point where it is violated most, when the wedge moves along with the one of
        its neighbours with which it is violated least.  0: the wall fails as it did.
        """
        rates = np.zeros(len(places))
        touching = [k for k, place in enumerate(places) if len(place.others)]
        if not touching:
            return rates
        met = [places[k] for k in touching]
        counts = np.array([len(place.carriers) for place in met])
        sizes = np.repeat([len(place.others) for place in met], counts)
        # One row for every contact point of a wedge and every neighbour that it moves along with.
        others = np.concatenate([np.tile(place.others, len(place.carriers)) for place in met])
        carriers = np.repeat(np.concatenate([place.carriers for place in met]), sizes)
        x, y = np.concatenate([np.tile(place.points, (len(place.carriers), 1)) for place in met]).T
        out_x, out_y = np.concatenate(
            [np.tile(place.normals, (len(place.carriers), 1)) for place in met]
        ).T
        along, up, turning = (self._rows(carriers) - self._rows(others)).T
        along, up = along - turning * y, up + turning * x
        needed = self.mu * np.abs(along * out_y - up * out_x) - (along * out_x + up * out_y)
        worst = np.maximum.reduceat(needed, np.cumsum(sizes) - sizes)
        rates[touching] = np.minimum.reduceat(worst, np.cumsum(counts) - counts).clip(0.0)
        return rates

    def _rows(self, blocks: Ids) -> NDArray[np.float64]:
        ids, where = np.unique(blocks, return_inverse=True)
        return np.array([self.twists[block] for block in ids.tolist()])[where]


@dataclass(frozen=True, eq=False)
class WedgeDraft:
    """A finished wall with more wedges, and with wedges that do nothing."""

    analysis: IncrementalAnalysis  # of the wall; wedges that were added are its last blocks
    placed: PlacedPolygons  # all blocks, in the order of construction
    counts: tuple[int, ...]  # wedges under the stone of each step
    width: float  # of the wall, source px
    limits: WedgeLimits  # what wedges may be
    # For each step the places under its stone, once they were asked for; None before.
    known: tuple[tuple[WedgePlace, ...] | None, ...]
    # Ids of the wedges that were added, and where they are.
    added: tuple[tuple[int, WedgePlace], ...] = ()

    @classmethod
    def of(cls, build: Build, limits: WedgeLimits) -> "WedgeDraft":
        """Begin with a finished wall of outlines that knows its states."""
        outlines = build.wall.exact
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

    def looked_at(self, motion: Motion) -> "WedgeDraft":
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

    def wedged(self, number: int, place: WedgePlace, model: RigidBlockModel) -> "WedgeDraft":
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
        prop = Interface(wedge, GROUND, points, (0.0, 1.0), 100.0)  # no wall carries so much
        return model.with_added((), (prop,), closed)

    def without(self, model: RigidBlockModel) -> "WedgeDraft":
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

    def value_with(self, model: RigidBlockModel, direction: Direction) -> float | None:
        """Return what a grown wall carries in one direction, over mu, not certified.

        None when it falls or the solver gives up.
        """
        analysis, addition, mu = self.analysis, model.added, self.resistance.mu
        assert addition is not None  # noqa: S101 - it was made by adding
        if isinstance(analysis, SimplexAnalysis):
            added = analysis.program.columns_of(addition)
            optimum = analysis.least if direction == "left" else analysis.greatest
            answer = optimum.solved_with(added) if added is not None else None
            if answer is not None and answer.status == OPTIMAL:
                return max(0.0, optimum.sign * answer.alpha) / mu
        found = analysis.resistance_with(model).resistance
        alpha = (found.left if direction == "left" else found.right).alpha
        return None if alpha is None else alpha / mu


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
