"""Stones cut out of label images, with their holes and pieces put in order."""

import math
from collections.abc import Collection, Iterator, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from itertools import accumulate, chain
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage

from drystone.errors import LabelImageError, Notice
from drystone.io.files import MANY, listed, naming, short
from drystone.io.labels import MAX_ID, components
from drystone.io.read_settings import ReadSettings
from drystone.kernels.ids import counted
from drystone.kernels.polygons import Points
from drystone.kernels.raster import Mask
from drystone.model.outline import is_outline_of, solid
from drystone.model.stone import Source, Stone, StoneSet

SMALL_SHARE = 0.02
"""Pieces that together are less than this share of their stone are left out by default."""

MIN_AREA_PX = 10
_MOST_SPECK_PX = 50
"""Of a mask; the authors of the published pictures skip regions of less than 50 px."""

LARGE = 1.5
"""Times the median area: smaller stones are not suspected of being two."""

MOST_PIECES = 100_000
"""Of all stones of a picture: more are no stones but noise, and fill the memory."""

_WAIST = 1.6
"""Both parts must be this many times as thick as the neck between them."""

_PART_SHARE = 0.15
"""Each part must have this share of the stone."""


@dataclass(frozen=True, eq=False)
class PlacedMask:
    """Pixels at a place of a picture."""

    mask: Mask  # (h, w), row 0 at the top
    row: int
    col: int  # of its upper left pixel

    @property
    def sides(self) -> tuple[int, int, int, int]:
        """First row and column, and those after the last."""
        height, width = self.mask.shape
        return self.row, self.col, self.row + height, self.col + width

    def shared(self, other: "PlacedMask") -> tuple[Mask, Mask]:
        """Return the views of both masks on the box that they share."""
        low = np.maximum(self.sides[:2], other.sides[:2])
        high = np.maximum(low, np.minimum(self.sides[2:], other.sides[2:]))
        (top, left), (bottom, right) = low.tolist(), high.tolist()
        one, two = (
            m.mask[top - m.row : bottom - m.row, left - m.col : right - m.col]
            for m in (self, other)
        )
        return one, two

    def common_px(self, other: "PlacedMask") -> int:
        """Return the number of pixels that two masks share."""
        one, two = self.shared(other)
        return int((one & two).sum())


@dataclass(frozen=True, eq=False)
class StonePatch(PlacedMask):
    """The pixels of one id, within their bounding box, before they are a stone."""

    id: int  # positive
    picture_height: int  # px
    others: Mask | None = None  # (h, w), pixels of the box that belong to other stones
    name: str = ""  # file name of a one-stone mask
    drawn: Points | None = None  # (n, 2), the outline in the picture, px, y down

    @cached_property
    def area_px(self) -> int:
        """Number of pixels."""
        return int(self.mask.sum())

    @cached_property
    def piece_areas_px(self) -> tuple[int, ...]:
        """Number of pixels of each 8-connected piece, in row order."""
        found, count = components(self.mask)
        areas = counted(found, count)[1:]
        with naming(str(self)):
            check_count(len(areas))
        return tuple(areas.tolist())

    def pieces(self) -> list["StonePatch"]:
        """Return the 8-connected pieces, the largest first, equal ones in row order."""
        if len(self.piece_areas_px) == 1:
            return [self]
        found, _ = components(self.mask)
        pieces = []
        for label, (rows, cols) in enumerate(ndimage.find_objects(found), start=1):
            mask, row, col = found[rows, cols] == label, rows.start, cols.start
            place = {"row": self.row + row, "col": self.col + col}
            pieces.append(replace(self, mask=mask, **place, others=None, drawn=None))
        return sorted(pieces, key=lambda piece: -piece.area_px)

    def __str__(self) -> str:
        return f"{self.id} ({short(self.name)})" if self.name else str(self.id)

    def to_stone(self) -> Stone:
        """Make the stone, in the frame of the picture (y up from its bottom edge)."""
        end = self.row + self.mask.shape[0]
        bottom, corner = self.picture_height - end, np.array((self.col, end))
        drawn = None if self.drawn is None else (self.drawn - corner) * (1.0, -1.0)
        # Of an outline that crosses itself the edge of its largest part was drawn.
        if drawn is not None and not is_outline_of(drawn, solid(self.mask)):
            drawn = None
        return Stone(self.id, self.mask, self.col, bottom, self.name, drawn)


