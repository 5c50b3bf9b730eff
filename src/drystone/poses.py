"""Initial poses and orientation sets (§3.6, Eq. 3, Eq. 12d; DESIGN 4.2)."""

import math
from collections import OrderedDict
from collections.abc import Hashable
from threading import Lock
from typing import Generic, TypeVar

import numpy as np

from drystone.errors import UsageError
from drystone.kernels.raster import (
    quantise,
    rasterise,
    rasterise_to_area,
    rotation,
    turned_boxes,
    wrap_deg,
)
from drystone.model.pose import PosedStone
from drystone.model.stone import Stone

Key = TypeVar("Key", bound=Hashable)
Value = TypeVar("Value")

BOOK_BYTES = 1 << 29
"""Poses that a book remembers at most, about: those of a thousand stones at 50 angles each."""

INITIAL_DEG = tuple(sorted(range(-45, 45), key=lambda a: (abs(a), a)))
"""Angles of which the initial one is chosen, smallest turns first."""

_INITIAL_TURNS = np.array([rotation(float(angle)) for angle in INITIAL_DEG])
_INITIAL_TURNS.flags.writeable = False


def initial_angle_deg(stone: Stone) -> float:
    """Return the angle R0 that maximises SF over 1-degree steps in [-45, 45) (Eq. 12d).

    Of equal angles the smallest turn wins, so a disc stays as it lies.
    """
    left, bottom, right, top = turned_boxes(stone.hull, _INITIAL_TURNS).T
    factors = stone.area_px / ((right - left) * (top - bottom))
    return float(INITIAL_DEG[np.flatnonzero(factors >= factors.max() - 1e-12)[0]])


def lying_angle_deg(stone: Stone) -> float:
    """Return that of the four angles of largest SF at which a stone lies, heavy side down.

    SF is the same after a quarter turn.  The pose does not depend on how the stone was turned in
    the photograph.
    """
    first = initial_angle_deg(stone)

    def rank(quarter: int) -> tuple[float, float, float, bytes]:
        turns = np.array([rotation(first + 90.0 * quarter)])
        left, bottom, _, top = turned_boxes(stone.hull, turns)[0].round(6).tolist()
        return top - bottom, -bottom, -left, np.rot90(stone.mask, quarter).tobytes()

    return wrap_deg(first + 90.0 * min(range(4), key=rank))


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
        what = f"{orientations!r} is not a set of orientations."
        cure = "Use sf, quarter, or a step from 0.5deg to 360deg, such as 10deg."
        raise UsageError("E122", what, where="--orientations", cure=cure)
    return step


class RecentlyUsed(Generic[Key, Value]):
    """Values that were used last, as many as a budget of bytes holds; threads may share it.

    When the sizes of the values exceed it, those not used for longest are forgotten.
    """

    def __init__(self, budget_bytes: int) -> None:
        self.budget_bytes = budget_bytes
        self.held_bytes = 0
        self._entries: OrderedDict[Key, tuple[Value, int]] = OrderedDict()
        self._lock = Lock()

    def get(self, key: Key) -> Value | None:
        """Return the value of a key; None when there is none, or no longer."""
        with self._lock:
            entry = self._entries.get(key)
            if entry is None:
                return None
            self._entries.move_to_end(key)
            return entry[0]

    def keep(self, key: Key, value: Value, size_bytes: int) -> Value:
        """Remember a value; return it, or the one that another thread has put there first."""
        with self._lock:
            if key in self._entries:
                return self._entries[key][0]
            if size_bytes > self.budget_bytes:
                return value
            self._entries[key] = (value, size_bytes)
            self.held_bytes += size_bytes
            while self.held_bytes > self.budget_bytes:
                self.held_bytes -= self._entries.popitem(last=False)[1][1]
            return value


