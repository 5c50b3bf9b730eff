"""Pictures that are no label images are told apart and refused (users' table of bad input)."""

from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage

from drystone.errors import InputError, LabelImageError
from drystone.io.json_text import json_in
from drystone.io.labels import Census, IdImage
from drystone.kernels.ids import counted

RARE_PX = 10
_MANY_VALUES = 64
_PLAIN_SHARE = 0.5
_PLAIN_SHARE_LOSSY = 0.3
_BLENDED_SHARE = 0.5
"""Measured on published labels scaled or blurred: .57 (bicubic, which overshoots) ... 1."""
_FEW_VALUES = 8
_ASTRAY_SHARE = 0.2
"""Measured on ids 1 ... 9 and 1 ... 30 of bricks and round stones: .15 ... .6 of the outlines when
scaled or blurred, .00 before; .13 in touching stones that are 5 px wide.  A stone set that is
refused without reason has no cure, so the limit keeps clear of those."""

_CLEAN_EXPORT = "Export the ids as PNG or TIFF, without anti-aliasing or resampling."


def check_no_plan(folder: Path) -> None:
    """Refuse the folder of a plan (E113), whose pictures are no masks of stones."""
    try:
        content = json_in(folder / "plan.json")
    except (OSError, ValueError):
        return
    if isinstance(content, dict) and "steps" in content and "source" in content:
        cure = "Give the stones, or use it with --from."
        raise InputError("E113", "this folder is a plan, made of stones already.", cure=cure)


def check_not_uniform(census: Census, background: int, why: str = "") -> None:
    """Refuse a picture of one value (E104); `why` says what became background."""
    if len(census.values) > 1:
        return
    value = int(census.values[0])
    height, width = census.index.shape
    what = f"no stones: all {width} x {height} px are {value}"
    if value == background:
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
    if corners >= 3 and all(side.mean() > 0.5 for side in sides) and _has_islands(index, common):
        raise LabelImageError(
            "E105",
            f"the value {value} fills {(index == common).mean():.0%} of the picture and its "
            f"borders: it looks like the background, which is {background} by the settings.",
            cure=f"{cure.format(value)}; if it is a stone, give the picture a rim of {background}.",
        )


def _has_islands(index: NDArray[Any], common: int) -> bool:
    """Tell whether anything as large as a stone lies inside a value and off the borders."""
    found, _ = ndimage.label(index != common)
    areas = np.bincount(found.ravel())
    for line in (found[0], found[-1], found[:, 0], found[:, -1]):
        areas[line] = 0
    areas[0] = 0
    return bool(areas.max() >= RARE_PX)


def check_not_lossy(ids: Census, image: IdImage) -> None:
    """Refuse JPEG: it changes values, so ids are lost (E101), or it is a photo (E102)."""
    brightness = image.ids if image.brightness is None else image.brightness
    # In JPEG labels .4 ... .95 of all neighbours are equal, in photos less than .2 (measured).
    equal = brightness[:, :-1] == brightness[:, 1:]
    if equal.size and len(ids.values) > _MANY_VALUES and equal.mean() < _PLAIN_SHARE_LOSSY:
        raise _photo(ids)
    rare = int((ids.counts < RARE_PX).sum())
    plain = _plain_areas(brightness)
    guess = f" Its plain areas look like {plain} stones." if plain else ""
    raise LabelImageError(
        "E101",
        f"JPEG is lossy: {len(ids.values)} values, {rare} of them on less than {RARE_PX} px, "
        f"so ids are lost.{guess}",
        cure=f"{_CLEAN_EXPORT} As stones, a black-and-white mask can be read with --mask "
        "(mask=True in Python). If it is a photograph, find the stones in it with "
        "`drystone segment PHOTO`.",
    )


def _plain_areas(brightness: NDArray[Any]) -> int:
    """Count areas that were of one value before compression blurred them: a guess."""
    level = brightness.astype(np.int32)
    spread = ndimage.maximum_filter(level, 3) - ndimage.minimum_filter(level, 3)
    background = int(np.bincount(level.ravel()).argmax())
    plain, found = ndimage.label((spread <= 16) & (np.abs(level - background) > 16))
    return int((np.bincount(plain.ravel(), minlength=found + 1)[1:] >= RARE_PX).sum())


def check_not_photo(census: Census) -> None:
    """Refuse a picture whose neighbouring pixels mostly differ (E102).

    Measured on pairs of neighbours of which one is not the most frequent value: in stones wider
    than 3 px most of them are equal, in photos few are.
    """
    if len(census.values) <= _MANY_VALUES:
        return
    left, right, common = census.index[:, :-1], census.index[:, 1:], census.commonest + 1
    pairs = (left != common) | (right != common)
    equal = int(((left == right) & pairs).sum())
    if equal < _PLAIN_SHARE * int(pairs.sum()):
        raise _photo(census)


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


def check_not_resampled(census: Census, background: int) -> None:
    """Refuse labels that were blurred, anti-aliased or scaled by interpolation (E101)."""
    _check_no_values_of_edges(census, background)
    _check_no_edges_of_others(census, background)


def _check_no_values_of_edges(census: Census, background: int) -> None:
    """Refuse values that are there at the edges of stones only."""
    if len(census.values) <= 20:
        return
    plain = np.zeros(len(census.values) + 1, bool)
    plain[census.index[census.solid]] = True
    thin = ~plain[1:]
    # A few pixels are noise, and not the edges of stones.
    few = 0.1 * np.count_nonzero(~census.solid & ~census.pixels(census.values == background))
    if 2 * thin.sum() <= plain.sum() or census.counts[thin].sum() <= few:
        return
    if blended(census, census.pixels(thin)).mean() >= _BLENDED_SHARE:
        raise LabelImageError(
            "E101",
            f"the ids were blended at the edges of stones: {len(census.values)} values, "
            f"{int(thin.sum())} of them in edges only; about {max(0, int(plain.sum()) - 1)} are "
            "stones.",
            cure=f"{_CLEAN_EXPORT} Scale label images by nearest neighbour.",
        )


def _check_no_edges_of_others(census: Census, background: int) -> None:
    """Refuse edges in the ids of other stones: blending leaves them where ids are dense."""
    if len(census.values) < _FEW_VALUES:
        return
    # Joints between stones may be thin, and of any value.
    of_stones = ~census.pixels(census.values == background)
    astray = astray_px(census) & of_stones
    outline = int((~census.solid & of_stones)[1:-1, 1:-1].sum())
    if int(astray.sum()) < _ASTRAY_SHARE * outline:
        return
    between = int(blended(census, astray).sum())
    if between >= max(1.0, _ASTRAY_SHARE * outline):
        raise LabelImageError(
            "E101",
            f"the ids were blended at the edges of stones: {between} of {outline} px there have "
            "a value between those on either side, which is the id of another stone.",
            cure=f"{_CLEAN_EXPORT} Scale label images by nearest neighbour.",
        )


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
