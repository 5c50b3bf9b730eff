"""Pictures that are no label images are told apart and refused (users' table of bad input)."""

from dataclasses import replace
from typing import Any

import numpy as np
import shapely
from numpy.typing import NDArray
from scipy import ndimage

from drystone.errors import LabelImageError, Notice
from drystone.io.files import listed
from drystone.io.labels import Census, IdImage, components
from drystone.kernels.ids import counted
from drystone.kernels.label_runs import label_runs, runs_in_pieces
from drystone.kernels.silhouette import pixel_hull

RARE_PX = 10
_MANY_VALUES = 64
_PLAIN_SHARE = 0.5
_PLAIN_SHARE_LOSSY = 0.3
_CLEAR_SHARE = 0.01
"""Of a photograph that stones were cut out of, what is transparent at least."""
_TURNED_PX, _STRAIGHT_PX = 1000, 3.0
"""A photograph that was turned has four straight sides, together so long at least; so has a small
stone.
"""
_BLENDED_SHARE = 0.5
"""Measured on published labels scaled or blurred: .57 (bicubic, which overshoots) ... 1."""
_FEW_VALUES = 8
_ASTRAY_SHARE = 0.2
"""Measured on ids 1 ... 9 and 1 ... 30 of bricks and round stones: .15 ... .6 of the outlines when
scaled or blurred, .00 before; .13 in touching stones that are 5 px wide.  A stone set that is
refused without reason has no cure, so the limit keeps clear of those."""

_CLEAN_EXPORT = "Export the ids as PNG or TIFF, without anti-aliasing or resampling."


def check_not_uniform(image: IdImage) -> None:
    """Refuse a picture of one value (E104), and say what became background."""
    if len(image.census.values) > 1:
        return
    value = int(image.census.values[0])
    height, width = image.ids.shape
    what = f"no stones: all {width} x {height} px are {value}"
    if value == image.background:
        why = " ".join(notice.message for notice in image.notices)
        hint = "Draw every stone in an id of its own, from 1."
        raise LabelImageError("E104", " ".join((f"{what} (background).", why)).strip(), cure=hint)
    cure = f"Is {value} the background? Then the stones are missing; else leave a rim of 0."
    raise LabelImageError("E104", f"{what}, and nothing tells stone from background.", cure=cure)


def check_background(
    census: Census,
    background: int,
    cure: str = "Use --background {0} (background={0} in Python)",
    rim_px: int = 0,
) -> None:
    """Refuse a picture whose background is plainly another value (E105), {0} in the cure.

    Of a mask the census has the two ends.  A rim of so many px is not looked at.
    """
    index = census.index
    if 2 * rim_px < min(index.shape):
        index = index[rim_px : len(index) - rim_px, rim_px : index.shape[1] - rim_px]
    common = int(counted(index, len(census.values)).argmax())
    value = int(census.values[common - 1])
    if value == background:
        return
    sides = [line == common for line in (index[0], index[-1], index[:, 0], index[:, -1])]
    corners = sum(int(index[r, c] == common) for r in (0, -1) for c in (0, -1))
    # A stone cropped to its bounding box touches all four borders too, but has not the corners,
    # or nothing inside it.
    if corners < 3 or not all(side.mean() > 0.5 for side in sides):
        return
    found, _ = ndimage.label(index != common)
    inside = np.bincount(found.ravel())
    for line in (0, found[0], found[-1], found[:, 0], found[:, -1]):
        inside[line] = 0
    if inside.max() >= RARE_PX:
        raise LabelImageError(
            "E105",
            f"the value {value} fills {(index == common).mean():.0%} of the picture and its "
            f"borders: it looks like the background, which is {background} by the settings.",
            cure=f"{cure.format(value)}; if it is a stone, give the picture a rim of {background}.",
        )


def check_not_lossy(image: IdImage) -> None:
    """Refuse JPEG: it changes values, so ids are lost (E101), or it is a photo (E102)."""
    ids, brightness = image.census, image.ids if image.brightness is None else image.brightness
    # In JPEG labels .4 ... .95 of all neighbours are equal, in photos less than .2 (measured).
    equal = brightness[:, :-1] == brightness[:, 1:]
    if equal.size and len(ids.values) > _MANY_VALUES and equal.mean() < _PLAIN_SHARE_LOSSY:
        raise _photo(ids)
    rare = int((ids.counts < RARE_PX).sum())
    # Areas that were of one value before compression blurred them.
    level = brightness.astype(np.int32)
    spread = ndimage.maximum_filter(level, 3) - ndimage.minimum_filter(level, 3)
    background = int(np.bincount(level.ravel()).argmax())
    areas, found = ndimage.label((spread <= 16) & (np.abs(level - background) > 16))
    plain = int((np.bincount(areas.ravel(), minlength=found + 1)[1:] >= RARE_PX).sum())
    guess = f" Its plain areas look like {plain} stones." if plain else ""
    raise LabelImageError(
        "E101",
        f"JPEG is lossy: {len(ids.values)} values, {rare} of them on less than {RARE_PX} px, "
        f"so ids are lost.{guess}",
        cure=f"{_CLEAN_EXPORT} As stones, a black-and-white mask can be read with --mask "
        "(mask=True in Python). If it is a photograph, find the stones in it with "
        "`drystone segment PHOTO`.",
    )


