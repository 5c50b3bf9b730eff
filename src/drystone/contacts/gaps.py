"""Pictures of real walls have gaps between the stones: close them for the contacts, or settle.

Blocks that touch too little are named, with what they would touch next.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Literal

import numpy as np
import shapely
from numpy.typing import NDArray
from scipy import ndimage
from scipy.spatial import cKDTree

from drystone.contacts.blocks import ImageModel, model_from_labels
from drystone.kernels.polygons import Points
from drystone.kernels.raster import Mask
from drystone.kernels.runs import narrow_gaps
from drystone.model.wall import Labels
from drystone.statics.model import GROUND, RigidBlockModel
from drystone.statics.result import LateralResistance

LADDER = (1, 2, 3, 4, 5, 6, 7, 8, 10, 12, 14, 16, 18, 20, 24, 28, 32, 36, 40)
"""Widths that are tried one after the other,"""

STEPS = 60
"""in sixtieths of the shorter side of a usual stone, a px at least."""

BEYOND, LITTLE = 1.5, 0.1
"""A load multiplier that changes by a tenth at most up to 1.5 of a width does not hang on it."""

TIE_BREAK = (-1e-4, -3e-5)
"""Added to (row, col): of two stones at one distance the upper or left one is the nearer."""


def close_gaps(labels: Labels, reach_px: float) -> Labels:
    """Give the pixels of narrow gaps, up to `reach_px` wide, to the stones beside them.

    The ground is below the lowest stone pixel.  Every stone pixel stays as before.  A pixel of a
    gap belongs to the stone nearest to it, so that stones meet in the middle; a gap above the
    ground belongs to the stone above.

    An empty pixel lies in a gap when two stones, or a stone and the ground, bound it on both sides
    in its row or column.  The width of the gap is that run, or h v / sqrt(h^2 + v^2) when both are
    bounded, which is the width of a straight tilted gap.  It goes to the nearest of the stones that
    bound it.  What gaps that are closed leave open between them, no wider than the reach, as where
    joints meet, is closed as well. Stones that are further apart than the reach are not brought
    into contact; nor does a stone grow where only air is beyond.
    """
    filled = np.flatnonzero((labels > 0).any(axis=1))
    if not filled.size or reach_px < 1:
        return labels.copy()
    height = int(filled[-1]) + 1
    # A row of ground, with an id of its own, lies below.
    ground = int(labels.max()) + 1
    below = np.full((1, labels.shape[1]), ground)
    cells = np.vstack([labels[:height].astype(np.int64), below])
    gap, nearest = narrow_gaps(cells, ground, reach_px)
    grown = np.where(gap, nearest, cells)
    # By what grew beside them: a stone itself would bulge into a joint that meets it.
    holes = _holes_between(cells, gap, reach_px)
    stone = (grown > 0) & (grown != ground)
    rim = np.argwhere(stone & ~ndimage.binary_erosion(stone))
    _, places = cKDTree(rim).query(np.argwhere(holes) + TIE_BREAK)
    grown[holes] = grown[tuple(rim[places].T)]
    # Pixels that are not connected with the stone they were given to are taken back.
    for block in np.unique(grown[grown != cells]).tolist():
        pieces, _ = ndimage.label(grown == block)
        own = np.unique(pieces[cells == block])
        grown[(pieces > 0) & ~np.isin(pieces, own)] = 0
    _part_strangers(cells, grown, reach_px)
    closed = labels.copy()
    stones = np.where(grown[:-1] == ground, 0, grown[:-1])
    closed[:height] = stones.astype(labels.dtype)
    return closed


def model_with_closed_gaps(labels: Labels, reach_px: float, mu: float = 0.58) -> ImageModel:
    """Make the rigid block model of a label image, with contacts across narrow gaps.

    Weights and centroids are those of the pixels of the stones; contact points lie in the middle of
    the gaps.  Between stones a contact may reach into the gaps beside it, as far as these are
    closed.
    """
    picture = model_from_labels(labels, mu)
    closed = model_from_labels(close_gaps(labels, reach_px), mu)
    interfaces = []
    for interface in closed.model.interfaces:
        points = interface.points.copy()
        if interface.other == GROUND:  # within the columns of its stone: toes do not grow
            cols = np.flatnonzero((labels == interface.block).any(axis=0))
            points[:, 0] = np.clip(points[:, 0], cols[0], cols[-1] + 1)
        interfaces.append(replace(interface, points=points))
    return replace(picture, model=replace(picture.model, interfaces=tuple(interfaces)))


def settle_gaps(
    labels: Labels, push: Literal["left", "right"] | None = None
) -> tuple[Labels, dict[int, tuple[int, int]]]:
    """Lower stones by whole pixels until they rest on others; nothing turns or overlaps.

    `push` also moves stones to a side until they touch the next stone, if there is one.  Returned
    are the labels, and by id of the stones that moved how many px to the right and down.
    """
    filled = np.flatnonzero((labels > 0).any(axis=1))
    settled = labels.copy()
    if not filled.size:
        return settled, {}
    wall = settled[: int(filled[-1]) + 1]
    ids = np.unique(labels[labels > 0]).tolist()
    moved = dict.fromkeys(ids, (0, 0))
    moving = True
    while moving:
        moving = False
        bottoms = {block: int(np.flatnonzero((wall == block).any(axis=1))[-1]) for block in ids}
        for block in sorted(ids, key=lambda i: (-bottoms[i], i)):
            down, aside = _room(wall, block, 1, 0), 0
            if push is not None and not down:
                step = -1 if push == "left" else 1
                aside = step * _room(wall, block, 0, step)
            if down or aside:
                pixels = wall == block
                wall[pixels] = 0
                wall[np.roll(pixels, (down, aside), axis=(0, 1))] = block
                moved[block] = (moved[block][0] + aside, moved[block][1] + down)
                moving = True
    return settled, {block: way for block, way in moved.items() if way != (0, 0)}


def _holes_between(cells: NDArray[np.int64], gap: Mask, reach_px: float) -> Mask:
    """Find what closed gaps leave open between them, no larger than the reach."""
    pieces, count = ndimage.label((cells == 0) & ~gap)
    holes = np.zeros_like(gap)
    for number, window in enumerate(ndimage.find_objects(pieces, count), start=1):
        rows, cols = window
        small = max(rows.stop - rows.start, cols.stop - cols.start) <= reach_px
        if small and rows.start > 0 and cols.start > 0 and cols.stop < cells.shape[1]:
            around = (slice(rows.start - 1, rows.stop + 1), slice(cols.start - 1, cols.stop + 1))
            hole = pieces[around] == number
            beside = ndimage.binary_dilation(hole) & ~hole
            if gap[around][beside].any():
                holes[around] |= hole
    return holes


def _part_strangers(cells: NDArray[np.int64], grown: NDArray[np.int64], reach_px: float) -> None:
    """Take back pixels by which stones touch that are further apart than the reach."""
    known: dict[tuple[int, int], bool] = {}
    while True:
        bad = np.zeros(grown.shape, bool)
        for first, second in ((np.s_[:, :-1], np.s_[:, 1:]), (np.s_[:-1], np.s_[1:])):
            a, b = grown[first], grown[second]
            new = (cells[first] == 0) | (cells[second] == 0)
            for row, col in np.argwhere(new & (a != b) & (a > 0) & (b > 0)).tolist():
                pair = int(a[row, col]), int(b[row, col])
                if pair not in known:
                    known[pair] = known[pair[::-1]] = _are_within(cells, *pair, reach_px)
                if not known[pair]:
                    bad[first][row, col] = bad[second][row, col] = True
        bad &= cells == 0
        if not bad.any():
            return
        grown[bad] = 0


def _are_within(cells: NDArray[np.int64], one: int, other: int, reach_px: float) -> bool:
    """Tell whether the edges of two blocks are no further apart than the reach."""
    gaps, _ = cKDTree(_corners(cells, one)).query(_corners(cells, other))
    return bool(gaps.min() <= reach_px)


def _corners(cells: NDArray[np.int64], block: int) -> NDArray[np.intp]:
    """Return the pixel corners around a block, (n, 2)."""
    rows, cols = np.nonzero(cells == block)
    top, left = rows.min(), cols.min()
    inside = np.pad(cells[top : rows.max() + 1, left : cols.max() + 1] == block, 1)
    around = np.stack([inside[:-1, :-1], inside[:-1, 1:], inside[1:, :-1], inside[1:, 1:]])
    rim = np.argwhere(around.any(axis=0) & ~around.all(axis=0))
    return np.asarray(rim + np.array([top, left]))


def _room(wall: Labels, block: int, down: int, aside: int) -> int:
    """Return by how many steps a stone can move until it touches another or the ground.

    A step is one px; 0 when nothing is in the way.
    """
    rows, cols = np.nonzero(wall == block)
    width = wall.shape[1]
    others = np.vstack([(wall > 0) & (wall != block), np.ones((1, width), bool)])
    steps = 0
    while cols.min() >= 0 and cols.max() < width:
        rows, cols = rows + down, cols + aside
        inside = (cols >= 0) & (cols < width)
        if others[rows[inside], cols[inside]].any():
            return steps
        steps += 1
    return 0


@dataclass(frozen=True)
class GapSweep:
    """What a wall carries with gaps of one width after the other closed."""

    tried: tuple[tuple[int, bool, float | None], ...]
    """Width in px, whether the wall stands, and the smaller load multiplier where there is one."""
    chosen_px: int  # 0 to leave the gaps open
    stands_from_px: int | None  # None when it stands with none of the widths
    steady: bool  # whether the load multiplier hardly changes from the chosen width on
    upto_px: float  # the widest width of which that is asked

    def within(self) -> tuple[float, float] | None:
        """Return the least and the greatest load multiplier from the chosen width on."""
        found = [
            alpha
            for width, _, alpha in self.tried
            if alpha is not None and self.chosen_px <= width <= self.upto_px
        ]
        return (min(found), max(found)) if found else None


def gap_sweep(analyse: Callable[[int], LateralResistance], usual_px: float) -> GapSweep:
    """Find the narrowest width from which on the load multiplier hardly changes any more.

    `analyse` answers with gaps of a width closed; `usual_px` is the shorter side of a usual stone,
    half of which is the widest.  Without such a width it is the narrowest at which the wall stands.
    """
    tried: dict[int, tuple[bool, float | None]] = {}

    def at(width: int) -> bool:
        if width not in tried:
            both = analyse(width)
            alphas = [end.alpha for end in (both.left, both.right) if end.alpha is not None]
            tried[width] = both.stable, min(alphas, default=None) if both.stable else None
        return tried[width][0]

    step = max(1, round(usual_px / STEPS))
    for width in (0, *(step * number for number in LADDER)):
        if width > max(8.0, usual_px / 2.0):
            break
        at(width)
        if _steady(tried, step) is not None:
            break
    fallen = max((width for width, (stands, _) in tried.items() if not stands), default=-1)
    begin = min((width for width in tried if width > fallen), default=None)
    while begin is not None and begin - fallen > 1 and fallen >= 0:
        between = (begin + fallen) // 2
        begin, fallen = (between, fallen) if at(between) else (begin, between)
    steady = _steady(tried, step)
    chosen = next((width for width in (steady, begin) if width is not None), max(tried))
    told = tuple((width, *tried[width]) for width in sorted(tried))
    return GapSweep(told, chosen, begin, steady is not None, _beyond(chosen, step))


def _steady(tried: Mapping[int, tuple[bool, float | None]], step: int) -> int | None:
    """Return the narrowest width from which on two wider ones or more change little."""
    for width, (stands, alpha) in sorted(tried.items()):
        if not stands:
            continue
        upto = _beyond(width, step)
        wider = [found for other, found in tried.items() if width < other <= upto]
        if len(wider) < 2 or max(tried) < 0.8 * upto:
            continue
        alphas = [one for still, one in wider if still]
        if len(alphas) == len(wider) and all(_alike(alpha, one) for one in alphas):
            return width
    return None


def _beyond(width: int, step: int) -> float:
    # Two widths are tried beyond the narrowest ones, too: steps are shares of a stone.
    return max(BEYOND * width, width + 2.0 * step)


def _alike(one: float | None, other: float | None) -> bool:
    if one is None or other is None:
        return one is other
    return abs(other - one) <= LITTLE * max(one, 1e-9)


ENOUGH = 2
"""Contact points without which nothing rests: an interface has two, at its ends."""


@dataclass(frozen=True)
class Scarce:
    """A block that touches too little."""

    block: int
    contacts: int  # contact points that it has, 0 or 1
    nearest: int | None
    """What it would touch next, GROUND (0) for the ground; None when there is nothing else."""
    gap: float  # how wide the gap to it is, px of the image or unit of the polygons


def scarce_contacts(
    model: RigidBlockModel, shapes: Labels | Mapping[int, Points]
) -> tuple[Scarce, ...]:
    """Find the free blocks that have fewer than two contact points, in the order of the model.

    `shapes` is what it was made from: the label image, row 0 at the top, or polygons (n, 2) by id.
    """
    touching: dict[int, set[int]] = {block.id: set() for block in model.blocks if not block.fixed}
    points = dict.fromkeys(touching, 0)
    for face in model.interfaces:
        for one, other in ((face.block, face.other), (face.other, face.block)):
            if one in touching:
                touching[one].add(other)
                points[one] += len(face.points)
    few = [block for block, count in points.items() if count < ENOUGH]
    near = _near_pixels if isinstance(shapes, np.ndarray) else _near_polygons
    return tuple(
        Scarce(block, points[block], *near(shapes, block, touching[block]))  # type: ignore[arg-type]
        for block in few
    )


def _near_pixels(labels: Labels, block: int, others: set[int]) -> tuple[int | None, float]:
    """Return the nearest label that is not touched, and how many px lie between."""
    lowest = np.flatnonzero((labels > 0).any(axis=1))[-1] + 1
    cells = np.vstack([labels[:lowest].astype(np.int64), np.full((1, labels.shape[1]), -1)])
    rows, cols = np.nonzero(cells == block)
    reach = 8
    while True:
        ends = (slice(max(0, one.min() - reach), one.max() + reach + 1) for one in (rows, cols))
        part = cells[tuple(ends)]
        strangers = (part != 0) & (part != block)
        for other in others:
            strangers &= part != (-1 if other == GROUND else other)
        whole = part.shape == cells.shape
        if strangers.any():
            away = ndimage.distance_transform_edt(part != block)
            distances = np.where(strangers, away, np.inf)
            least = int(np.argmin(distances))
            gap = float(distances.flat[least]) - 1.0
            # Beyond the window there may be something nearer than what is far away in it.
            if gap <= reach or whole:
                found = int(part.flat[least])
                return (GROUND if found == -1 else found), gap
        elif whole:
            return None, np.inf
        reach *= 4


def _near_polygons(
    polygons: Mapping[int, Points], block: int, others: set[int]
) -> tuple[int | None, float]:
    """Return the nearest polygon that is not touched, or the ground, and how far it is away."""
    own = shapely.Polygon(polygons[block])
    strangers: Sequence[int] = [i for i in polygons if i != block and i not in others]
    gaps = {i: float(shapely.distance(own, shapely.Polygon(polygons[i]))) for i in strangers}
    if GROUND not in others:
        gaps[GROUND] = max(0.0, float(own.bounds[1]))
    if not gaps:
        return None, np.inf
    nearest = min(gaps, key=gaps.__getitem__)
    return nearest, gaps[nearest]
