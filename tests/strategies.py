"""Hypothesis strategies: random connected masks, stones, landscapes and small walls."""

from itertools import pairwise

import numpy as np
from hypothesis import settings
from hypothesis import strategies as st
from scipy import ndimage

from drystone.model.placement import Placement
from drystone.model.site import Site
from drystone.model.stone import Stone
from drystone.model.wall import Wall
from drystone.poses import PoseBook


def repeatable(max_examples=60):
    """The profile of `conftest.py` with another number of examples."""
    return settings(max_examples=max_examples)


JOINED = np.ones((3, 3))
"""Pixels that touch at a corner are in one piece."""


def largest(pixels, joined=None):
    """The largest piece of some pixels, cropped; without any, one pixel."""
    labels, count = ndimage.label(pixels, joined)
    if count == 0:
        return np.ones((1, 1), bool)
    mask = labels == int(np.argmax(np.bincount(labels.ravel())[1:])) + 1
    rows, cols = np.flatnonzero(mask.any(axis=1)), np.flatnonzero(mask.any(axis=0))
    return np.ascontiguousarray(mask[rows[0] : rows[-1] + 1, cols[0] : cols[-1] + 1])


def whole(pixels):
    """The largest edge-connected piece of some pixels, holes filled, cropped."""
    return ndimage.binary_fill_holes(largest(pixels))


@st.composite
def masks(draw, max_px=7):
    """A connected mask of any shape."""
    shape = draw(st.integers(1, max_px)), draw(st.integers(1, max_px))
    return whole(_pixels(draw, shape) | _pixels(draw, shape))


