"""What a person should look at before building with stones from a photograph."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray
from skimage.measure import regionprops

from drystone.errors import Notice
from drystone.model.stone_size import sizes_of
from drystone.photo.segment import EDGE, FAINT, PAPER, PLAIN, VARIED, FoundStones, stones_at

_LOW_CONTRAST = 8.0
"""Distance in CIELAB from the ground below which an outline is not to be relied on."""
_SURELY_TWO = 0.45
"""Necks narrower than this share of the stone are cut without a word."""
_HOLLOW = 0.87
"""Share of its convex hull that a stone fills; less may be two stones with a broad contact."""
_UNUSUAL = 6.0
"""Stones so many times larger or smaller than the median are reported."""
_RULED = 0.8
"""Share of the line of a ruler along which one stone lies that may be the ruler itself."""
LISTED = 8
"""Shapes that were left out and that a notice names."""

_LITTLE, _VERY_LITTLE = 0.05, 0.01
"""Shares of the photograph that are stone, least on varied ground and on any."""
_UNEVEN = 0.85
"""How much darker the darkest place of the ground is lit: beyond, stones there get lost."""
_LEFT_OUT, _LEFT_OUT_SHARE = 2.0, 0.1
"""What was left out over what was found, and over the photograph, that is more than some stones."""
_FAINT_SHARE = 0.25
"""What hardly differs from the ground over what was found: beyond, stones may be missed."""
_FEW = 3
"""So many stones are looked at one by one."""


@dataclass(frozen=True)
class Doubt:
    """Something that may be wrong."""

    # W175 neck, W176 left out at the edge or a marker, W177 shadow, W178 low contrast, W179
    # unusual size or a ruler, W182 left out for another reason.
    code: str
    stones: tuple[int, ...]  # empty when it is none of them
    at_px: tuple[float, float]  # column and row of the label image
    text: str

    @property
    def sentence(self) -> str:
        """What may be wrong, in a sentence of its own."""
        kind = "" if self.code in ("W175", "W179") else f"{_KINDS[self.code][0]}: "
        said = f"{kind}{self.text}."
        return f"{said[0].upper()}{said[1:]}"


def doubts_of(found: FoundStones, px_per_m: float | None = None) -> tuple[Doubt, ...]:
    """Return what is in doubt, stone by stone."""
    sizes = sizes_of(found.labels)
    at = {size.id: size.at_px for size in sizes}
    doubts = _necks(found, px_per_m)
    known = {stone for doubt in doubts for stone in doubt.stones}
    for region in regionprops(found.labels):
        stone = int(region.label)
        if stone not in known and float(region.solidity) < _HOLLOW:
            text = f"stone {stone} at {_place(at[stone])} has a hollow outline"
            doubts.append(Doubt("W175", (stone,), at[stone], f"{text}: it may be two stones"))
    for one in found.left_out:
        text = f"{one.area_px} px at ({one.at_px[0]:.0f}, {one.at_px[1]:.0f}), {one.why}"
        doubts.append(Doubt("W176" if one.why in (EDGE, PAPER) else "W182", (), one.at_px, text))
    faint = [one for one, value in enumerate(found.contrast, start=1) if value < _LOW_CONTRAST]
    doubts += [
        Doubt(code, (stone,), at[stone], f"stone {stone} at {_place(at[stone])}")
        for code, stones in (("W177", found.shaded), ("W178", faint))
        for stone in stones
    ]
    usual = float(np.median([size.area_px for size in sizes]))
    for size in sizes:
        times = size.area_px / usual
        if not 1 / _UNUSUAL < times < _UNUSUAL:
            large = f"{times:.2g} times as large as usual"
            doubts.append(Doubt("W179", (size.id,), size.at_px, f"stone {size.id}: {large}"))
    return tuple(doubts)


def ruler_doubts(labels: NDArray[np.uint16], ends_px: ArrayLike) -> tuple[Doubt, ...]:
    """Return what lies where a length was measured: the ruler may have been taken for a stone.

    `labels` are (h, w), `ends_px` two rows of column and row.
    """
    one, other = np.array(ends_px)
    length = float(np.hypot(*(other - one)))
    steps = np.linspace(0.0, 1.0, max(2, round(length)))[:, None]
    # People point at the marks of a ruler, which are at its border.
    across = np.array([one[1] - other[1], other[0] - one[0]]) / max(length, 1.0)
    beside = max(3.0, 0.02 * length)
    along: dict[int, NDArray[np.bool_]] = {}
    for off in (-beside, 0.0, beside):
        place = np.floor(one + steps * (other - one) + off * across).astype(int)
        cols, rows = (np.clip(place[:, k], 0, labels.shape[1 - k] - 1) for k in (0, 1))
        there = labels[rows, cols]
        for stone in np.unique(there[there > 0]).tolist():
            along[stone] = along.get(stone, np.zeros(len(there), bool)) | (there == stone)
    x, y = ((one + other) / 2).tolist()
    ruled = sorted(stone for stone, hit in along.items() if hit.mean() >= _RULED)
    said = "lies along --ruler and may be the ruler"
    return tuple(Doubt("W179", (stone,), (x, y), f"stone {stone} {said}") for stone in ruled)


def notices_of(doubts: Iterable[Doubt]) -> tuple[Notice, ...]:
    """Return the doubts as notices, one of each kind."""
    texts: dict[str, list[str]] = {}
    for doubt in doubts:
        texts.setdefault(doubt.code, []).append(doubt.text)
    # Of many shapes that were left out the largest are named, as stones.json has all.
    if more := texts.get("W182", [])[LISTED:]:
        texts["W182"][LISTED:] = [f"and {len(more)} more in stones.json"]
    return tuple(
        Notice(code, f"{_KINDS[code][0]}: {'; '.join(said)}.", _KINDS[code][1])
        for code, said in sorted(texts.items())
    )


_KINDS = {
    "W175": ("necks and hollows", "Look at them in outlines.html, which cuts and merges them."),
    "W176": ("left out", "Photograph whole stones, clear of markers."),
    "W177": ("a part may be shadow", "Look at outlines.html; avoid hard light."),
    "W178": ("hardly differs from the ground", "Look at outlines.html; take another ground."),
    "W179": (
        "unusual",
        "If it is not one stone, correct it in outlines.html; --min-area leaves out small ones.",
    ),
    "W182": (
        "not taken for stones",
        "Is one of them a stone? Draw it in outlines.html; --min-area keeps smaller ones.",
    ),
}
"""What a code means, and the cure."""


def _necks(found: FoundStones, px_per_m: float | None) -> list[Doubt]:
    doubts = []
    for neck in found.necks:
        stones = tuple(stones_at(found.labels, neck.at_px))
        wide = f"{neck.width_px:.0f} px"
        if px_per_m is not None:
            wide = f"{100 * neck.width_px / px_per_m:.1f} cm"
        where = f"at {_place(neck.at_px)}, {wide} wide"
        if neck.cut and neck.share >= _SURELY_TWO and len(stones) > 1:
            names = " and ".join(str(stone) for stone in stones)
            text = f"stones {names} were cut apart {where}: they may be one stone"
        elif not neck.cut:
            text = f"stone {stones[0]} has a neck {where}: it may be two stones"
        else:
            continue
        doubts.append(Doubt("W175", stones, neck.at_px, text))
    return doubts


def _place(at_px: tuple[float, float]) -> str:
    return f"({at_px[0]:.0f}, {at_px[1]:.0f}) px"


def verdict_notices(reasons: Sequence[str]) -> tuple[Notice, ...]:
    """Return what speaks against all that was found as a notice; none without a reason."""
    cure = (
        "Look at outlines.html. Lay the stones apart on a plain sheet of another colour and "
        "photograph nothing else, or crop the photograph to it; masks of a river bed or a wall "
        "come from other programs (docs/photographs.md)."
    )
    return (Notice("W183", f"doubtful: {'; '.join(reasons)}.", cure),) if reasons else ()


def verdict_of(found: FoundStones, doubts: Iterable[Doubt] = ()) -> tuple[str, ...]:
    """Return what speaks against all that was found, by ground, shares, contrast and doubts.

    Where there is a reason, a person must look before anything is built of it.
    """
    areas = np.bincount(found.labels.ravel(), minlength=2)[1:]
    shown = found.labels.size
    stone = float(areas.sum()) / shown
    varies = float(found.ground.spread.max())
    contrast = float(np.median(found.contrast))
    reasons = []
    if contrast < PLAIN * varies:
        reasons.append(
            f"the ground is not plain (its colour varies by {varies:.0f}, and what was found "
            f"differs from it by {contrast:.0f}, in CIELAB)"
        )
    if found.ground.uneven > _UNEVEN:
        percent = 100 * (1 - found.ground.uneven)
        reasons.append(
            f"the light is very uneven (the darkest ground has {percent:.0f} % of the brightest)"
        )
    if found.sheet is not None:
        percent = 100 * float(areas[found.sheet - 1]) / shown
        reasons.append(
            f"stone {found.sheet} takes up {percent:.0f} % of the photograph and may be the sheet "
            "that the stones lie on"
        )
    if stone < (_LITTLE if varies > VARIED else _VERY_LITTLE):
        reasons.append(
            f"only {100 * stone:.2g} % of the photograph was taken for stones, which may be paint, "
            "dirt or light"
        )
    left_out = sum(one.area_px for one in found.left_out) / shown
    if left_out > max(_LEFT_OUT * stone, _LEFT_OUT_SHARE):
        reasons.append(
            f"{100 * left_out:.0f} % of the photograph differs from the ground and was left out, "
            f"{100 * stone:.0f} % was taken for stones"
        )
    faint = sum(one.area_px for one in found.left_out if one.why == FAINT) / shown
    if faint > _FAINT_SHARE * stone:
        reasons.append(
            f"{100 * faint:.0f} % of the photograph may be stones that hardly differ from the "
            f"ground, {100 * stone:.0f} % was taken for stones"
        )
    doubted = {one for doubt in doubts for one in doubt.stones}
    if found.count >= _FEW and len(doubted) > found.count / 2:
        reasons.append(f"{len(doubted)} of {found.count} stones are in doubt")
    return tuple(reasons)
