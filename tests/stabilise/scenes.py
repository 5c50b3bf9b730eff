"""Unstable stones for the tests of stabilisation."""

import numpy as np
from hypothesis import strategies as st

from drystone.model.stone import Stone
from drystone.poses import PoseBook
from tests.naive.overlap import lowered
from tests.naive.support import rests_stably

BOOK = PoseBook()
BAR = BOOK.pose(Stone(1, np.ones((6, 30), bool)), 0.0)
BLOCK = BOOK.pose(Stone(2, np.tril(np.ones((14, 18), bool))), 0.0)
_Y, _X = np.mgrid[-5:6, -13:14]
PEBBLE = BOOK.pose(Stone(3, (_X / 13.5) ** 2 + (_Y / 5.5) ** 2 <= 1), 0.0)


def ledge(height=4, width=14, site=(24, 50)):
    """Ground with a step at the left."""
    occupied = np.zeros(site, bool)
    occupied[site[0] - height :, :width] = True
    return occupied


def bar_on_the_ledge(occupied):
    """A bar that lies on the ledge and overhangs to the right."""
    return BAR, int(np.flatnonzero(occupied[:, 2])[0]) - 6, 2


def holds(occupied, pose, wedges, margin=0.0):
    """Whether a stone is stable on its wedges."""
    posed, row, col = pose
    scene = occupied.copy()
    for wedge in wedges:
        scene[wedge.window] |= wedge.mask
    x_c, margin_px = col + posed.anchor[0], margin * posed.width_px
    return rests_stably(scene, posed.mask, row, col, x_c, margin_px)


def mirrored(occupied, pose):
    """The same scene with the stone's own mirror image, as another stone."""
    posed, row, col = pose
    other = BOOK.pose(Stone(posed.stone.id + 1, posed.stone.mask[:, ::-1]), 0.0)
    return occupied[:, ::-1].copy(), (other, row, occupied.shape[1] - col - posed.width_px)


@st.composite
def stairs(draw):
    """Steps down from a pillar to one side, and a stone on top that overhangs them."""
    posed = draw(st.sampled_from([BAR, BLOCK, PEBBLE]))
    widths = draw(st.lists(st.integers(1, 9), min_size=4, max_size=8))
    drops = draw(st.lists(st.integers(0, 4), min_size=len(widths), max_size=len(widths)))
    tops = np.repeat(20 + np.cumsum(drops), widths)
    skyline = np.full(70, min(63, int(tops[-1]) + draw(st.integers(0, 12))))
    skyline[20 : 20 + tops.size] = tops[:50]
    occupied = np.arange(64)[:, None] >= skyline
    occupied[20:, 10 : 20 + draw(st.integers(1, 6))] = True
    col = draw(st.integers(12, 20))
    row = lowered(occupied, posed.mask, col)
    assert row is not None
    if draw(st.booleans()):
        occupied, col = np.ascontiguousarray(occupied[:, ::-1]), 70 - col - posed.width_px
        row = lowered(occupied, posed.mask, col)
        assert row is not None
    return occupied, (posed, row, col)


@st.composite
def high_walls(draw):
    """Walls of columns that are the same for some way down and differ further down."""
    steps = draw(st.lists(st.integers(0, 40), min_size=5, max_size=5))
    skyline = np.repeat(steps, draw(st.sampled_from([12, 13, 14])))
    top = np.arange(70)[:, None] >= 24 + skyline
    top[draw(st.integers(30, 69)), : draw(st.integers(0, skyline.size))] = True
    walls = [top]
    for depth in draw(st.lists(st.integers(28, 70), min_size=1, max_size=3)):
        below = np.zeros((draw(st.sampled_from([1, 15, 60])), skyline.size), bool)
        below[:, :: draw(st.integers(1, 9))] = True
        walls.append(np.vstack([top[:depth], below]))
    return walls
