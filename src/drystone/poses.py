"""Initial poses and orientation sets (§3.6, Eq. 3, Eq. 12d; DESIGN 4.2)."""

import math

import numpy as np

from drystone.errors import UsageError
from drystone.kernels.raster import areas_by_phase, quantise, rasterise, turn
from drystone.model.pose import PosedStone
from drystone.model.stone import Stone


def bounding_box_shape_factor(stone: Stone, angle_deg: float) -> float:
    """Return SF (Eq. 3) of a stone turned by an angle: its area over that of its bounding box.

    The box is that of the turned outline, without resampling.
    """
    extent = np.ptp(turn(stone.hull, angle_deg), axis=0)
    return float(stone.area_px / (extent[0] * extent[1]))


def initial_angle_deg(stone: Stone) -> float:
    """Return the angle R0 that maximises SF over 1-degree steps in [-45, 45) (Eq. 12d).

    Of equal angles the smallest turn wins, so a disc stays as it lies.
    """
    angles = sorted(range(-45, 45), key=lambda a: (abs(a), a))
    factors = [bounding_box_shape_factor(stone, float(a)) for a in angles]
    best = max(factors)
    return float(next(a for a, f in zip(angles, factors, strict=True) if f >= best - 1e-12))


def wrap_deg(angle_deg: float) -> float:
    """Bring an angle into [-180, 180)."""
    return (angle_deg + 180.0) % 360.0 - 180.0


def orientation_step_deg(orientations: str) -> float | None:
    """Return the step of an orientation set written ``"10deg"``; None for sf and quarter."""
    if orientations in ("sf", "quarter"):
        return None
    text = orientations.removesuffix("deg")
    try:
        step = float(text)
    except ValueError:
        step = math.nan
    if not orientations.endswith("deg") or not 0.5 <= step <= 360:
        raise UsageError(
            "E122",
            f"{orientations!r} is no set of orientations.",
            where="--orientations",
            cure="Use sf, quarter, or a step from 0.5deg to 360deg, such as 10deg.",
        )
    return step


class PoseBook:
    """Turned, rasterised stones at one working resolution, each made once.

    Parameters
    ----------
    scale : float
        Working resolution over source resolution.
    """

    def __init__(self, scale: float = 1.0) -> None:
        self.scale = scale
        self._poses: dict[tuple[Stone, float], PosedStone] = {}
        self._angles: dict[Stone, float] = {}

    def pose(self, stone: Stone, angle_deg: float) -> PosedStone:
        """Return the stone turned by an angle, rasterised at a favourable sub-pixel position.

        Favourable is the position, starting from edges on pixel edges, at which the area of the
        pixels comes within 1 % (or 2 px) of the stone's own, or else comes closest.
        """
        key = (stone, wrap_deg(angle_deg))
        if key not in self._poses:
            self._poses[key] = _best_phase_pose(stone, key[1], self.scale)
        return self._poses[key]

    def initial_angle(self, stone: Stone) -> float:
        """Return :func:`initial_angle_deg` of a stone, computed once."""
        if stone not in self._angles:
            self._angles[stone] = initial_angle_deg(stone)
        return self._angles[stone]

    def orientations(self, stone: Stone, orientations: str) -> tuple[PosedStone, ...]:
        """Return the poses of a stone that are candidates (DESIGN 4.2).

        Parameters
        ----------
        stone : Stone
            The stone.
        orientations : str
            ``"sf"``: the pose of largest SF; ``"quarter"``: that and its quarter turns;
            ``"10deg"`` or any step: [-180, 180) in steps from the source pose.

        Returns
        -------
        poses : tuple of PosedStone
            Poses whose pixels are the same are given once.
        """
        step = orientation_step_deg(orientations)
        if step is not None:
            angles = [-180.0 + i * step for i in range(math.ceil(360.0 / step - 1e-9))]
        else:
            first = self.initial_angle(stone)
            turns = (0,) if orientations == "sf" else (0, 90, 180, 270)
            angles = [wrap_deg(first + quarter) for quarter in turns]
        different: dict[tuple[tuple[int, ...], bytes], PosedStone] = {}
        for angle in angles:
            posed = self.pose(stone, angle)
            different.setdefault((posed.mask.shape, posed.mask.tobytes()), posed)
        return tuple(different.values())


def pose_at(
    stone: Stone, angle_deg: float, scale: float, phase: tuple[float, float]
) -> tuple[PosedStone, int, int]:
    """Rasterise a stone with its centroid at a given sub-pixel position.

    Parameters
    ----------
    stone : Stone
        The stone.
    angle_deg : float
        Counter-clockwise from the source image.
    scale : float
        Working resolution over source resolution.
    phase : (float, float)
        Centroid right of and above a pixel corner, multiples of 1/64 in [0, 1).

    Returns
    -------
    posed : PosedStone
        The stone.
    left, bottom : int
        Its mask's bottom-left corner relative to that pixel corner.
    """
    mask, left, bottom = rasterise(stone.mask, stone.local_centroid, angle_deg, scale, phase)
    anchor = (phase[0] - left, phase[1] - bottom)
    return PosedStone(stone, angle_deg, scale, mask, anchor), left, bottom


def _best_phase_pose(stone: Stone, angle_deg: float, scale: float) -> PosedStone:
    area = stone.area_px * scale**2
    edge = -turn(stone.hull, angle_deg).min(axis=0) * scale
    first = (quantise(edge[0]) % 1.0, quantise(edge[1]) % 1.0)
    tolerance = max(0.01 * area, 2.0)
    best, least = 0, math.inf
    # Rows first: a bottom edge on a pixel edge rests flat.
    areas = areas_by_phase(stone.mask, stone.local_centroid, angle_deg, scale, first)
    for number, found in enumerate(areas):
        error = abs(found - area)
        if error < least:
            best, least = number, error
        if error <= tolerance:
            break
    up, right = divmod(best, 4)
    phase = ((first[0] + right / 4) % 1.0, (first[1] + up / 4) % 1.0)
    return pose_at(stone, angle_deg, scale, phase)[0]
