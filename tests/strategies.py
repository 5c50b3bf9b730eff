"""Hypothesis strategies: random connected masks, stones, landscapes and small walls."""

from collections.abc import Callable
from typing import Any

import numpy as np
from hypothesis import settings
from hypothesis import strategies as st
from numpy.typing import NDArray
from scipy import ndimage

from drystone.kernels.raster import Mask
from drystone.model.placement import Placement
from drystone.model.pose import PosedStone
from drystone.model.site import Site
from drystone.model.stone import Stone
from drystone.model.wall import Wall
from drystone.poses import PoseBook

Draw = Callable[[st.SearchStrategy[Any]], Any]


def repeatable(max_examples: int = 60) -> settings:
    """The same examples in every run, without a clock."""
    return settings(max_examples=max_examples, deadline=None, derandomize=True)


def whole(pixels: NDArray[np.bool_]) -> Mask:
    """The largest edge-connected piece of some pixels, holes filled, cropped."""
    labels, count = ndimage.label(pixels)
    if count == 0:
        return np.ones((1, 1), bool)
    sizes = np.bincount(labels.ravel())[1:]
    mask = ndimage.binary_fill_holes(labels == int(np.argmax(sizes)) + 1)
    rows, cols = np.flatnonzero(mask.any(axis=1)), np.flatnonzero(mask.any(axis=0))
    return np.ascontiguousarray(mask[rows[0] : rows[-1] + 1, cols[0] : cols[-1] + 1])


@st.composite
def masks(draw: Draw, max_px: int = 7) -> Mask:
    """A connected mask of any shape."""
    shape = draw(st.integers(1, max_px)), draw(st.integers(1, max_px))
    return whole(_pixels(draw, shape) | _pixels(draw, shape))


def _pixels(draw: Draw, shape: tuple[int, int]) -> Mask:
    """Pixels from the bits of one integer: far quicker to draw than an array."""
    count = shape[0] * shape[1]
    bits = np.frombuffer(draw(st.integers(0, 2**count - 1)).to_bytes(-(-count // 8)), np.uint8)
    return np.unpackbits(bits, count=count).astype(bool).reshape(shape)


def _resting_places(occupied: Mask, mask: Mask) -> list[tuple[int, int]]:
    """Where a mask overlaps nothing and would one pixel lower, or stands on the ground."""
    height, width = occupied.shape
    if mask.shape[0] > height or mask.shape[1] > width:
        return []
    scene = np.vstack([occupied, np.ones((1, width), bool)])
    windows = np.lib.stride_tricks.sliding_window_view(scene, mask.shape)
    hit: Mask = np.asarray(windows[..., mask].any(axis=-1))
    return [(int(row), int(col)) for row, col in np.argwhere(~hit[:-1] & hit[1:])]


@st.composite
def blobs(draw: Draw, min_px: int = 8, max_px: int = 24) -> Mask:
    """A rounded mask, as photographed stones are: a circle with a few waves."""
    width = draw(st.integers(min_px, max_px))
    flat = draw(st.sampled_from([1.0, 0.7, 0.45]))
    tilt = draw(st.floats(0, np.pi))
    waves = [draw(st.floats(-0.12, 0.12)) for _ in range(4)]
    centre = width * 0.75
    y, x = np.mgrid[: int(2 * centre) + 1, : int(2 * centre) + 1] - centre
    u, v = x * np.cos(tilt) + y * np.sin(tilt), y * np.cos(tilt) - x * np.sin(tilt)
    angle = np.arctan2(v, u)
    radius = width / 2 * (1 + sum(a * np.cos((k + 2) * angle) for k, a in enumerate(waves)))
    return whole(np.hypot(u, v / flat) <= radius)


@st.composite
def stones(draw: Draw, stone_id: int = 1, max_px: int = 7) -> Stone:
    """A stone of any shape somewhere in a source image."""
    return Stone(stone_id, draw(masks(max_px)), draw(st.integers(0, 9)), draw(st.integers(0, 9)))


@st.composite
def landscapes(draw: Draw, max_px: int = 20) -> Mask:
    """Occupied pixels: rectangles painted over each other, and some dust."""
    height, width = draw(st.integers(1, max_px)), draw(st.integers(1, max_px))
    occupied = np.zeros((height, width), bool)
    for _ in range(draw(st.integers(0, 4))):
        top, left = draw(st.integers(0, height - 1)), draw(st.integers(0, width - 1))
        down, right = draw(st.integers(1, 8)), draw(st.integers(1, 8))
        occupied[top : top + down, left : left + right] = True
    if draw(st.booleans()):
        occupied |= _pixels(draw, occupied.shape) & _pixels(draw, occupied.shape)
    return occupied


@st.composite
def walls(draw: Draw, max_stones: int = 4) -> Wall:
    """A small wall of stones that rest on each other or on the ground, each as it was found."""
    wall = Wall.empty(Site(draw(st.integers(8, 28)), draw(st.integers(6, 18))))
    book = PoseBook()
    for stone_id in range(1, 1 + draw(st.integers(0, max_stones))):
        posed = book.pose(draw(stones(stone_id)), 0.0)
        places = _resting_places(wall.occupied, posed.mask)
        if places:
            row, col = draw(st.sampled_from(places))
            wall = wall.add(Placement(posed, row, col))
    return wall


@st.composite
def posed_on_walls(draw: Draw) -> tuple[Wall, PosedStone, int, int]:
    """A wall, and a stone that rests somewhere on it, stable or not."""
    wall = draw(walls())
    posed = PoseBook().pose(draw(stones(99)), 0.0)
    places = _resting_places(wall.occupied, posed.mask)
    if not places:
        return Wall.empty(wall.site), PoseBook().pose(Stone(99, np.ones((2, 3), bool)), 0.0), \
            wall.site.height_px - 2, 0  # fmt: skip
    row, col = draw(st.sampled_from(places))
    return wall, posed, row, col