def check_count(count: int) -> None:
    """Refuse more pieces than a picture of stones can have (E110)."""
    if count > MOST_PIECES:
        what = f"there are more than {MOST_PIECES} pieces of stones: this looks like noise."
        cure = "Clean the picture (a median filter takes out specks), or crop it."
        raise LabelImageError("E110", what, cure=cure)


def cut(
    index: NDArray[Any], ids: NDArray[np.int64], name: str = "", skip: Sequence[int] = ()
) -> list[StonePatch]:
    """Cut every id out of an image, each looked at within its bounding box only.

    `index`, (h, w), has positions from 1 in `ids`; an index of 0 and an id of 0 are background.
    What is skipped is cut out as well, but is no other stone.
    """
    stone = np.concatenate(([False], ids != 0))
    other = stone & ~np.isin(np.concatenate(([0], ids)), skip)
    patches = []
    for position, window in enumerate(ndimage.find_objects(index), start=1):
        if window is None or not stone[position]:
            continue
        inside = index[window]
        mask = inside == position
        others = other[inside] & ~mask
        row, col = window[0].start, window[1].start
        patches.append(StonePatch(mask, row, col, int(ids[position - 1]), len(index), others, name))
    return patches


def stone_set(
    found: Sequence[StonePatch],
    notices: Sequence[Notice],
    source: Source,
    settings: ReadSettings,
    taken: Collection[int] = (),
    larger: str = "",
) -> StoneSet:
    """Put patches in order and make stones of them; every decision becomes a notice.

    Numbers `taken` are those of the file, also of what is left out; `larger` is how to read it so
    that none is too small.
    """
    for pieces_so_far in accumulate(len(patch.piece_areas_px) for patch in found):
        check_count(pieces_so_far)
    numbers = piece_numbers(found, settings, taken)
    known = {patch.id for patch in found}.union(*numbers.values())
    skip = set(settings.skip)
    noticed = list(notices)
    for what, ids in (("skip", skip), ("keep", set(settings.keep))):
        if unknown := sorted(ids - known):
            text = f"no stone {listed(unknown)} to {what}."
            noticed.append(Notice("W116", text, "Check the ids."))
    # One of several numbers stays until it is split.
    patches = [p for p in found if not {p.id, *numbers.get(p.id, ())} <= skip]
    # What is split must not depend on what is skipped.
    limit_px = smallest_stone_px(found if settings.pieces == "split" else patches, settings)
    patches, specks = _without_specks(patches, limit_px)
    patches, holes = _filled(patches, settings)
    patches, pieces = _in_one_piece(patches, settings, numbers)
    patches, bits = _without_specks(patches, limit_px)
    if not patches:
        why = " ".join(notice.message for notice in specks or (() if known else notices))
        why = why or ("all were skipped." if known else "none has a pixel.")
        cure = (
            "Check the picture, and what --min-area and --skip (min_area_px and skip in Python) "
            "leave out."
        )
        cure = larger + cure if specks or not known else cure
        raise LabelImageError("E104", f"no stones are left: {why}", cure=cure)
    noticed += [*specks, *holes, *pieces, *bits, *_suspect_necks(patches)]
    return StoneSet(tuple(patch.to_stone() for patch in patches), source, tuple(noticed))