class PoseBook:
    """Turned, rasterised stones at one working resolution (over source resolution), each made once.

    Poses not asked for for longest are forgotten and made again when they are: no result depends
    on the budget of memory.
    """

    def __init__(self, scale: float = 1.0, budget_bytes: int = BOOK_BYTES) -> None:
        self.scale = scale
        self._poses = RecentlyUsed[tuple[Stone, float], PosedStone](budget_bytes)
        self._angles: dict[Stone, float] = {}

    def pose(self, stone: Stone, angle_deg: float) -> PosedStone:
        """Return the stone turned by an angle, rasterised at a favourable sub-pixel position.

        Favourable is the position, starting from edges on pixel edges, at which the area of the
        pixels comes within 1 % (or 2 px) of the stone's own, or else comes closest.
        """
        key = (stone, wrap_deg(angle_deg))
        posed = self._poses.get(key)
        if posed is None:
            angle, scale = key[1], self.scale
            left, bottom, *_ = turned_boxes(stone.hull, np.array([rotation(angle)]))[0].tolist()
            # First the position with edges on pixel edges: a bottom edge there rests flat.
            phase = quantise(-left * scale) % 1.0, quantise(-bottom * scale) % 1.0
            area = stone.area_px * scale**2
            wanted = area, max(0.01 * area, 2.0)
            mask, col, row, phase = rasterise_to_area(
                stone.mask, stone.local_centroid, angle, scale, phase, wanted
            )
            posed = PosedStone(stone, angle, scale, mask, (phase[0] - col, phase[1] - row))
            posed = self._poses.keep(key, posed, memory_bytes(posed))
        return posed

    def initial_angle(self, stone: Stone) -> float:
        """Return :func:`lying_angle_deg` of a stone, computed once."""
        if stone not in self._angles:
            self._angles[stone] = lying_angle_deg(stone)
        return self._angles[stone]

    def angles(self, stone: Stone, orientations: str) -> list[float]:
        """Return the angles of a set of orientations; some may give the same pixels."""
        step = orientation_step_deg(orientations)
        if step is not None:
            return [-180.0 + i * step for i in range(math.ceil(360.0 / step - 1e-9))]
        if orientations == "sf":
            return [initial_angle_deg(stone)]
        return [wrap_deg(self.initial_angle(stone) + quarter) for quarter in (0, 90, 180, 270)]

    def orientations(self, stone: Stone, orientations: str) -> tuple[PosedStone, ...]:
        """Return the poses of a stone that are candidates (DESIGN 4.2); the same pixels only once.

        ``"quarter"``: the four of largest SF, lying first; ``"sf"``: that of them with the smallest
        turn from the photograph; ``"10deg"`` or any step: [-180, 180) from there, in steps.
        """
        different: dict[tuple[tuple[int, ...], bytes], PosedStone] = {}
        for angle in self.angles(stone, orientations):
            posed = self.pose(stone, angle)
            different.setdefault((posed.mask.shape, posed.mask.tobytes()), posed)
        return tuple(different.values())


def pose_at(
    stone: Stone, angle_deg: float, scale: float, phase: tuple[float, float]
) -> tuple[PosedStone, int, int]:
    """Rasterise a stone with its centroid at a given sub-pixel position.

    `phase` is the centroid right of and above a pixel corner, multiples of 1/64 in [0, 1); with the
    stone comes its mask's bottom-left corner, left and bottom, relative to that pixel corner.
    """
    mask, left, bottom = rasterise(stone.mask, stone.local_centroid, angle_deg, scale, phase)
    anchor = (phase[0] - left, phase[1] - bottom)
    return PosedStone(stone, angle_deg, scale, mask, anchor), left, bottom


def memory_bytes(posed: PosedStone) -> int:
    """Return about how much memory a pose takes with all that is worked out from it later.

    That is its mirror image, and a few numbers for each run of pixels, of which a row or column
    has one or two.
    """
    return 2 * posed.mask.nbytes + 150 * (posed.height_px + posed.width_px) + 3000
