"""Small wedges in the gaps of a finished wall, where they raise its lateral resistance most."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from drystone.model.placement import Wedge
from drystone.model.wall import Group, outlined
from drystone.planner.build import Build
from drystone.planner.replay import replayed
from drystone.planner.settings import PlannerSettings
from drystone.planner.workshop import Workshop
from drystone.search.wedge_places import Motion, WedgePlace, wedge_places
from drystone.settle.wedge import WedgeLimits
from drystone.statics.contacts.settled import (
    PlacedPolygons,
    model_of_outlines,
    model_with_outlines,
)
from drystone.statics.limit import lateral_resistance
from drystone.statics.model import RigidBlockModel
from drystone.statics.result import LateralResistance

LEAST = 0.003
"""A wedge is added when the weaker direction gains so much, in F_LR."""

SAME = 1e-7
"""F_LR is the same within this: two optima of programs that differ by an idle block."""

ANALYSED = 24
"""Most wedges of a round that are analysed: those that the mechanism violates most."""

REPLAYED = 4
"""Most of these with which the steps are taken again."""

NOTHING = np.zeros((0, 0), bool)


@dataclass(frozen=True, eq=False)
class _Yard:
    """What wedging needs beside the wall: see :func:`wedged_up`."""

    workshop: Workshop
    settings: PlannerSettings
    limits: WedgeLimits
    course_heights_px: dict[int, float]

    def again(self, start: Build, groups: Sequence[Group]) -> Build | None:
        """Take steps again on what is built; None when one of them cannot be taken."""
        build, left_out, _ = replayed(
            start, groups, self.course_heights_px, self.workshop, self.settings
        )
        return None if left_out else build

    def from_step(self, build: Build, step: int, wedges: tuple[Wedge, ...]) -> Build | None:
        """Return a wall that has other wedges in one step; None when it would not stand."""
        groups = build.wall.groups[step:]
        changed = Group(groups[0].placement, wedges)
        return self.again(build.states()[step], (changed, *groups[1:]))


def wedged_up(
    build: Build, workshop: Workshop, settings: PlannerSettings, limits: WedgeLimits, most: int
) -> Build:
    """Add wedges to a finished wall that raise F_LR, and drop those that do not matter.

    No stone moves.  A wedge is placed with the stone that lies on it, and the wall stands after
    every step, in both models.

    Parameters
    ----------
    build : Build
        A wall of outlines.
    workshop : Workshop
        Stones and site.
    settings : PlannerSettings
        With which it was built.
    limits : WedgeLimits
        What wedges may be (:func:`drystone.planner.dropping.wedge_limits`).
    most : int
        So many are added.

    Returns
    -------
    build : Build
        With all its states; the same when nothing changes, or when its own steps cannot be taken
        again.
    """
    if build.wall.outlines is None:
        raise ValueError("only walls of outlines are wedged up")
    heights = {
        action.stone_id: action.course_height_px
        for action in build.actions
        if action.course_height_px is not None
    }
    yard = _Yard(workshop, settings, limits, heights)
    begun = _with_states(build, yard)
    if begun is None or not begun.actions:
        return build
    wall, added = begun, 0
    while added < most and (better := _with_one_more(wall, yard)) is not None:
        wall, added = better, added + 1
    wall = _without_needless(wall, yard)
    return build if wall is begun else wall


def _with_states(build: Build, yard: _Yard) -> Build | None:
    """Return the same wall with all states on the way; None when it cannot be built again."""
    if len(build.states()) == len(build.actions) + 1:
        return build
    mean_area_px = yard.workshop.stock.mean_area_px
    empty = Build.empty(build.wall.site, yard.settings.mu, mean_area_px, exact=True)
    return yard.again(empty, build.wall.groups)


def _value(build: Build) -> float:
    return build.actions[-1].resistance.value or 0.0


def _with_one_more(build: Build, yard: _Yard) -> Build | None:
    """Return the wall with one more wedge, the best that it can stand with; None: none helps."""
    weaker = _weaker(build.actions[-1].resistance)
    before = _shares(build.actions[-1].resistance, weaker)
    worth: list[tuple[float, float, WedgePlace]] = []
    for place, model in _resisting(build, yard):
        after = _shares(build.analysis.resistance_with(model).resistance, weaker)
        if after[1] >= before[1] + LEAST and after[0] >= before[0] - SAME:
            worth.append((*after, place))
    # When the other direction becomes the weaker one, more is gained for the next wedge; of
    # those that are about as good, the smallest is cut.
    worth.sort(key=lambda one: (-round(one[0], 2), -round(one[1], 2), one[2].area_px))
    for _, _, place in worth[:REPLAYED]:
        group = build.wall.groups[place.step]
        wedge = Wedge(0, group.placement.stone_id, NOTHING, 0, 0, place.corners)
        wall = yard.from_step(build, place.step, (*group.wedges, wedge))
        if wall is not None:
            return wall
    return None


def _weaker(resistance: LateralResistance) -> str:
    """Return the direction in which the wall carries less."""
    left, right = resistance.left.alpha, resistance.right.alpha
    assert left is not None  # noqa: S101 - the wall stands
    assert right is not None  # noqa: S101
    return "left" if left <= right else "right"


def _shares(resistance: LateralResistance, direction: str) -> tuple[float, float]:
    """Return F_LR, and what one direction alone would make of it; 0 when it does not stand."""
    value = resistance.value
    if value is None:
        return 0.0, 0.0
    alpha = resistance.left.alpha if direction == "left" else resistance.right.alpha
    return value, (alpha or 0.0) / resistance.mu


def _resisting(build: Build, yard: _Yard) -> list[tuple[WedgePlace, RigidBlockModel]]:
    """List the wedges that the mechanism of the wall violates, the most violated first.

    Each with the model of the wall with it.
    """
    outlines = build.wall.outlines
    assert outlines is not None  # noqa: S101 - it was looked at before
    failing = lateral_resistance(build.model, mechanism=True)
    if not failing.stable:  # the solver gave up: it stood when it was built
        return []
    one = failing.left if _weaker(failing) == "left" else failing.right
    if one.mechanism is None:
        return []
    motion = Motion(build.model, one.mechanism)
    number = yard.workshop.next_wedge(build)
    found = []
    for place in wedge_places(build.wall, yard.limits):
        model = model_with_outlines(
            build.analysis.model,
            [(number, place.corners)],
            outlines,
            yard.settings.settle.contact_px,
        )
        assert model.added is not None  # noqa: S101 - it was made by adding
        rate = motion.resisted_by(number, model.added.interfaces)
        if rate > 0.0:
            found.append((rate, place, model))
    found.sort(key=lambda one: -round(one[0], 9))
    return [(place, model) for _, place, model in found[:ANALYSED]]


def _without_needless(build: Build, yard: _Yard) -> Build:
    """Drop wedges, one after the other, without which the wall carries as much and still stands."""
    shorter: Build | None = build
    while shorter is not None:
        build = shorter
        shorter = next(_with_one_less(build, yard), None)
    return build


def _with_one_less(build: Build, yard: _Yard) -> Iterator[Build]:
    """List the walls without one of the wedges that carry as much."""
    least = _value(build) - SAME
    for step, group in enumerate(build.wall.groups):
        for wedge in group.wedges:
            if (_resistance_without(build, wedge, yard.settings) or 0.0) >= least:
                others = tuple(other for other in group.wedges if other is not wedge)
                wall = yard.from_step(build, step, others)
                if wall is not None:
                    yield wall


def _resistance_without(build: Build, wedge: Wedge, settings: PlannerSettings) -> float | None:
    """Return F_LR of the finished wall without a wedge."""
    blocks = [
        block
        for group in build.wall.groups
        for block in outlined(group.placement, group.wedges)
        if block[0] != wedge.id
    ]
    placed = PlacedPolygons.of(blocks)
    model = model_of_outlines(placed, settings.mu, settings.settle.contact_px)
    return lateral_resistance(model).value
