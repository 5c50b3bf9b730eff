"""What it costs to drop a stone onto a height profile, at all places at once.

The twin of all this is in ``compiled/drops.pyx``.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from drystone.kernels.profiles import EDGE, Floats

Lengths = NDArray[np.int64]

TOUCHING = 1.5
"""Columns on which a stone is closer than this, in widths of a column, carry it."""

NO_JOINT = 0.5
"""Cost of the joint of a stone on the ground, or with no joint below."""

END = 1.0
"""The same of a stone at an end of the wall: that of a top that slopes neither in nor out."""


class DropTerms(NamedTuple):
    """What a drop costs; lengths in source px.

    Parameters
    ----------
    cell_px : float
        Width of a column: a px of the working resolution.
    width_px, height_px : float
        Of the wall.
    slack_px : float
        How far a stone may stand out over the wall's height: settling may sink it.
    clearance_px : float
        How far it is lifted from where it touches.
    narrowest_px : float
        Width of the narrowest stone: nearer to an end of the wall there are no joints.
    mean_height_px, mean_area_px : float
        Of the stones: the units of the costs.
    height, void, gap, slot, headroom, step, joint : float
        Weights of the costs of :func:`drystone.kernels.drops.drops`.
    unbalanced : float
        Weight of how far the centroid is beside what carries the stone, in widths of the stone.
    rest_width_px, rest_height_px : int arrays
        What the stones that are left cannot fill of a free width and of a free height, all in
        working px; not negative.
    """

    cell_px: float
    width_px: float
    height_px: float
    slack_px: float
    clearance_px: float
    narrowest_px: float
    mean_height_px: float
    mean_area_px: float
    height: float
    void: float
    gap: float
    slot: float
    headroom: float
    step: float
    joint: float
    unbalanced: float
    rest_width_px: Lengths
    rest_height_px: Lengths


class Dropped(NamedTuple):
    """A stone that was dropped at each of the first columns.

    Parameters
    ----------
    tops : (columns,) float array
        Of the height profile.
    bottoms : (n,) float array
        Of the stone (:class:`drystone.kernels.profiles.StoneProfile`).
    box : (float, float, float, float)
        Left, bottom, right and top of the stone, from its centroid.
    terms : DropTerms
        Sizes and weights.
    lift : (places,) float array
        y of its centroid with its left end at each of the first columns.
    """

    tops: Floats
    bottoms: Floats
    box: tuple[float, float, float, float]
    terms: DropTerms
    lift: Floats

    @property
    def top(self) -> Floats:
        """Height of the stone's highest point."""
        return np.asarray(self.lift + self.box[3])

    @property
    def bottom(self) -> Floats:
        """Height of its lowest point."""
        return np.asarray(self.lift + self.box[1])

    @property
    def middle(self) -> Floats:
        """Half way up the stone."""
        return np.asarray((self.top + self.bottom) / 2.0)

    @property
    def width(self) -> float:
        """Of the stone."""
        return self.box[2] - self.box[0]

    @property
    def left(self) -> Floats:
        """Where its left end is."""
        return np.asarray(np.arange(len(self.lift)) * self.terms.cell_px)

    def cost(self, constant: float, boxes: Floats) -> Floats:
        """Return all costs but that of a stone that leans."""
        terms = self.terms
        cost = constant + terms.height / terms.mean_height_px * self.lift
        cost = cost + terms.void / terms.mean_area_px * self.void()
        cost = cost + terms.headroom / terms.mean_area_px * self.headroom()
        cost = cost + terms.gap * np.minimum(1.0, self.gap() * terms.cell_px / terms.mean_area_px)
        cost = cost + terms.slot / terms.mean_area_px * self.slot()
        cost = cost + terms.step / terms.mean_height_px * self.step(boxes)
        return np.asarray(cost + terms.joint * self.joint(boxes))

    def void(self) -> Floats:
        """Return the area under the stone."""
        bottoms, cell, places = self.bottoms, self.terms.cell_px, len(self.lift)
        before = len(bottoms) - 1
        under, hollow = np.zeros(places), 0.0
        for k, bottom in enumerate(bottoms[:-1].tolist()):
            under = under + self.tops[k : k + places]
            hollow += bottom
        # The last column counts as far as the stone reaches into it.
        last = self.width - before * cell
        height = (self.lift + bottoms[-1]) - self.tops[before : before + places]
        return np.asarray(cell * ((self.lift * before + hollow) - under) + last * height)

    def headroom(self) -> Floats:
        """Return the area over the stone that the others cannot fill."""
        terms, rest = self.terms, self.terms.rest_height_px
        free = np.floor((terms.height_px - self.top) / terms.cell_px + EDGE)
        free = np.clip(free, 0.0, len(rest) - 1.0).astype(np.intp)
        return np.asarray(rest[free] * (terms.cell_px * self.width))

    def gap(self) -> Floats:
        """Return the free height of the columns up to what reaches over the stone's middle.

        They are added up until the area is that of a mean stone.
        """
        places, full = len(self.lift), self.terms.mean_area_px / self.terms.cell_px
        top, bottom, middle = self.top, self.bottom, self.middle
        heights, free = np.zeros(places), np.ones(places, np.bool_)
        for away in range(1, places):
            column = self.tops[: places - away]  # so far to the left
            free = free[-len(column) :] & (column < middle[away:]) & (heights[away:] < full)
            if not free.any():
                break
            added = top[away:] - np.maximum(column, bottom[away:])
            heights[away:] = np.where(free, heights[away:] + added, heights[away:])
        return heights

    def slot(self) -> Floats:
        """Return the area that the others cannot fill before what is higher than the foot."""
        rest, columns = self.terms.rest_width_px, len(self.tops)
        ends = np.arange(len(self.lift)) + len(self.bottoms)
        foot = self.bottom + self.terms.cell_px
        closed = (self.tops > foot[:, None]) & (np.arange(columns) >= ends[:, None])
        end = np.where(closed.any(axis=1), closed.argmax(axis=1), columns)
        free = np.minimum(end - ends, len(rest) - 1)
        return np.asarray(rest[free] * (self.terms.cell_px * (self.top - self.bottom)))

    def step(self, boxes: Floats) -> Floats:
        """Return how far the top is from level with the left neighbour's (Eq. 6)."""
        if not len(boxes):
            return np.zeros(len(self.lift))
        low, ends, high = boxes[:, 1], boxes[:, 2], boxes[:, 3]
        top, bottom, left = self.top[:, None], self.bottom[:, None], self.left[:, None]
        shared = np.minimum(high, top) - np.maximum(low, bottom)
        level = 2.0 * shared >= np.minimum(high - low, top - bottom)
        end = np.where(level & (2.0 * ends <= left + (left + self.width)), ends, -np.inf)
        last = end.max(axis=1)
        highest = np.where(end == last[:, None], high, -np.inf).max(axis=1)
        return np.where(last > -np.inf, np.abs(self.top - highest), 0.0)

    def joint(self, boxes: Floats) -> Floats:
        """Return 1 - IWR (Eq. 9)."""
        narrowest, width = self.terms.narrowest_px, self.terms.width_px
        left = self.left
        right = left + self.width
        one, first = self._ratio(boxes, 2, left, boxes[:, 2] < width - narrowest)
        two, second = self._ratio(boxes, 0, right, boxes[:, 0] > narrowest)
        count = first.astype(np.float64) + second
        cost = np.where(count > 0.0, 1.0 - (one + two) / np.maximum(count, 1.0), NO_JOINT)
        cost = np.where(self.bottom < self.terms.cell_px / 2.0, NO_JOINT, cost)
        return np.where(np.minimum(left, width - right) < narrowest, END, cost)

    def _ratio(
        self, boxes: Floats, side: int, x: Floats, counts: NDArray[np.bool_]
    ) -> tuple[Floats, NDArray[np.bool_]]:
        """Return how far the nearest top corner below is from an end, in widths of its box.

        No more than 1; 0 where there is none.  Also says where there is one.
        """
        if not counts.any():
            return np.zeros(len(x)), np.zeros(len(x), np.bool_)
        away, rise = boxes[:, side] - x[:, None], boxes[:, 3] - self.bottom[:, None]
        below = counts & (boxes[:, 3] <= self.middle[:, None])
        square = np.where(below, away * away + rise * rise, np.inf)
        nearest = square.argmin(axis=1)
        found: NDArray[np.bool_] = np.asarray(below.any(axis=1))
        width = boxes[nearest, 2] - boxes[nearest, 0]
        ratio = np.abs(np.take_along_axis(away, nearest[:, None], axis=1)[:, 0]) / width
        return np.where(found, np.minimum(1.0, ratio), 0.0), found

    def lean(self) -> Floats:
        """Return how far the centroid is right of what carries the stone, in widths."""
        bottoms, cell = self.bottoms, self.terms.cell_px
        tops = np.lib.stride_tricks.sliding_window_view(self.tops, len(bottoms))[: len(self.lift)]
        carries = (self.lift[:, None] + bottoms) - tops < TOUCHING * cell
        start = carries.argmax(axis=1) * cell
        end = np.minimum(self.width, (len(bottoms) - carries[:, ::-1].argmax(axis=1)) * cell)
        beside = np.minimum(0.0, -self.box[0] - start) + np.maximum(0.0, -self.box[0] - end)
        return np.asarray(beside / self.width)
