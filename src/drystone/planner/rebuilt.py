"""The wall built again, stone by stone, each where it was measured."""

import math
from collections.abc import Iterable, Mapping, Sequence
from functools import partial

from drystone.errors import InputError
from drystone.planner.as_measured import Measured, put_as_measured
from drystone.planner.build import Build
from drystone.planner.measured import Place
from drystone.planner.replay import replayed, stands
from drystone.planner.settings import PlannerSettings
from drystone.planner.workshop import Workshop

FAR = 0.1
"""A stone that is moved so far, over its size, from where it was measured is named (W127)."""


def rebuilt(
    start: Build,
    before: Build,
    order: Sequence[int],
    added: Sequence[int],
    places: Mapping[int, Place],
    workshop: Workshop,
    settings: PlannerSettings,
) -> Build:
    """Build the wall again as it was measured.

    Stones that were not planned come after all others; from below where stones then do not stand,
    or are far from where they were measured: one may lie under a stone that was planned.

    Parameters
    ----------
    start : Build
        Nothing is built.
    before : Build
        What was planned.
    order : sequence of int
        The planned stones that are in the wall, in their order of placement.
    added : sequence of int
        The others that are.
    places : mapping of int to Place
        Where all of them are.
    workshop : Workshop
        Stones and site.
    settings : PlannerSettings
        All parameters.

    Returns
    -------
    build : Build
        With all of them.

    Raises
    ------
    InputError
        E198: a stone overlaps others wherever it is moved to.
    """
    build = partial(_built, start, before, places, workshop, settings)
    orders = [[*order, *added]]
    if added:
        orders.append(sorted(orders[0], key=lambda i: (places[i].y_px, i)))
    walls: list[Build] = []
    errors: list[InputError] = []
    for stone_ids in orders:
        try:
            walls.append(build(stone_ids))
        except InputError as error:
            errors.append(error)
            continue
        if not any(_amiss(walls[-1], places)):
            break
    if not walls:
        raise errors[0]
    return min(walls, key=lambda wall: _amiss(wall, places))


def far_from(wall: Build, places: Mapping[int, Place]) -> tuple[int, ...]:
    """Return the stones that are far from where they were measured, in the order of placement."""
    site, far = wall.wall.site, []
    for group in wall.wall.groups:
        placement, stone = group.placement, group.placement.posed.stone
        x, y = placement.centroid(site.height_px)
        one = Measured(stone, places[stone.id], placement.side, None)
        moved = one.moved_px(x / site.scale, y / site.scale, placement.posed.angle_deg)
        if moved > FAR * math.sqrt(stone.area_px):
            far.append(stone.id)
    return tuple(far)


def _amiss(wall: Build, places: Mapping[int, Place]) -> tuple[int, int]:
    """Return after how many stones a wall does not stand, and how many are far off."""
    return sum(not stands(action) for action in wall.actions), len(far_from(wall, places))


def _built(
    start: Build,
    before: Build,
    places: Mapping[int, Place],
    workshop: Workshop,
    settings: PlannerSettings,
    order: Iterable[int],
) -> Build:
    """Put stone after stone where it was measured."""
    keep = settings.search.budget > 1
    groups = {group.placement.stone_id: group for group in before.wall.groups}
    heights = before.course_heights_px()
    build = start
    for stone_id in order:
        planned, place = groups.get(stone_id), places[stone_id]
        if planned is not None and place.as_planned:
            again = replayed(build, [planned], heights, workshop, settings, keep=keep)
            if not again.left_out:
                build = again.build
                continue
        side = "left" if planned is None else planned.placement.side
        one = Measured(workshop.stones.by_id(stone_id), place, side, planned)
        action = put_as_measured(build, one, workshop, settings, heights)
        if action is None:
            raise _no_room(one)
        build = build.add(action, keep=keep)
    return build


def _no_room(one: Measured) -> InputError:
    place = one.place
    return InputError(
        "E198",
        f"stone {one.stone.id}, measured at ({place.x_px:.1f}, {place.y_px:.1f}) source px, "
        f"{place.angle_deg:.1f} degrees, overlaps others, and there is no room near it.",
        where="observe",
        cure="Measure again; poses that are this far off are of another stone or frame.",
    )
