"""Steps that were taken before, taken again on what is built now."""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from drystone.errors import UsageError
from drystone.kernels.gaps import crosses_any
from drystone.model.landscape import Landscape
from drystone.model.site import Site
from drystone.model.stone import Stone, StoneSet
from drystone.model.wall import Group, Wall, outlined
from drystone.planner.build import Build, Candidate, Proposal, Solves
from drystone.planner.deadline import NEVER, Deadline
from drystone.planner.evaluate import Evaluator
from drystone.planner.settings import PlannerSettings
from drystone.planner.workshop import Workshop
from drystone.settle.placing import settled_again
from drystone.settle.wedge import WedgeLimits, squeezed_out


class Replayed(NamedTuple):
    """Steps taken again."""

    build: Build  # after the steps that could be taken
    # ids of the stones of the others: they overlap what is there, fill no pixel of the wall, have a
    # wedge that nothing would be beside, or leave a wall that does not stand in both models
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
    renumber: bool = True,
    until: Deadline = NEVER,
) -> Replayed:
    """Place stones with their wedges where they were, in this order, judging every step anew.

    Poses and outlines stay as they are.  The pixels that a settled stone fills depend on what is
    there and are found again.  `course_heights_px` is what Eq. 8 compares stones with that may
    begin a course; `keep`: the new states know those before them; `strict`: the first step that
    cannot be taken ends the replay, otherwise it is left out; `renumber`: wedges get new ids.
    `until` is looked at before every step (TimeIsUp).
    """
    evaluator = Evaluator(settings, workshop.stock, until=until)
    build = start
    left_out: list[int] = []
    solves = Solves()
    for group in groups:
        stood, fitted = build, None
        if not (strict and left_out) and _has_room(build.wall, group, workshop.limits):
            fitted = group
            if renumber:
                named = enumerate(group.wedges, workshop.next_wedge(build))
                fitted = Group(group.placement, tuple(replace(w, id=k) for k, w in named))
            if build.wall.outlines is not None:
                fitted = settled_again(build.wall, fitted)
        if fitted is not None:
            action = judged(build, fitted, course_heights_px, evaluator)
            solves += action.solves
            if action.stands:
                build = build.add(action, keep=keep)
        if build is stood:
            left_out.append(group.placement.stone_id)
    return Replayed(build, tuple(left_out), solves)


def identity(stone: Stone) -> str:
    """Return what no other stone has: id, place in the picture, pixels and outline."""
    drawn = None if stone.drawn is None else stone.drawn.tobytes()
    pixels = stone.mask.shape, np.packbits(stone.mask).tobytes()
    return repr((stone.id, stone.left_px, stone.bottom_px, pixels, drawn))


def differences(
    wall: Wall, stones: StoneSet, site: Site, settings: PlannerSettings
) -> dict[str, str]:
    """Name what a wall is of that is not what is planned, and the options that make it the same."""
    known = set(map(identity, stones))
    same = all(identity(placement.posed.stone) in known for placement in wall.placements)
    own, asked = wall.site.extent_px, site.extent_px
    sized = "another wall ({:g}x{:g} px, not {:g}x{:g})".format(*own, *asked)
    geometry = "raster" if wall.outlines is None else "exact"
    of_it = f"--geometry {geometry}" + " --budget 1" * (geometry == "raster")
    one_sided = all(placement.side == "left" for placement in wall.placements)
    checks = [  # whether it is the same, what it is else, and the option that makes it the same
        (same, "other stones", ""),
        (np.allclose(own, asked, rtol=0, atol=1e-6), sized, ""),
        (wall.site.scale == site.scale, "another resolution", f"--scale {wall.site.scale:g}"),
        (geometry == settings.geometry, "another geometry", of_it),
        (settings.two_sided or one_sided, "both sides", "--two-sided"),
    ]
    return {name: option for alike, name, option in checks if not alike}


def refuse(different: Mapping[str, str], where: str) -> None:
    """Refuse (E144) a wall for what it is of, as :func:`differences` names it."""
    if different:
        cure = "Give the stones and the wall that it was made for, or leave it out."
        if all(different.values()):
            cure = f"Add {' '.join(different.values())}."
        raise UsageError("E144", f"it is of {', '.join(different)}.", where=where, cure=cure)


def judged(
    build: Build, group: Group, course_heights_px: Mapping[int, float], evaluator: Evaluator
) -> Candidate:
    """Return the action that places a stone, which has room, with its wedges as they are."""
    placement = group.placement
    height = course_heights_px.get(placement.stone_id)
    proposal = Proposal(group, placement.posed.angle_deg, course_height_px=height)
    return evaluator.judge(build, Landscape.of(build.wall, placement.side), proposal)


def _has_room(wall: Wall, group: Group, limits: WedgeLimits) -> bool:
    """Say whether a step overlaps nothing; on outlines something must be beside its wedges."""
    if wall.outlines is None:
        pieces = [(group.placement.window, group.placement.posed.mask)]
        pieces += [(wedge.window, wedge.mask) for wedge in group.wedges]
        return not any(wall.occupied[window][mask].any() for window, mask in pieces)
    polygons, width = wall.outlines.polygons, wall.site.extent_px[0]
    (_, stone), *wedges = outlined(group.placement, group.wedges)
    around = polygons.added(corners for _, corners in wedges)
    if any(squeezed_out(corners, stone, around, width, limits) for _, corners in wedges):
        return False
    return not any(crosses_any(corners, polygons) for corners in (stone, *(c for _, c in wedges)))