def smallest_stone_px(
    patches: Sequence[StonePatch], settings: ReadSettings, *, mask: bool = False
) -> float:
    """Return the area from which a patch is a stone: max(10 px, 0.1 % of the median area).

    The components of a mask have no ids that somebody gave them: they are specks up to 1 % of the
    median area, and no more than 50 px.
    """
    if settings.min_area_px is not None:
        return settings.min_area_px
    areas = [patch.area_px for patch in patches if patch.area_px >= MIN_AREA_PX]
    median = float(np.median(areas)) if areas else 0.0
    return max(MIN_AREA_PX, 0.001 * median, min(_MOST_SPECK_PX, 0.01 * median) if mask else 0.0)


def _without_specks(
    patches: Sequence[StonePatch], limit_px: float
) -> tuple[list[StonePatch], list[Notice]]:
    """Leave out patches whose largest piece is smaller than a stone can be, and list them."""
    kept: list[StonePatch] = []
    specks: list[StonePatch] = []
    for patch in patches:
        largest_px = max(patch.piece_areas_px, default=0)
        (kept if largest_px >= limit_px else specks).append(patch)
    if not specks:
        return kept, []
    places = (f"{s} of {s.area_px} px at column {s.col}, row {s.row}" for s in specks)
    total = sum(speck.area_px for speck in specks)
    what = "1 speck" if len(specks) == 1 else f"{len(specks)} specks"
    message = f"{what} < {limit_px:g} px left out ({total} px in all)"
    cure = "Use --min-area PX (min_area_px in Python) to keep smaller stones."
    return kept, [Notice("W113", f"{message}: {listed(places, most=MANY)}.", cure)]


def _filled(
    patches: list[StonePatch], settings: ReadSettings
) -> tuple[list[StonePatch], list[Notice]]:
    """Fill the holes of all patches (or only report them, ``holes="keep"``)."""
    keep = settings.holes == "keep"
    result, found = [], []
    for patch in patches:
        holes = enclosed(patch.mask)
        count = int(holes.sum())
        if count:
            taken = 0 if patch.others is None else int((holes & patch.others).sum())
            shared = f", {taken} px of them other stones'" if taken else ""
            found.append(f"stone {patch}: {count} px{shared}")
        result.append(replace(patch, mask=patch.mask | holes) if count and not keep else patch)
    if not found:
        return result, []
    if keep:
        text = "holes kept open (areas and centroids without them; outlines as if filled)"
        return result, [Notice("W112", f"{text}: {listed(found, '; ', MANY)}.")]
    cure = "Use --holes keep (holes='keep' in Python) to leave them open."
    return result, [Notice("W112", f"holes filled: {listed(found, '; ', MANY)}.", cure)]


def free_numbers(used: Collection[int]) -> Iterator[int]:
    """Return those that follow the largest one used; where ids end, the free ones from 1."""
    numbers = chain(range(max(used, default=0) + 1, MAX_ID + 1), range(1, MAX_ID + 1))
    return (number for number in numbers if number not in used)


def piece_numbers(
    patches: Sequence[StonePatch], settings: ReadSettings, taken: Collection[int] = ()
) -> dict[int, list[int]]:
    """Return the ids of the further pieces of every patch that is split.

    They come after the largest id, also of those `taken` by what is left out, whatever is skipped.
    """
    if settings.pieces != "split" or not patches:
        return {}
    stones, _ = _without_specks(patches, smallest_stone_px(patches, settings))
    whole, _ = _filled(stones, settings)
    free = free_numbers({patch.id for patch in patches}.union(taken))
    several = ((patch.id, patch.piece_areas_px[1:]) for patch in whole)
    return {own: [next(free) for _ in further] for own, further in several if further}