def check_not_photo(census: Census) -> None:
    """Refuse a picture whose neighbouring pixels mostly differ (E102)."""
    if _is_photo(census):
        raise _photo(census)


def _is_photo(census: Census) -> bool:
    """Tell a picture whose neighbouring pixels mostly differ.

    Measured on pairs of neighbours of which one is not the most frequent value: in stones wider
    than 3 px most of them are equal, in photos few are.
    """
    if len(census.values) <= _MANY_VALUES:
        return False
    left, right = census.index[:, :-1], census.index[:, 1:]
    common = int(np.argmax(census.counts)) + 1
    pairs = (left != common) | (right != common)
    equal = int(((left == right) & pairs).sum())
    return equal < _PLAIN_SHARE * int(pairs.sum())


def cut_out(image: IdImage) -> IdImage:
    """Return the mask by which a photograph was cut out, which is its alpha, and say so (W135)."""
    alpha = image.alpha
    if alpha is None or not alpha.any() or not _is_photo(image.census):
        return image
    top = int(alpha.max())
    clear, full = np.count_nonzero(alpha <= top // 8), np.count_nonzero(alpha >= top - top // 8)
    mask = alpha > top // 2
    hull = shapely.Polygon(pixel_hull(mask))
    corners = shapely.get_num_points(shapely.simplify(hull.exterior, _STRAIGHT_PX))
    solid = np.count_nonzero(mask) >= hull.area - hull.length
    turned = solid and corners <= 6 and hull.length >= _TURNED_PX
    # Nor a window with round corners, nor one that fades away.
    if turned or clear < _CLEAR_SHARE * alpha.size or alpha.size - clear > 2 * full:
        return image
    what = "what can be seen has the colours of a photograph: alpha was read in place of them."
    cure = "Give a label image where stones touch, and a photograph with ground to `segment`."
    return IdImage(mask.view(np.uint8), 0, notices=(*image.said, Notice("W135", what, cure)))


def _photo(census: Census) -> LabelImageError:
    return LabelImageError(
        "E102",
        f"this looks like a photo ({len(census.values):,} colours, few of them in plain areas).",
        cure="Find the stones in it with `drystone segment PHOTO`, or give a label image: one id "
        "a stone, 0 where there is none, as PNG or TIFF.",
    )


def blended(census: Census, chosen: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """Tell which chosen pixels, (h, w), lie strictly between darker and brighter ones 2 px around.

    That is what anti-aliasing, blur and interpolation leave at edges; a small stone on plain
    background is the extreme of its surroundings.  The answer is in the order of
    ``np.nonzero(chosen)``.
    """
    here = census.index[chosen]
    if 8 * here.size > chosen.size:
        low = ndimage.minimum_filter(census.index, 5)[chosen]
        high = ndimage.maximum_filter(census.index, 5)[chosen]
        return np.asarray((low < here) & (here < high))
    rows, cols = np.nonzero(chosen)
    low, high = here.copy(), here.copy()
    bottom, right = chosen.shape[0] - 1, chosen.shape[1] - 1
    for down, across in np.ndindex(5, 5):
        near = np.clip(rows + down - 2, 0, bottom), np.clip(cols + across - 2, 0, right)
        np.minimum(low, census.index[near], out=low)
        np.maximum(high, census.index[near], out=high)
    return np.asarray((low < here) & (here < high))


def check_not_resampled(image: IdImage) -> None:
    """Refuse labels that were blurred, anti-aliased or scaled by interpolation (E101)."""
    _check_no_values_of_edges(image)
    _check_no_edges_of_others(image)


def _check_no_values_of_edges(image: IdImage) -> None:
    """Refuse values that are there at the edges of stones only."""
    census = image.census
    if len(census.values) <= 20:
        return
    plain = np.zeros(len(census.values) + 1, bool)
    plain[census.index[census.solid]] = True
    thin = ~plain[1:]
    # A few pixels are noise, and not the edges of stones.
    few = 0.1 * np.count_nonzero(~census.solid & image.stones)
    if 2 * thin.sum() <= plain.sum() or census.counts[thin].sum() <= few:
        return
    if blended(census, census.of(thin)).mean() >= _BLENDED_SHARE:
        raise _resampled(
            f"{len(census.values)} values, {int(thin.sum())} of them in edges only; about "
            f"{max(0, int(plain.sum()) - 1)} are stones."
        )


def _check_no_edges_of_others(image: IdImage) -> None:
    """Refuse edges in the ids of other stones: blending leaves them where ids are dense."""
    census = image.census
    if len(census.values) < _FEW_VALUES:
        return
    # Joints between stones may be thin, and of any value.
    of_stones = image.stones
    astray = astray_px(census) & of_stones
    outline = int((~census.solid & of_stones)[1:-1, 1:-1].sum())
    if int(astray.sum()) < _ASTRAY_SHARE * outline:
        return
    between = int(blended(census, astray).sum())
    if between >= max(1.0, _ASTRAY_SHARE * outline):
        raise _resampled(
            f"{between} of {outline} px there have a value between those on either side, which is "
            "the id of another stone."
        )


def _resampled(why: str) -> LabelImageError:
    cure = f"{_CLEAN_EXPORT} Scale label images by nearest neighbour."
    return LabelImageError("E101", f"the ids were blended at the edges of stones: {why}", cure=cure)


def astray_px(census: Census) -> NDArray[np.bool_]:
    """Tell which pixels neither lie in 3 x 3 px of their value nor touch such; not on the rim."""
    wide = census.solid.copy()
    wide[1:] |= census.solid[:-1]
    wide[:-1] |= census.solid[1:]
    core = wide.copy()
    core[:, 1:] |= wide[:, :-1]
    core[:, :-1] |= wide[:, 1:]
    rows, cols = np.nonzero(~core[1:-1, 1:-1])
    here = census.index[rows + 1, cols + 1]
    lone = np.ones(len(here), bool)
    for row, col in np.ndindex(3, 3):
        near = rows + row, cols + col
        lone &= ~core[near] | (census.index[near] != here)
    astray = np.zeros_like(core)
    astray[rows[lone] + 1, cols[lone] + 1] = True
    return astray


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


def without_net(image: IdImage, *, wall: bool = False) -> IdImage:
    """Make a value background that is a net of edges around stones, and say so (W135)."""
    census = image.census
    net = _net(census, image.background)
    if net is None:
        return image
    value = int(census.values[net])
    count = int(census.counts[net])
    what = f"the value {value} ({count} px) is a net of edges around stones: read as background."
    cure = "Use --no-mask (mask=False in Python) to keep it as a stone."
    if wall:
        cure = "If it is of stone, draw its parts in ids of their own."
    ids = np.where(census.index == net + 1, image.background, image.ids).astype(image.ids.dtype)
    notices = (*image.notices, Notice("W135", what, cure))
    return replace(image, ids=ids, brightness=None, notices=notices)


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
        found, _ = ndimage.label(census.of(stones))
        count = int((np.bincount(found.ravel())[1:] >= RARE_PX).sum())
        if count >= (1 if int(census.values[net]) in _VOID else 3):
            return int(net)
    return None


def without_blends(image: IdImage, least_px: int, *, wall: bool = False) -> IdImage:
    """Give few blended pixels at edges to the stones or the ground that they touch most (W136).

    Pieces of fewer than `least_px` are no stones.  Nothing is done where so many pixels are blended
    that stones could change.
    """
    census = image.census
    stray = _stray(census, image.background, least_px, wall=wall)
    if stray is None:
        return image
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
    return replace(image, ids=ids, brightness=None, notices=notices)


def _stray(
    census: Census, background: int, least_px: int, *, wall: bool
) -> NDArray[np.bool_] | None:
    """Return the pixels of small pieces at stones whose values were blended; None for no few."""
    core = np.zeros(len(census.values) + 1, bool)
    core[census.index[census.solid]] = True
    ground = census.values == background
    thin, stones = ~core[1:] & ~ground, ~census.of(ground)
    lone = census.of(thin) | (astray_px(census) & stones)
    if not core.any() or not lone.any():
        return None
    runs = label_runs(census.index)
    pieces = runs_in_pieces(runs)
    small = (np.bincount(pieces, runs.lengths) < least_px)[pieces]
    stray = lone & np.repeat(small, runs.lengths).reshape(lone.shape)
    sure = blended(census, stray)
    stray[stray] = sure if wall else sure | thin[census.index[stray] - 1]
    # What lies on the ground alone is a speck.
    at_stone = stray & ndimage.maximum_filter(stones & ~stray, 3)
    found, _ = components(stray)
    stray &= np.isin(found, found[at_stone])
    edges = np.count_nonzero(stones & ~census.solid)
    return stray if 0 < np.count_nonzero(stray) <= _FEW * edges else None


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
