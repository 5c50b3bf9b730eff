"""Steps that were taken before, taken again on what is built now."""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import NamedTuple

from drystone.kernels.gaps import crosses_any
from drystone.model.landscape import Landscape
from drystone.model.outlines import Outlines
from drystone.model.placement import Placement, Wedge
from drystone.model.wall import Group, Wall, outlined
from drystone.planner.build import Build, Candidate, Proposal
from drystone.planner.deadline import NEVER, Deadline
from drystone.planner.dropping import wedge_limits
from drystone.planner.evaluate import Evaluator
from drystone.planner.settings import PlannerSettings
from drystone.planner.solves import Solves
from drystone.planner.workshop import Workshop
from drystone.settle.placing import settled_placement, settled_wedge
from drystone.settle.wedge import WedgeLimits, squeezed_out
from drystone.stabilise.stabilise import Stabilised


class Replayed(NamedTuple):
    """Steps taken again."""

    build: Build  # after the steps that could be taken
    # ids of the stones of the others: they overlap what is there, fill no pixel of the wall,
    # have a wedge that nothing would be beside, or leave a wall that does not stand in both
    # models
    left_out: tuple[int, ...]
    solves: Solves  # what trouble the solver had; a step on which it gave up is left out


def replayed(
    start: Build,
    groups: Sequence[Group],
    course_heights_px: Mapping[int, float],
    workshop: Workshop,
    settings: PlannerSettings,
    *,
    keep: bool = True,
    strict: bool = True,
    until: Deadline = NEVER,
) -> Replayed:
    """Place stones with their wedges where they were, judging every step anew.

    Poses and outlines stay as they are.  The pixels that a settled stone fills depend on what is
    there and are found again, and wedges are numbered anew.

    Parameters
    ----------
    start : Build
        What is built.
    groups : sequence of Group
        Stones, with their wedges, that are not in it: in the order in which they are placed.
    course_heights_px : mapping of int to float
        For stones that may begin a course: the height that Eq. 8 compares with.
    workshop : Workshop
        Stones and site.
    settings : PlannerSettings
        All parameters.
    keep : bool
        Whether the new states know those before them, to go back to them.
    strict : bool
        The first step that cannot be taken ends the replay; otherwise it is left out and the next
        one tried.
    until : Deadline
        Looked at before every step.

    Returns
    -------
    replayed : Replayed
        What is built then.

    Raises
    ------
    TimeIsUp
        The time limit struck.
    """
    evaluator = Evaluator(settings, workshop.stock, until=until)
    limits = wedge_limits(settings, workshop.stock, workshop.site)
    build = start
    left_out: list[int] = []
    solves = Solves()
    for group in groups:
        action = None
        if not (strict and left_out) and not _squeezed_out(build.wall, group, limits):
            action = _again(build, group, course_heights_px, workshop, evaluator)
        if action is not None:
            solves += Solves.of(action)
        if action is None or not stands(action):
            left_out.append(group.placement.stone_id)
        else:
            build = build.add(action, keep=keep)
    return Replayed(build, tuple(left_out), solves)


def judged(
    build: Build, group: Group, course_heights_px: Mapping[int, float], evaluator: Evaluator
) -> Candidate:
    """Return the action that places a stone with its wedges as they are.

    Parameters
    ----------
    build : Build
        What is built.
    group : Group
        Has room there.
    course_heights_px : mapping of int to float
        As for :func:`replayed`.
    evaluator : Evaluator
        Judges it.
    """
    placement = group.placement
    proposal = Proposal(
        Stabilised(placement, group.wedges),
        placement.posed.angle_deg,
        course_height_px=course_heights_px.get(placement.stone_id),
    )
    return evaluator.judge(build, Landscape.of(build.wall, placement.side), proposal)


def stands(action: Candidate) -> bool:
    """Say whether the wall stands after an action, in both models, and carries some load."""
    return action.sturdy and (action.resistance.value or 0.0) > 0.0


def _again(
    build: Build,
    group: Group,
    course_heights_px: Mapping[int, float],
    workshop: Workshop,
    evaluator: Evaluator,
) -> Candidate | None:
    """Return the action that takes a step again; None when there is no room for it."""
    if not _has_room(build.wall, group):
        return None
    fitted = _fitted(build.wall, group, workshop.next_wedge(build))
    if fitted is None:
        return None
    return judged(build, fitted, course_heights_px, evaluator)


def _has_room(wall: Wall, group: Group) -> bool:
    if wall.outlines is not None:
        blocks = outlined(group.placement, group.wedges)
        return not any(crosses_any(corners, wall.outlines.polygons) for _, corners in blocks)
    pieces = [(group.placement.window, group.placement.posed.mask)]
    pieces += [(wedge.window, wedge.mask) for wedge in group.wedges]
    return not any(wall.occupied[window][mask].any() for window, mask in pieces)


def _squeezed_out(wall: Wall, group: Group, limits: WedgeLimits) -> bool:
    """Say whether nothing would be beside a wedge of a step on outlines."""
    if wall.outlines is None or not group.wedges:
        return False
    (_, stone), *wedges = outlined(group.placement, group.wedges)
    around = wall.outlines.polygons.added(corners for _, corners in wedges)
    width = wall.site.extent_px[0]
    return any(squeezed_out(corners, stone, around, width, limits) for _, corners in wedges)


def _fitted(wall: Wall, group: Group, number: int) -> Group | None:
    """Return a step with the pixels that it fills now, and its wedges numbered from a number on.

    None when the stone fills no pixel.
    """
    if wall.outlines is None:
        wedges = (replace(wedge, id=number + k) for k, wedge in enumerate(group.wedges))
        return Group(group.placement, tuple(wedges))
    placement = _placed_again(wall.outlines, wall, group.placement)
    if placement is None:
        return None
    if not group.wedges:
        return Group(placement, ())
    outlines = wall.outlines.added(outlined(placement, ()), wall.site.scale)
    fitted: list[Wedge] = []
    for wedge in group.wedges:
        assert wedge.corners is not None  # noqa: S101 - wedges of outlines are outlines
        new = settled_wedge(outlines, wall.site, number + len(fitted), wedge.under, wedge.corners)
        outlines = outlines.added([(new.id, wedge.corners)], wall.site.scale)
        fitted.append(new)
    return Group(placement, tuple(fitted))


def _placed_again(outlines: Outlines, wall: Wall, placement: Placement) -> Placement | None:
    """Return a settled stone with the pixels that it fills beside some outlines."""
    assert placement.settled is not None  # noqa: S101 - all stones of the wall are outlines
    return settled_placement(
        outlines,
        wall.site,
        placement.posed.stone,
        placement.posed.angle_deg,
        placement.settled,
        placement.side,
        placement.rotation_moves,
    )