def _pixels(draw, shape):
    """Pixels from the bits of one integer: far quicker to draw than an array."""
    count = shape[0] * shape[1]
    bits = np.frombuffer(draw(st.integers(0, 2**count - 1)).to_bytes(-(-count // 8)), np.uint8)
    return np.unpackbits(bits, count=count).astype(bool).reshape(shape)


def _resting_places(occupied, mask):
    """Where a mask overlaps nothing and would one pixel lower, or stands on the ground."""
    height, width = occupied.shape
    if mask.shape[0] > height or mask.shape[1] > width:
        return []
    scene = np.vstack([occupied, np.ones((1, width), bool)])
    windows = np.lib.stride_tricks.sliding_window_view(scene, mask.shape)
    hit = np.asarray(windows[..., mask].any(axis=-1))
    return [(int(row), int(col)) for row, col in np.argwhere(~hit[:-1] & hit[1:])]


@st.composite
def blobs(draw, min_px=8, max_px=24):
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
def joined_masks(draw):
    """A piece that may be joined by corners only, as it is read: holes filled."""
    rng = np.random.default_rng(draw(st.integers(0, 2**32 - 1)))
    shape = draw(st.tuples(st.integers(1, 12), st.integers(1, 12)))
    pixels = rng.random(shape) < draw(st.floats(0.2, 0.8))
    return ndimage.binary_fill_holes(largest(pixels, JOINED))


@st.composite
def holed(draw):
    """A stone with some holes, of one pixel up to all but its rim."""
    mask = draw(st.one_of(masks(max_px=9), joined_masks(), blobs(min_px=10, max_px=40)))
    inner = ndimage.binary_erosion(np.pad(mask, 1))[1:-1, 1:-1]
    seed = draw(st.integers(0, 2**32 - 1))
    share = draw(st.sampled_from([0.0, 0.1, 0.5, 0.9, 1.0]))
    holes = inner & (np.random.default_rng(seed).random(mask.shape) < share)
    return largest(mask & ~holes, JOINED)


@st.composite
def stones(draw, stone_id=1, max_px=7):
    """A stone of any shape somewhere in a source image."""
    return Stone(stone_id, draw(masks(max_px)), draw(st.integers(0, 9)), draw(st.integers(0, 9)))


@st.composite
def landscapes(draw, max_px=20):
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
def walls(draw, max_stones=4):
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
def posed_on_walls(draw):
    """A wall, and a stone that rests somewhere on it, stable or not."""
    wall = draw(walls())
    posed = PoseBook().pose(draw(stones(99)), 0.0)
    places = _resting_places(wall.occupied, posed.mask)
    if not places:
        return Wall.empty(wall.site), PoseBook().pose(Stone(99, np.ones((2, 3), bool)), 0.0), \
            wall.site.height_px - 2, 0  # fmt: skip
    row, col = draw(st.sampled_from(places))
    return wall, posed, row, col


def picture(*rows):
    """Rows from the top as a label image."""
    return np.array(rows, np.uint32)


@st.composite
def brick_labels(draw):
    """Courses of bricks, some with gaps between them."""
    width, rows, brick = draw(st.integers(2, 16)), [], 0
    for _ in range(draw(st.integers(1, 5))):
        row, left = [0] * width, draw(st.integers(0, 2))
        while left < width:
            brick += 1
            right = min(width, left + draw(st.integers(1, 6)))
            row[left:right] = [brick] * (right - left)
            left = right + draw(st.sampled_from([0, 0, 0, 1, 2]))
        rows = [row] * draw(st.integers(1, 4)) + rows
    return picture(*rows)


@st.composite
def stacked_labels(draw):
    """One block on another, from one pixel wide, often just balanced or just not."""
    width, left, rows = draw(st.integers(1, 8)), 30, []
    for number in range(1, draw(st.integers(2, 8))):
        row = [0] * 72
        row[left : left + width] = [number] * width
        rows = [row] * draw(st.integers(1, 5)) + rows
        left += draw(st.integers(-((width + 1) // 2), (width + 1) // 2))
        left, width = max(0, min(left, 60)), draw(st.integers(1, 8))
    return picture(*rows)


@st.composite
def dust_labels(draw):
    """Pixels of any id: single ones, diagonal touches, ids in many pieces, large ids."""
    height, width = draw(st.integers(1, 7)), draw(st.integers(1, 7))
    ids = draw(st.integers(1, 7))
    cells = draw(st.binary(min_size=height * width, max_size=height * width))
    labels = np.frombuffer(cells, np.uint8).reshape(height, width) % (ids + 1)
    return labels.astype(np.uint32) * np.uint32(draw(st.sampled_from([1, 0x1FFFFFFF])))


@st.composite
def holed_labels(draw):
    """Stones painted over each other, rings among them, empty or with loose stones inside."""
    height, width = draw(st.integers(3, 14)), draw(st.integers(3, 14))
    labels = np.zeros((height, width), np.uint32)
    for number in range(1, draw(st.integers(2, 9))):
        top, left = draw(st.integers(0, height - 1)), draw(st.integers(0, width - 1))
        bottom, right = top + draw(st.integers(1, 8)), left + draw(st.integers(1, 8))
        labels[top:bottom, left:right] = number
        if draw(st.booleans()):
            labels[top + 1 : bottom - 1, left + 1 : right - 1] = draw(st.sampled_from([0, 50]))
    return labels


@st.composite
def hanging_labels(draw):
    """Two pillars, and stones between them that stand on nothing."""
    height, gap = draw(st.integers(3, 10)), draw(st.integers(1, 8))
    left, right = draw(st.integers(1, 6)), draw(st.integers(1, 6))
    labels = np.zeros((height, left + gap + right), np.uint32)
    labels[:, :left], labels[:, left + gap :] = 1, 2
    between = labels[: draw(st.integers(1, height - 1)), left : left + gap]
    edges = sorted({0, gap, *draw(st.lists(st.integers(0, gap), max_size=3))})
    for number, (start, stop) in enumerate(pairwise(edges), 3):
        between[:, start:stop] = number
    return labels


@st.composite
def floating_labels(draw):
    """A wall, and a stone in the air above or beside it."""
    below = draw(st.one_of(brick_labels(), stacked_labels(), holed_labels()))
    height, width = below.shape
    tall, wide = draw(st.integers(1, 4)), draw(st.integers(1, 4))
    labels = np.zeros((height + tall + 1, width + wide + 1), np.uint32)
    labels[tall + 1 :, :width] = below
    lift = draw(st.integers(0, height)) if draw(st.booleans()) else 0
    left = width + 1 if lift else draw(st.integers(0, width))
    labels[lift : lift + tall, left : left + wide] = 99
    if not below[-1].any():  # an empty row below is cropped: the stone could come to the ground
        labels[-1, 0] = 98
    return labels


def label_images():
    """A small label image of any of these kinds but the last: most are walls that stand."""
    return st.one_of(
        brick_labels(), stacked_labels(), dust_labels(), holed_labels(), hanging_labels()
    )
