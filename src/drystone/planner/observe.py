"""Going on from the wall as it was really built (Johns et al. 2020 plan on the fly so)."""

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, replace
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

from drystone.errors import Notice, UsageError
from drystone.kernels.raster import wrap_deg
from drystone.model.placement import Placement
from drystone.model.site import Site
from drystone.planner.as_measured import far_from, rebuilt
from drystone.planner.build import Build
from drystone.planner.measured import (
    MeasuredPlace,
    MeasuredPose,
    places_in,
    places_of,
    require_known,
)
from drystone.planner.settings import PlannerSettings
from drystone.planner.workshop import Workshop

Measurement: TypeAlias = Mapping[int, MeasuredPose] | NDArray[np.integer]
"""Poses by the ids of stones, or a picture of ids (:func:`drystone.planner.measured.places_in`)."""

SAME_PX, SAME_DEG = 0.01, 0.01
"""A measured pose that is no further from the planned one is the planned one."""


@dataclass(frozen=True)
class Deviation:
    """How far a stone is from where it was planned."""

    stone_id: int  # the stone
    # measured less planned, in units of the plan: metres when the site has a scale, otherwise
    # source px
    dx: float
    dy: float
    shift_px: float  # the length of that, source px
    angle_deg: float  # measured less planned, counter-clockwise, in [-180, 180)
    # from where it was measured to where the planner has it now, source px and degrees: what it
    # took to bring outlines apart and to make the stone rest
    moved_px: float
    turned_deg: float


@dataclass(frozen=True)
class Observation:
    """What was found when a wall was measured.

    Parameters
    ----------
    poses : dict of int to MeasuredPose
        Of every stone in the wall, as measured: those of a picture are estimates.
    deviations : tuple of Deviation
        Of the stones that were planned, in the order of placement; empty when there are none.
    free : tuple of int
        Stones that were in the wall and are no longer: they may be placed again.
    lost : tuple of int
        Stones that will not be used.
    added : tuple of int
        Stones in the wall that were not planned there.
    stands : bool
        Whether the wall stands after every stone, as the planner judges it.
    notices : tuple of Notice
        W124: the stones after which it does not.  W127: the stones that the planner has elsewhere
        than they were measured.
    """

    poses: Mapping[int, MeasuredPose]
    deviations: tuple[Deviation, ...]
    free: tuple[int, ...]
    lost: tuple[int, ...]
    added: tuple[int, ...]
    stands: bool
    notices: tuple[Notice, ...] = ()

    @property
    def largest_px(self) -> float:
        """Largest deviation, source px; 0 without stones."""
        return max((one.shift_px for one in self.deviations), default=0.0)

    @property
    def largest_deg(self) -> float:
        """Largest turn, degrees, positive; 0 without stones."""
        return max((abs(one.angle_deg) for one in self.deviations), default=0.0)

    @property
    def largest_moved_px(self) -> float:
        """Farthest that a stone was moved from where it was measured, source px."""
        return max((one.moved_px for one in self.deviations), default=0.0)


def observed(
    start: Build,
    build: Build,
    measured: Measurement,
    lost: Iterable[int],
    workshop: Workshop,
    settings: PlannerSettings,
) -> tuple[Build, Observation]:
    """Return the state of construction of a wall as it was measured, and what was found.

    `start` is the empty wall, `build` what was planned so far: the very one is returned when
    nothing was measured elsewhere.  Errors: see :meth:`drystone.planner.planner.Planner.observe`.
    """
    places = _places(build, measured, workshop)
    missing = _lost(lost, places, workshop)
    groups = {group.placement.stone_id: group for group in build.wall.groups}
    order = [i for i in groups if i in places]
    added = sorted(set(places) - set(groups), key=lambda i: (places[i].y_px, i))
    now = build
    if added or len(order) < len(groups) or not all(places[i].as_planned for i in order):
        now = rebuilt(start, build, order, added, places, workshop, settings)
    unsteady = tuple(action.stone_id for action in now.actions if not action.stands)
    px = workshop.site.px_per_m or 1.0
    observation = Observation(
        poses={
            i: MeasuredPose(places[i].x_px / px, places[i].y_px / px, places[i].angle_deg)
            for i in (*order, *added)
        },
        deviations=_deviations(build, now, places),
        free=tuple(i for i in groups if i not in places and i not in missing),
        lost=missing,
        added=tuple(added),
        stands=not unsteady,
        notices=tuple(_notices(unsteady, far_from(now, places))),
    )
    return now, observation