def _in_one_piece(
    patches: list[StonePatch], settings: ReadSettings, numbers: dict[int, list[int]]
) -> tuple[list[StonePatch], list[Notice]]:
    """Leave every stone one 8-connected piece; pieces that become stones are skipped here."""
    result, refused, dropped, made = [], [], [], []
    new: list[StonePatch] = []
    for patch in patches:
        largest, *further = pieces = patch.pieces()
        result.append(largest)
        if not further:
            continue
        large = sum(piece.area_px for piece in further) >= SMALL_SHARE * patch.area_px
        if settings.pieces == "error" or (settings.pieces == "auto" and large):
            refused.append(_describe(patch, pieces))
        dropped.append(_describe(patch, further))
        if settings.pieces == "split":
            both = zip(further, numbers[patch.id], strict=True)
            own = [replace(p, id=number) for p, number in both if number not in settings.skip]
            new += own
            if own:
                made.append(f"stone {patch}: {listed(f'{p.id} ({p.area_px} px)' for p in own)}")
    if refused:
        raise LabelImageError(
            "E103",
            f"{len(refused)} stones are in several pieces: {listed(refused, '; ')}.",
            cure="Correct the picture, or choose --pieces keep-largest (leave the others out) or "
            "--pieces split (each piece a stone); in Python pieces='keep-largest' or "
            "pieces='split'.",
        )
    if not dropped:
        return result, []
    if settings.pieces == "split":
        kept = [patch for patch in result if patch.id not in settings.skip] + new
        text = f"pieces became stones of their own: {listed(made, '; ', MANY)}."
        return kept, [Notice("W111", text)] if new else []
    cure = "Use --pieces split (pieces='split' in Python) to make them stones."
    text = f"smaller pieces left out: {listed(dropped, '; ', MANY)}."
    return result, [Notice("W111", text, cure)]


def _describe(patch: StonePatch, pieces: list[StonePatch]) -> str:
    places = listed(f"{p.area_px} px at column {p.col}, row {p.row}" for p in pieces)
    return f"stone {patch}: {places}"


def _suspect_necks(patches: list[StonePatch]) -> list[Notice]:
    """Report large stones with a neck; of one or two stones every one, as no size is usual."""
    median = float(np.median([patch.area_px for patch in patches]))
    notices = []
    for patch in patches:
        ratio = patch.area_px / median
        if len(patches) > 2 and ratio < LARGE:
            continue
        width = neck_width_px(patch.mask)
        if width is not None:
            size = f"has {ratio:.1f} times the median area and " if len(patches) > 2 else "has "
            neck = f"a neck of about {width} px" if width else "parts that meet at a corner only"
            message = f"stone {patch} {size}{neck}: maybe 2 stones."
            cure = "If so, separate them by a line of background or give each its own id."
            notices.append(Notice("W110", message, cure))
    return notices


def enclosed(mask: Mask) -> Mask:
    """Return the pixels that no 4-connected way around the mask reaches: its holes."""
    # The way around it comes first, from the corner of the frame.
    around, _ = ndimage.label(np.pad(~mask, 1, constant_values=True))
    return np.asarray(around[1:-1, 1:-1] > 1)


def neck_width_px(mask: Mask, most_px: int = 2**17) -> int | None:
    """Return the width of the neck between two thick parts of a mask; None without one.

    A width of 0 means that the parts meet at a corner of pixels only.  A mask of more than
    `most_px` is looked at in a coarser picture.  There a neck that is thinner than one of its
    pixels counts as one of them.

    The neck is the smallest erosion that leaves two parts, each thicker than the neck by a
    factor 1.6 and with at least 15 % of what the erosion leaves.
    """
    step = math.ceil(math.sqrt(mask.size / most_px))
    depth = ndimage.distance_transform_edt(np.pad(mask[::step, ::step], 1))
    most = int(depth.max() / _WAIST) + 1 if depth.max() >= 2 * _WAIST else 0
    for erosion in range(most):
        parts, count = ndimage.label(depth > erosion)
        areas = np.bincount(parts.ravel())[1:]
        thickness = ndimage.maximum(depth, parts, np.arange(1, count + 1))
        apart = (thickness >= _WAIST * max(erosion, 1)) & (areas >= _PART_SHARE * areas.sum())
        if np.count_nonzero(apart) > 1:
            return max(2 * step * erosion, step if step > 1 else 0)
    return None
