"""The plan: what a mason or a robot needs to build the wall, in order.

These are the in-memory types; :mod:`drystone.io.plan_json` gives them their file form.
Lengths are in source px, or in metres when the plan's `length_unit` is "m".
"""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Literal

from drystone.model.placement import Side

Point = tuple[float, float]

SCHEMA = "drystone-plan/1"


@dataclass(frozen=True)
class StoneStep:
    """Place one stone.

    Parameters
    ----------
    step : int
        Number of the step, from 1, wedges counted.
    stone : int
        Id in the input image.
    angle_deg : float
        Counter-clockwise as seen in the picture, from the input image to the wall.
    source_centroid, centroid : (float, float)
        The same point in the source image (px, y up from its bottom-left corner) and in the wall
        frame (plan's units, x right from the left end, y up from the ground).
    side : {"left", "right"}
        End of the wall from which the stone was placed.
    cluster : int
        Cluster of the stone (§3.4), from 1.
    rotation_moves : int
        Pivots that stabilisation turned the stone about.
    indices : mapping of str to float (None only for LLC, of a wall that would not stand)
        SF, LFR, GDS, NHR, IWR, IS, LLC of the action (§3.5).
    course_height : float or None
        For the first stone of a course: the mean height of the other candidates that NHR
        compares with (Eq. 8), plan's units; otherwise None.
    alpha_left, alpha_right : float or None
        Load multipliers of the wall after this step; None when its wedges are still to come.
    """

    step: int
    stone: int
    angle_deg: float
    source_centroid: Point
    centroid: Point
    side: Side
    cluster: int
    rotation_moves: int
    indices: Mapping[str, float | None]
    course_height: float | None
    alpha_left: float | None
    alpha_right: float | None
    kind: Literal["stone"] = "stone"


@dataclass(frozen=True)
class WedgeStep:
    """Push in one wedge under the stone just placed.

    Parameters
    ----------
    step : int
        Number of the step.
    id : int
        Its value in wall.png.
    under : int
        Id of the stone it supports.
    polygon : tuple of (float, float)
        Corners in the wall frame, plan's units, counter-clockwise.
    alpha_left, alpha_right : float or None
        As for a stone; None when another wedge of the same stone follows.
    """

    step: int
    id: int
    under: int
    polygon: tuple[Point, ...]
    alpha_left: float | None
    alpha_right: float | None
    kind: Literal["wedge"] = "wedge"


FIGURES = ("F_SF", "F_AV", "F_AH", "F_LR", "T_LEVEL", "E_FLUSH")
"""What is told of a wall, in this order."""


@dataclass(frozen=True)
class PlanMetrics:
    """The figures of merit of a finished wall (§5.2); None when one cannot be computed.

    F_LR of a wall of outlines is that at the contact tolerance and the set-back of its settings.
    F_LR_half and F_LR_double are those at half and at twice this tolerance, F_LR_no_setback is
    that with contacts up to the ends of faces (DESIGN 4.8, 4.9); None for pixels.  F_LR_coulomb is
    the least that was found without dilatancy, 0 where the wall can fall when it is let go;
    alpha_left_coulomb and alpha_right_coulomb are the load multipliers.  None where nothing was
    found or looked for.
    """

    F_SF: float
    F_AV: float | None
    F_AH: float | None
    F_LR: float | None
    T_LEVEL: float | None
    E_FLUSH: float | None
    alpha_left: float | None
    alpha_right: float | None
    wedge_area: float
    F_LR_half: float | None = None
    F_LR_double: float | None = None
    F_LR_no_setback: float | None = None
    F_LR_coulomb: float | None = None
    alpha_left_coulomb: float | None = None
    alpha_right_coulomb: float | None = None

    def __str__(self) -> str:
        shown = {name: getattr(self, name) for name in FIGURES}
        return ", ".join(
            f"{name} {'-' if value is None else format(value, '.3g')}"
            for name, value in shown.items()
        )


@dataclass(frozen=True)
class Plan:
    """A complete plan; see the module for units.

    Parameters
    ----------
    version, method : str
        Of the package, and of the planning method.
    seed : int
        Seed of the random choices.
    settings : mapping
        Every parameter that shapes the plan.
    length_unit : {"px", "m"}
        Unit of all lengths of the plan.
    px_per_m : float or None
        Source px in a metre.
    working_scale : float
        Working resolution over source resolution.
    source : mapping
        path, sha256, stones, width_px, height_px and, for folders, files.
    width, height : float
        Size of the wall, plan's units.
    steps : tuple of StoneStep or WedgeStep
        In order of construction.
    unused : tuple of int
        Ids of the stones left over.
    stopped : str
        Why construction ended.
    metrics : PlanMetrics
        Of the finished wall.
    """

    version: str
    method: str
    seed: int
    settings: Mapping[str, Any]
    length_unit: Literal["px", "m"]
    px_per_m: float | None
    working_scale: float
    source: Mapping[str, Any]
    width: float
    height: float
    steps: tuple[StoneStep | WedgeStep, ...]
    unused: tuple[int, ...]
    stopped: str
    metrics: PlanMetrics

    def __repr__(self) -> str:
        unit, stones = self.length_unit, len(self.stone_steps)
        return (
            f"<Plan of a wall of {self.width:g} x {self.height:g} {unit}, {self.method}, "
            f"seed {self.seed}: {stones} stones, {len(self.steps) - stones} wedges, {self.metrics}>"
        )

    @property
    def walls(self) -> int | None:
        """How many walls were built, of which this is the best; None where it is not known."""
        budget = self.settings.get("search", {}).get("budget")
        return budget if isinstance(budget, int) else None

    @property
    def stone_steps(self) -> tuple[StoneStep, ...]:
        """The steps that place a stone."""
        return tuple(step for step in self.steps if isinstance(step, StoneStep))

    @property
    def wedge_steps(self) -> tuple[WedgeStep, ...]:
        """The steps that push in a wedge."""
        return tuple(step for step in self.steps if isinstance(step, WedgeStep))

    @property
    def step_by_id(self) -> dict[int, int]:
        """The step that places each stone, and each wedge."""
        stones = {step.stone: step.step for step in self.stone_steps}
        return stones | {step.id: step.step for step in self.wedge_steps}

    @property
    def course_heights_px(self) -> dict[int, float]:
        """What Eq. 8 compared the stones with that began a course, by their ids; working px."""
        to_px = self.working_scale * (self.px_per_m or 1.0)
        return {
            step.stone: step.course_height * to_px
            for step in self.stone_steps
            if step.course_height is not None
        }