def without(
    lost: Iterable[int], workshop: Workshop, settings: PlannerSettings
) -> tuple[Workshop, PlannerSettings]:
    """Return workshop and settings in which some stones are banned."""
    gone = set(lost)
    fitting = tuple(i for i in workshop.fitting if i not in gone)
    ban = tuple(sorted(gone.union(settings.ban)))
    pin = tuple(i for i in settings.pin if i not in gone)
    return replace(workshop, fitting=fitting), replace(settings, ban=ban, pin=pin)


def _places(build: Build, measured: Measurement, workshop: Workshop) -> dict[int, MeasuredPlace]:
    """Return where the stones are; those that are where they were planned are marked."""
    if not isinstance(measured, Mapping):
        return places_in(measured, build.wall, workshop.stones, workshop.wedge_ids)
    require_known(measured, workshop.stones)
    places = places_of(measured, workshop.site)
    for placement in build.wall.placements:
        place = places.get(placement.stone_id)
        if place is not None:
            dx, dy, angle = _less(place, placement, workshop.site)
            same = np.hypot(dx, dy) <= SAME_PX and abs(angle) <= SAME_DEG
            places[placement.stone_id] = replace(place, as_planned=bool(same))
    return places


def _lost(
    lost: Iterable[int], places: Mapping[int, MeasuredPlace], workshop: Workshop
) -> tuple[int, ...]:
    """Return the stones that are lost; E195 for those that there are not, E199 in the wall."""
    gone = set(lost)
    require_known(gone, workshop.stones)
    missing = tuple(sorted(map(int, gone)))
    both = [i for i in missing if i in places]
    if both:
        what = f"stones {', '.join(map(str, both))} are lost, and measured in the wall."
        cure = "Leave them out of one of the two."
        raise UsageError("E199", what, where="observe", cure=cure)
    return missing


def _deviations(
    planned: Build, now: Build, places: Mapping[int, MeasuredPlace]
) -> tuple[Deviation, ...]:
    site = planned.wall.site
    here = {placement.stone_id: placement for placement in now.wall.placements}
    found = []
    for placement in planned.wall.placements:
        stone_id = placement.stone_id
        if stone_id not in places:
            continue
        dx, dy, angle = _less(places[stone_id], placement, site)
        mx, my, turned = _less(places[stone_id], here[stone_id], site)
        px, shift, moved = site.px_per_m or 1.0, float(np.hypot(dx, dy)), float(np.hypot(mx, my))
        found.append(Deviation(stone_id, dx / px, dy / px, shift, angle, moved, 0.0 - turned))
    return tuple(found)


def _less(place: MeasuredPlace, placement: Placement, site: Site) -> tuple[float, float, float]:
    """Return a place less that of a placement: x, y in source px, and the angle."""
    x, y = placement.centroid(site.height_px)
    angle = wrap_deg(place.angle_deg - placement.posed.angle_deg)
    return place.x_px - x / site.scale, place.y_px - y / site.scale, angle


def _notices(unsteady: tuple[int, ...], far: tuple[int, ...]) -> Iterator[Notice]:
    if unsteady:
        yield Notice(
            "W124",
            f"as measured, the wall does not stand after stones {', '.join(map(str, unsteady))}.",
            "Measure again, or take down the first of them and what lies on it: nothing is "
            "planned on a wall that does not stand.",
        )
    if far:
        yield Notice(
            "W127",
            f"stones {', '.join(map(str, far))} are taken to be more than a tenth of their size "
            "from where they were measured: there they overlap others, hang in the air or would "
            "fall.",
            "Measure again, or see whether they would fall: planning goes on from where they are "
            "taken to be.",
        )
