"""Where the stones of a test photograph lie."""

import tomllib
from dataclasses import dataclass
from pathlib import Path
from typing import Literal

import numpy as np
from numpy.random import Generator
from numpy.typing import NDArray
from scipy import ndimage

from drystone.generate import FourierSettings, RubbleSettings, fourier_stones, rubble_stones
from drystone.kernels.raster import Mask

Markers = Literal["sheet", "single", "none"]
GroundKind = Literal["plywood", "tarpaulin", "cloth", "rubber", "gravel", "grass"]
Rock = Literal["granite", "sandstone", "limestone", "basalt", "schist"]


@dataclass(frozen=True, kw_only=True)
class PhotoLevel:
    """What a photograph shows, and what the camera does to it."""

    name: str
    seed: int = 1
    count: int = 24  # Stones; a few less when they find no place
    angular: float = 0.5  # Share of the stones that are rubble, 0 to 1; the others are rounded
    rocks: tuple[Rock, ...] = ("granite", "sandstone", "limestone")  # Kinds of rock, in turn
    ground: GroundKind = "tarpaulin"
    gap_px: int = 24  # Empty px between stones and between stones and the edge, at least
    touching: int = 0  # Stones that are pushed against another one
    cut: int = 0  # Stones that the edge of the photograph cuts
    shadow: float = 0.0  # How much light a cast shadow takes, 0 to 1
    sun_deg: float = 50.0  # Height of the light above the ground
    # How much darker the darkest place of the ground is lit than the brightest, 0 to 1
    uneven: float = 0.0
    markers: Markers = "sheet"  # A sheet of four, four single ones, or none
    marker_mm: float = 75.0  # Side of a marker
    wrong_print: float = 1.0  # How much too large the last paper was printed; 1 is right
    tilt_deg: float = 0.0  # How far the camera looks away from the vertical
    turn_deg: float = 0.0  # How far the photograph is turned about the line of sight
    # blur_px, noise, quality: Radius (sigma) of the defocus, standard deviation of the sensor's
    # noise in grey values, quality of the JPEG
    blur_px: float = 0.6
    noise: float = 1.5
    quality: int = 92
    orientation: int = 1  # EXIF orientation, 1 to 8, with which the file is stored
    width_px: int = 2000  # width_px, height_px: Of the photograph as it is seen
    height_px: int = 1500
    px_per_m: float = 1250.0  # About, in the middle of the photograph


LEVELS = tuple(
    PhotoLevel(**level | {"rocks": tuple(level.get("rocks", PhotoLevel.rocks))})
    for level in tomllib.loads(Path(__file__).with_name("levels.toml").read_text("utf-8"))["levels"]
)
"""Test photographs, from easy to hard."""


Labels = NDArray[np.uint16]
TRIES = 400


def lay_stones(level: PhotoLevel, forbidden: Mask, seen: Mask, rng: Generator) -> Labels:
    """Lay stones down where there is room; return them, 1 ... n, 0 elsewhere.

    `forbidden` (h, w) is where the markers are, `seen` (h, w) what the camera sees of the ground.
    """
    masks = [np.rot90(mask, int(rng.integers(4))) for mask in _shapes(level, rng)]
    masks.sort(key=lambda mask: -int(mask.sum()))
    inside = ndimage.distance_transform_edt(np.pad(seen, 1))[1:-1, 1:-1] > level.gap_px
    edge = inside & ~ndimage.binary_erosion(inside)
    table = _Table(
        np.zeros(forbidden.shape, np.uint16), forbidden.copy(), ~inside | forbidden, level.gap_px
    )
    for turn, mask in enumerate(masks):
        if turn >= len(masks) - level.touching and table.count:
            table.push(mask, rng)
        elif turn < level.cut:
            table.drop(mask, np.argwhere(edge), rng, table.taken)
        else:
            table.drop(mask, np.argwhere(inside), rng, table.taken | table.outside)
    return table.labels


def _shapes(level: PhotoLevel, rng: Generator) -> list[Mask]:
    """Return masks that cover about a quarter of the photograph, which leaves room for all."""
    angular = round(level.angular * level.count)
    area = 0.24 * level.width_px * level.height_px / level.count
    radius = float(np.sqrt(area / np.pi))
    masks: list[Mask] = []
    if level.count > angular:
        rounded = FourierSettings(
            count=level.count - angular, smallest_radius_px=0.6 * radius,
            largest_radius_px=1.35 * radius, D2=0.12,
        )  # fmt: skip
        masks += [stone.mask for stone in fourier_stones(rounded, rng)]
    if angular:
        side = float(np.sqrt(area * angular))
        rubble = RubbleSettings(
            count=angular, width_px=1.5 * side, height_px=side / 1.5,
            courses=max(1, round(np.sqrt(0.7 * angular))),
        )  # fmt: skip
        masks += [stone.mask for stone in rubble_stones(rubble, rng)]
    return masks


@dataclass
class _Table:
    """The ground while stones are laid on it."""

    labels: Labels
    taken: Mask
    outside: Mask
    gap_px: int
    count: int = 0

    def drop(self, mask: Mask, middles: NDArray[np.intp], rng: Generator, blocked: Mask) -> None:
        """Lay a stone at one of the places where it covers nothing that is blocked."""
        for middle in rng.integers(len(middles), size=TRIES):
            row, col = (int(k) for k in middles[middle] - np.array(mask.shape) // 2)
            if self._holds(row, col, mask) and not (blocked[_box(row, col, mask)] & mask).any():
                self._lay(row, col, mask)
                return

    def push(self, mask: Mask, rng: Generator) -> None:
        """Move a stone towards another until they touch, if it can lie there."""
        for _ in range(TRIES // 10):
            beside = int(rng.integers(1, self.count + 1))
            angle = rng.uniform(0, 2 * np.pi)
            place = self._contact(beside, mask, np.array([np.sin(angle), np.cos(angle)]))
            if place is not None:
                self._lay(*place, mask)
                return

    def _contact(self, beside: int, mask: Mask, way: NDArray[np.float64]) -> tuple[int, int] | None:
        """Return where a stone that comes along a ray meets the other; None when it cannot lie."""
        old = self.labels == beside
        middle = np.argwhere(old).mean(axis=0) - np.array(mask.shape) / 2
        reach = int(max(mask.shape) + 2 * np.sqrt(old.sum()))
        for near in range(reach):
            row, col = (int(k) for k in middle + way * near)
            if not self._holds(row, col, mask):
                return None
            box = _box(row, col, mask)
            if not (old[box] & mask).any():
                bad = self.outside[box] | (self.labels[box] != 0)
                return None if (bad & mask).any() else (row, col)
        return None

    def _holds(self, row: int, col: int, mask: Mask) -> bool:
        height, width = self.labels.shape
        return (
            row >= 0 and col >= 0 and row + mask.shape[0] <= height and col + mask.shape[1] <= width
        )

    def _lay(self, row: int, col: int, mask: Mask) -> None:
        self.count += 1
        self.labels[_box(row, col, mask)][mask] = self.count
        gap, (height, width) = self.gap_px, mask.shape
        near = np.s_[max(row - gap, 0) : row + height + gap, max(col - gap, 0) : col + width + gap]
        self.taken[near] |= ndimage.distance_transform_edt(self.labels[near] == 0) < gap


def _box(row: int, col: int, mask: Mask) -> tuple[slice, slice]:
    return slice(row, row + mask.shape[0]), slice(col, col + mask.shape[1])
