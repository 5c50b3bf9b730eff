"""Small wedges in the gaps of a finished wall, where they raise its lateral resistance most.

They are tried in a draft of the wall (:mod:`drystone.search.wedge_draft`), which stands as a whole;
then all steps above the lowest one are taken again with all of them.  Where that fails they are
added one after the other, and the one that cannot be is barred from the next draft.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field

import numpy as np

from drystone.contacts.settled import PlacedPolygons
from drystone.kernels.polygons import Points
from drystone.model.placement import Wedge
from drystone.model.wall import Group
from drystone.planner.build import Build, Solves
from drystone.planner.deadline import Deadline
from drystone.search.wedge_draft import MOST_UNDER_ONE, Motion, WedgeDraft, WedgePlace, wedge_places
from drystone.search.yard import Yard
from drystone.settle.placing import NOTHING
from drystone.statics.model import RigidBlockModel

LEAST = 0.003
"""A wedge is added when the weaker direction gains so much, in F_LR."""

SAME = 1e-7
"""F_LR is the same within this: two optima of programs that differ by an idle block."""

ANALYSED = 24
"""Most wedges of a round that are analysed: those that the mechanism violates most."""

Barred = frozenset[tuple[int, bytes]]
"""Steps and outlines of wedges with which the wall does not stand after every step."""


@dataclass(frozen=True, eq=False)
class _Change:
    """A wedge more or less."""

    step: int  # which step places the stone on it
    corners: Points  # (n, 2), its outline; that of the very wedge of the wall if it is dropped
    dropped: bool = False  # whether it is dropped, not added

    def of(self, group: Group) -> Group:
        """Return the step with the change."""
        if self.dropped:
            wedges = tuple(wedge for wedge in group.wedges if wedge.corners is not self.corners)
        else:
            new = Wedge(0, group.placement.stone_id, NOTHING, 0, 0, self.corners)
            wedges = (*group.wedges, new)
        return Group(group.placement, wedges)


@dataclass(frozen=True, eq=False)
class _Steps:
    """Takes steps of a wall again, and remembers what trouble there was."""

    yard: Yard
    course_heights_px: dict[int, float]
    trouble: list[Solves] = field(default_factory=list)

    def again(self, start: Build, groups: Sequence[Group]) -> Build | None:
        """Take steps again on what is built; None when one of them cannot be taken."""
        build, left_out, solves = self.yard.replayed(start, groups, self.course_heights_px)
        self.trouble.append(solves)
        return None if left_out else build

    def changed(self, build: Build, changes: Sequence[_Change]) -> Build | None:
        """Return a wall with all changes; None when it would not stand."""
        if not changes:
            return build
        groups = list(build.wall.groups)
        for change in changes:
            groups[change.step] = change.of(groups[change.step])
        first = min(change.step for change in changes)
        return self.again(build.states()[first], groups[first:])

    def one_by_one(self, build: Build, changes: Sequence[_Change]) -> Iterator[Build | None]:
        """Make changes one after the other; None for each that is not made."""
        for change in changes:
            wall = self.changed(build, [change])
            yield wall
            build = build if wall is None else wall


def wedged_up(build: Build, yard: Yard, most: int) -> tuple[Build, Solves]:
    """Add wedges to a finished wall of outlines that raise F_LR, and drop those that do not matter.

    No stone moves.  A wedge is placed with the stone that lies on it, and the wall stands after
    every step, in both models.  The wall has all its states then; it is the same one when nothing
    changes, or when its own steps cannot be taken again.  At most so many wedges are added.
    """
    steps = _Steps(yard, build.course_heights_px())
    begun: Build | None = build
    if len(build.states()) <= len(build.actions):  # it does not know its states
        begun = steps.again(yard.planner().build, build.wall.groups)
    wall = begun if begun is None or not begun.actions else _wedged(begun, steps, most)
    return build if wall is None or wall is begun else wall, sum(steps.trouble, Solves())


def one_more_wedge(build: Build, stone_id: int, yard: Yard) -> Iterator[tuple[Build, Solves]]:
    """List walls of outlines with one more wedge under a stone, which stand after every step.

    The wall knows its states.
    """
    may = yard.settings.stabilise.method in ("both", "wedge") and yard.settings.search.wedges
    groups = build.wall.groups
    step = next(k for k, group in enumerate(groups) if group.placement.stone_id == stone_id)
    if not may or len(groups[step].wedges) >= MOST_UNDER_ONE:
        return
    first = sum(1 + len(group.wedges) for group in groups[:step])
    placed = PlacedPolygons(build.wall.exact.ids, build.wall.exact.polygons)
    width = build.wall.site.extent_px[0]
    for place in wedge_places(placed, step, first, width, yard.workshop.limits):
        steps = _Steps(yard, build.course_heights_px())
        wall = steps.changed(build, [_Change(step, place.corners)])
        if wall is not None:
            yield wall, sum(steps.trouble, Solves())


def _wedged(wall: Build, steps: _Steps, most: int) -> Build:
    """Return a wall that knows its states with other wedges; the same when nothing changes."""
    barred = Barred()
    for _ in range(4):  # each draft but the last had a wedge that cannot be added
        added, dropped = _drafted(wall, steps, most, barred)
        better = _with_all(wall, added, dropped, steps)
        if better is not None:
            return better
        for change, one in zip(added, steps.one_by_one(wall, added), strict=True):
            if one is None:
                barred |= {(change.step, change.corners.tobytes())}
                break
            wall, most = one, most - 1
    return wall


def _with_all(
    build: Build, added: Sequence[_Change], dropped: Sequence[_Change], steps: _Steps
) -> Build | None:
    """Return a wall with wedges added and dropped; None when it does not stand with them.

    What cannot be dropped stays.
    """
    wall = steps.changed(build, [*added, *dropped])
    if wall is not None or not dropped:
        return wall
    wall = steps.changed(build, added)
    if wall is None:
        return None
    return [wall, *filter(None, steps.one_by_one(wall, dropped))][-1]


def _drafted(
    build: Build, steps: _Steps, most: int, barred: Barred
) -> tuple[list[_Change], list[_Change]]:
    """Return which wedges a wall should get, the most useful first, and which it does not need."""
    draft = WedgeDraft.of(build, steps.yard.workshop.limits)
    number = steps.yard.workshop.next_wedge(build)
    while len(draft.added) < most:
        better = _with_one_more(draft, number + len(draft.added), barred, steps.yard.until)
        if better is None:
            break
        draft = better
    return _needed(build, draft, steps)


def _with_one_more(
    draft: WedgeDraft, number: int, barred: Barred, until: Deadline
) -> WedgeDraft | None:
    """Return a draft with one more wedge, the best one; None when none helps."""
    value = draft.resistance.value
    if value is None:  # the solver gave up: it stood when it was built
        return None
    weaker = draft.weaker
    motion = draft.motion(weaker)
    if motion is None:
        return None
    draft = draft.looked_at(motion)
    worth: list[tuple[float, float, WedgePlace, RigidBlockModel]] = []
    for place in _resisting(draft, motion, barred):
        until.look()
        model = draft.model_with(number, place)
        gained = draft.value_with(model, weaker)
        if gained is None or gained < value + LEAST:
            continue
        other = draft.value_with(model, "right" if weaker == "left" else "left")
        if other is not None and (after := min(gained, other)) >= value - SAME:
            worth.append((after, gained, place, model))
    if not worth:
        return None
    # When the other direction becomes the weaker one, more is gained for the next wedge; of
    # those that are about as good, the smallest is cut.
    *_, best, model = min(
        worth, key=lambda one: (-round(one[0], 2), -round(one[1], 2), one[2].area_px)
    )
    return draft.wedged(number, best, model)


def _resisting(draft: WedgeDraft, motion: Motion, barred: Barred) -> list[WedgePlace]:
    """List the places that a mechanism violates most, then such as only their weight could help."""
    places = [
        place
        for place in draft.places()
        if (place.step, place.corners.tobytes()) not in barred
        and not motion.stands_still(place.carriers.tolist())
    ]
    order = np.argsort(-motion.resisted_by(places).round(9), kind="stable")
    return [places[k] for k in order[:ANALYSED].tolist()]


def _needed(build: Build, draft: WedgeDraft, steps: _Steps) -> tuple[list[_Change], list[_Change]]:
    """Return the wedges of a draft that matter, and those of the wall that do not.

    Those that are needed when others are there are needed without them: each is asked for once.
    """
    added = {number: _Change(place.step, place.corners) for number, place in draft.added}
    there = {
        wedge.id: _Change(step, wedge.corners, dropped=True)
        for step, group in enumerate(build.wall.groups)
        for wedge in group.wedges
        if wedge.corners is not None
    }
    dropped: list[_Change] = []
    for number in sorted([*there, *added], key=draft.placed.ids.index):
        steps.yard.until.look()
        model = draft.idle(number)
        value, carried = draft.resistance.value, draft.analysis.resistance_with(model).resistance
        if value is None or carried.value is None or carried.value < value - SAME:
            continue
        if number in added:
            del added[number]
        elif _stands_at(build, [*added.values(), *dropped, there[number]], steps):
            dropped.append(there[number])
        else:
            continue
        draft = draft.without(model)
    return list(added.values()), dropped


def _stands_at(build: Build, changes: Sequence[_Change], steps: _Steps) -> bool:
    """Say whether the step of the last of some changes can be taken with them."""
    step = changes[-1].step
    group = build.wall.groups[step]
    for change in changes:
        if change.step == step:
            group = change.of(group)
    return steps.again(build.states()[step], [group]) is not None
