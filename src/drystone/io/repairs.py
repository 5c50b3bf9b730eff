"""Pixels of a label image that are no stone's: nets of edges, and blended ones along edges."""

from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage

from drystone.errors import Notice
from drystone.io.checks import RARE_PX, astray_px, blended
from drystone.io.file_errors import listed
from drystone.io.labels import Census, IdImage, take_census
from drystone.kernels.label_runs import label_runs, runs_in_pieces

_VOID = (255, 65535, 2**32 - 1)
"""What data sets call no class, and what -1 becomes without a sign."""

_NET_SHARE = 0.5
"""Of the outlines of stones, what a net of edges touches at least; measured: 1, .99, .97."""

_NET_WIDTH = 0.5
"""Of the mean width of stones, what a net of edges has at most; measured: .12, .16, .29."""

_FEW = 0.1
"""Share of the outlines of stones that may be blended; scaled or blurred labels have .5 and more,
and the published ones that are repaired .01."""

_AROUND = [(r, c) for r in (-1, 0, 1) for c in (-1, 0, 1) if r or c]
_WEIGHTS = np.array([1 if r and c else 2 for r, c in _AROUND])
_WHOLE = np.ones((3, 3), bool)


def without_net(image: IdImage, census: Census, *, wall: bool = False) -> tuple[IdImage, Census]:
    """Make a value background that is a net of edges around stones, and say so (W135)."""
    net = _net(census, image.background)
    if net is None:
        return image, census
    value = int(census.values[net])
    count = int(census.counts[net])
    what = f"the value {value} ({count} px) is a net of edges around stones: read as background."
    cure = "Use --no-mask (mask=False in Python) to keep it as a stone."
    if wall:
        cure = "If it is of stone, draw its parts in ids of their own."
    ids = np.where(census.index == net + 1, image.background, image.ids).astype(image.ids.dtype)
    notices = (*image.notices, Notice("W135", what, cure))
    return replace(image, ids=ids, brightness=None, notices=notices), take_census(ids)


def _net(census: Census, background: int) -> int | None:
    """Return the position of a value that is thin and lies around most of the stones."""
    index, n = census.index, len(census.values)
    if n < 3:
        return None
    pairs: list[tuple[NDArray[Any], NDArray[Any]]] = []
    for a, b in ((index[:, :-1], index[:, 1:]), (index[:-1], index[1:])):
        apart = a != b
        if 2 * np.count_nonzero(apart) > apart.size:  # noise
            return None
        pairs.append((a[apart] - 1, b[apart] - 1))
    a, b = (np.concatenate(side) for side in zip(*pairs, strict=True))
    ground = census.values == background
    at_ground = ground[a] | ground[b]
    of_each = np.bincount(a, minlength=n) + np.bincount(b, minlength=n)
    off_ground = np.bincount(a[~at_ground], minlength=n) + np.bincount(b[~at_ground], minlength=n)
    # Of all stones but the one that is looked at.
    outlines = len(a) - (of_each - off_ground)
    areas = census.counts[~ground].sum() - census.counts
    with np.errstate(divide="ignore", invalid="ignore"):
        narrow = census.counts / of_each < _NET_WIDTH * (areas / outlines)
        around = off_ground >= _NET_SHARE * outlines
    for net in np.flatnonzero(narrow & around & ~ground & (areas > 0)).tolist():
        stones = ~ground
        stones[net] = False
        found, _ = ndimage.label(census.pixels(stones))
        count = int((np.bincount(found.ravel())[1:] >= RARE_PX).sum())
        if count >= (1 if int(census.values[net]) in _VOID else 3):
            return int(net)
    return None


def without_blends(
    image: IdImage, census: Census, least_px: int, *, wall: bool = False
) -> tuple[IdImage, Census]:
    """Give few blended pixels at edges to the stones or the ground that they touch most (W136).

    Pieces of fewer than `least_px` are no stones.  Nothing is done where so many pixels are blended
    that stones could change.
    """
    stray = _stray(census, image.background, least_px, wall=wall)
    if stray is None:
        return image, census
    rows, cols = np.nonzero(stray)
    index = _given(census, stray)
    values = census.values[index[rows, cols] - 1]
    ids = image.ids.copy()
    ids[rows, cols] = values
    took, counts = np.unique(values, return_counts=True)
    parts = [
        f"{'background' if value == image.background else f'stone {value}'}: {count}"
        for value, count in zip(took.tolist(), counts.tolist(), strict=True)
    ]
    what = (
        f"{len(rows)} px at edges have values that were blended; each was given to what it "
        f"touches most ({listed(parts)})."
    )
    cure = (
        "Use --min-area 1 --pieces split (min_area_px=1, pieces='split' in Python) to keep their "
        "values."
    )
    if wall:
        cure = "Export the ids without anti-aliasing if they are right as they are."
    notices = (*image.notices, Notice("W136", what, cure))
    return replace(image, ids=ids, brightness=None, notices=notices), take_census(ids)


def _stray(
    census: Census, background: int, least_px: int, *, wall: bool
) -> NDArray[np.bool_] | None:
    """Return the pixels of small pieces at stones whose values were blended; None for no few."""
    core = np.zeros(len(census.values) + 1, bool)
    core[census.index[census.solid]] = True
    ground = census.values == background
    thin = ~core[1:] & ~ground
    stones = ~census.pixels(ground)
    lone = census.pixels(thin) | (astray_px(census) & stones)
    lone[[0, -1]] |= census.pixels(thin)[[0, -1]]
    most = _FEW * np.count_nonzero(stones & ~census.solid)
    if not core.any() or not lone.any():
        return None
    runs = label_runs(census.index)
    pieces = runs_in_pieces(runs)
    small = (np.bincount(pieces, runs.lengths) < least_px)[pieces]
    lengths = runs.lengths[small]
    begins = (runs.rows * runs.width + runs.begins)[small]
    place = np.repeat(begins - np.cumsum(lengths) + lengths, lengths) + np.arange(lengths.sum())
    stray = np.zeros(lone.shape, bool)
    stray.ravel()[place] = True
    stray &= lone
    sure = blended(census, stray)
    stray[stray] = sure if wall else sure | thin[census.index[stray] - 1]
    if not stray.any():
        return None
    # What lies on the ground alone is a speck.
    joined, count = ndimage.label(stray, _WHOLE)
    body = np.pad(stones & ~stray, 1)
    rows, cols = np.nonzero(stray)
    at_stone = np.logical_or.reduce([body[rows + 1 + r, cols + 1 + c] for r, c in _AROUND])
    kept = np.zeros(count + 1, bool)
    kept[joined[rows, cols][at_stone]] = True
    stray = kept[joined]
    return stray if 0 < np.count_nonzero(stray) <= most else None


def _given(census: Census, stray: NDArray[np.bool_]) -> NDArray[np.int32]:
    """Return the positions of values with those of stray pixels chosen by their neighbours.

    A side counts twice as much as a corner; pixels among stray ones wait for those around them.
    """
    index = np.pad(np.where(stray, 0, census.index), 1)
    rows, cols = np.nonzero(stray)
    rows, cols = rows + 1, cols + 1
    while len(rows):
        near = np.stack([index[rows + r, cols + c] for r, c in _AROUND], axis=1)
        alike = near[:, :, None] == near[:, None, :]
        votes = np.where(near > 0, (alike * _WEIGHTS).sum(axis=2), 0)
        best = votes.argmax(axis=1)
        chosen = near[np.arange(len(rows)), best]
        index[rows, cols] = chosen
        rows, cols = rows[chosen == 0], cols[chosen == 0]
    return index[1:-1, 1:-1].astype(np.int32)
