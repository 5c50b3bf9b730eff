"""What statics says of a wall, as lines to draw over it: forces, and how it fails."""

from dataclasses import dataclass

import numpy as np

from drystone.drawing.assembly.parts import Assembly
from drystone.drawing.pictures.forces import LONGEST_SHARE, Resultant, resultants
from drystone.drawing.pictures.mechanism import motion_of
from drystone.kernels.polygons import Points
from drystone.statics.model import Direction
from drystone.statics.result import LimitResult

DIRECTIONS: tuple[Direction, ...] = ("left", "right")

SMALLEST_SHARE = 0.005
"""Arrows of smaller forces over the largest one would be dots."""


STILL = 1e-4
"""Motions of less than this share of the wall's width are none that is seen."""


@dataclass(frozen=True, eq=False)
class Arrow:
    """A force between two parts.

    Parameters
    ----------
    tail, tip : (float, float)
        Unit of the assembly, wall frame; the force acts in the middle, where the parts touch.
    weights : float
        The force over the mean weight of a stone or wedge.
    onto, by : int
        Ids of the part that it acts on, and of the one that it comes from; 0 is the ground.
    """

    tail: tuple[float, float]
    tip: tuple[float, float]
    weights: float
    onto: int
    by: int


@dataclass(frozen=True, eq=False)
class Thrust:
    """The forces at the greatest load that the wall carries.

    Parameters
    ----------
    arrows : tuple of Arrow
        To scale.
    length_per_weight : float
        Length of an arrow for the mean weight of a stone or wedge, unit of the assembly.
    """

    arrows: tuple[Arrow, ...]
    length_per_weight: float


def result_of(assembly: Assembly, direction: Direction) -> LimitResult:
    """Return the result of one direction."""
    both = assembly.resistance
    return both.left if direction == "left" else both.right


def thrust(assembly: Assembly, direction: Direction) -> Thrust | None:
    """Return the forces at the greatest load in a direction; None when there are none.

    Parameters
    ----------
    assembly : Assembly
        The wall.
    direction : {"left", "right"}
        Of the live load.
    """
    forces = result_of(assembly, direction).forces
    if forces is None:
        return None
    acting = resultants(assembly.model, forces)
    largest = max((one.size for one in acting), default=0.0)
    if largest == 0.0:
        return None
    mean = float(np.mean([block.weight for block in assembly.model.blocks if not block.fixed]))
    width, height = assembly.size
    length = LONGEST_SHARE * max(height, 0.2 * width) / largest
    seen = (one for one in acting if one.size >= SMALLEST_SHARE * largest)
    return Thrust(tuple(_arrow(one, length, mean) for one in seen), length * mean)


def failed_outlines(assembly: Assembly, direction: Direction) -> dict[int, Points] | None:
    """Return the outlines of the parts that a mechanism moves, after its motion, by id.

    None when there is no mechanism.  The motion is scaled for pictures
    (:func:`drystone.drawing.pictures.mechanism.motion_of`).
    """
    mechanism = result_of(assembly, direction).mechanism
    if mechanism is None:
        return None
    motion = motion_of({part.id: part.corners for part in assembly.parts}, mechanism)
    moved = motion.at(1.0)
    return {
        region.id: loops[0]
        for region, loops in zip(motion.regions, moved, strict=True)
        if np.abs(loops[0] - region.loops[0]).max() > STILL * assembly.size[0]
    }


def says(assembly: Assembly, direction: Direction) -> str:
    """Say at which load the forces of a direction act and the wall fails."""
    result = result_of(assembly, direction)
    if result.alpha is None:
        return f"to the {direction}: {result.status.value}"
    return (
        f"to the {direction}: at a lateral load of alpha = {result.alpha:.4f} times the weight "
        "(adequacy factor)"
    )


def _arrow(one: Resultant, length: float, mean: float) -> Arrow:
    half = 0.5 * length * one.force
    (x0, y0), (x1, y1) = (one.point - half).tolist(), (one.point + half).tolist()
    return Arrow((x0, y0), (x1, y1), one.size / mean, one.interface.block, one.interface.other)
