"""Stones cut out of label images, with their holes and pieces put in order."""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage

from drystone.errors import LabelImageError, Notice
from drystone.io.labels import MAX_ID
from drystone.io.listed import MANY, listed, short
from drystone.io.read_settings import Pieces, ReadSettings
from drystone.kernels.ids import counted
from drystone.kernels.label_runs import label_runs, runs_in_pieces
from drystone.kernels.raster import Mask
from drystone.model.stone import Stone

SMALL_SHARE = 0.02
"""Pieces that together are less than this share of their stone are left out by default."""

MIN_AREA_PX = 10
_LARGE_PX, _PLAIN_PX = 2**20, 64
"""From where pieces and holes are found on runs, and how many px there must be to a run."""
_WHOLE = np.ones((3, 3), bool)

MOST_PIECES = 100_000
"""Of all stones of a picture: more are no stones but noise, and fill the memory."""


@dataclass(frozen=True, eq=False)
class Patch:
    """The pixels of one id before they are a stone."""

    id: int  # positive
    mask: Mask  # (h, w), its pixels within its bounding box
    row: int  # upper left pixel of the box in its picture
    col: int  # upper left pixel of the box in its picture
    picture_height: int  # of the picture, px
    others: Mask | None = None  # (h, w), pixels of the box that belong to other stones
    name: str = ""  # file name of a one-stone mask

    @cached_property
    def area_px(self) -> int:
        """Number of pixels."""
        return int(self.mask.sum())

    @cached_property
    def piece_areas_px(self) -> tuple[int, ...]:
        """Number of pixels of each 8-connected piece, in row order."""
        if _is_plain(self.mask):
            runs = label_runs(self.mask.view(np.uint8))
            areas = np.bincount(runs_in_pieces(runs), runs.lengths).astype(int)
        else:
            found, count = ndimage.label(self.mask, _WHOLE)
            areas = counted(found, count)[1:]
        check_count(len(areas), str(self))
        return tuple(areas.tolist())

    def pieces(self) -> list["Patch"]:
        """Return the 8-connected pieces, the largest first, equal ones in row order."""
        if len(self.piece_areas_px) == 1:
            return [self]
        found, _ = ndimage.label(self.mask, _WHOLE)
        pieces = [
            replace(
                self,
                mask=found[window] == label,
                row=self.row + window[0].start,
                col=self.col + window[1].start,
                others=None,
            )
            for label, window in enumerate(ndimage.find_objects(found), start=1)
        ]
        return sorted(pieces, key=lambda piece: -piece.area_px)

    def __str__(self) -> str:
        return f"{self.id} ({short(self.name)})" if self.name else str(self.id)

    def to_stone(self) -> Stone:
        """Make the stone, in the frame of the picture (y up from its bottom edge)."""
        bottom = self.picture_height - self.row - self.mask.shape[0]
        return Stone(self.id, self.mask, self.col, bottom, self.name)


def check_count(count: int, where: str) -> None:
    """Refuse more pieces than a picture of stones can have (E110)."""
    if count > MOST_PIECES:
        raise LabelImageError(
            "E110",
            f"there are more than {MOST_PIECES} pieces of stones: this looks like noise.",
            where=where,
            cure="Clean the picture (a median filter takes out specks), or crop it.",
        )


def cut(index: NDArray[Any], ids: NDArray[np.int64], name: str = "") -> list[Patch]:
    """Cut every id out of an image, each looked at within its bounding box only."""
    stone = np.concatenate(([False], ids != 0))
    patches = []
    for position, window in enumerate(ndimage.find_objects(index), start=1):
        if window is None or not stone[position]:
            continue
        inside = index[window]
        mask = inside == position
        others = stone[inside] & ~mask
        row, col = window[0].start, window[1].start
        patches.append(Patch(int(ids[position - 1]), mask, row, col, index.shape[0], others, name))
    return patches


def smallest_stone_px(patches: list[Patch], settings: ReadSettings) -> float:
    """Return the area from which a patch is a stone: max(10 px, 0.1 % of the median area)."""
    if settings.min_area_px is not None:
        return settings.min_area_px
    areas = [patch.area_px for patch in patches if patch.area_px >= MIN_AREA_PX]
    return max(MIN_AREA_PX, 0.001 * float(np.median(areas))) if areas else MIN_AREA_PX


def without_specks(patches: list[Patch], limit_px: float) -> tuple[list[Patch], list[Notice]]:
    """Leave out patches whose largest piece is smaller than a stone can be, and list them."""
    kept: list[Patch] = []
    specks: list[Patch] = []
    for patch in patches:
        largest_px = max(patch.piece_areas_px, default=0)
        (kept if largest_px >= limit_px else specks).append(patch)
    if not specks:
        return patches, []
    places = (f"{s} of {s.area_px} px at column {s.col}, row {s.row}" for s in specks)
    total = sum(speck.area_px for speck in specks)
    message = f"{len(specks)} specks < {limit_px:g} px left out ({total} px in all)"
    cure = "Use --min-area PX (min_area_px in Python) to keep smaller stones."
    return kept, [Notice("W113", f"{message}: {listed(places, most=MANY)}.", cure)]


def filled(patches: list[Patch], settings: ReadSettings) -> tuple[list[Patch], list[Notice]]:
    """Fill the holes of all patches (or only report them, ``holes="keep"``)."""
    result, found = [], []
    for patch in patches:
        holes = enclosed(patch.mask)
        count = int(holes.sum())
        if not count:
            result.append(patch)
            continue
        taken = 0 if patch.others is None else int((holes & patch.others).sum())
        shared = f", {taken} px of them other stones'" if taken else ""
        found.append(f"stone {patch}: {count} px{shared}")
        keep = settings.holes == "keep"
        result.append(patch if keep else replace(patch, mask=patch.mask | holes))
    if not found:
        return result, []
    if settings.holes == "keep":
        text = "holes kept open (areas and centroids without them; outlines as if filled)"
        return result, [Notice("W112", f"{text}: {listed(found, '; ', MANY)}.")]
    cure = "Use --holes keep (holes='keep' in Python) to leave them open."
    return result, [Notice("W112", f"holes filled: {listed(found, '; ', MANY)}.", cure)]


def enclosed(mask: Mask) -> Mask:
    """Return the pixels that no 4-connected way around the mask reaches: its holes."""
    around = np.ones((mask.shape[0] + 2, mask.shape[1] + 2), bool)
    np.logical_not(mask, out=around[1:-1, 1:-1])
    if not _is_plain(mask):
        found, count = ndimage.label(around)
        return np.zeros_like(mask) if count == 1 else np.asarray(found[1:-1, 1:-1] > 1)
    runs = label_runs(around.view(np.uint8))
    pieces = runs_in_pieces(runs, corners=False)
    holes = pieces != pieces[0]
    if not holes.any():
        return np.zeros_like(mask)
    change = around.view(np.int8).ravel()
    change[:] = 0
    change[(runs.rows * runs.width + runs.begins)[holes]] = 1
    change[(runs.rows * runs.width + runs.ends)[holes]] = -1
    np.cumsum(change, dtype=np.int8, out=change)
    return around[1:-1, 1:-1]


def _is_plain(mask: Mask) -> bool:
    """Tell a large mask that has few runs along its rows, which are faster than its pixels."""
    if mask.size < _LARGE_PX or not mask.flags.c_contiguous:
        return False
    step = max(1, _LARGE_PX // mask.shape[1])
    some = (mask[row : row + step] for row in range(0, len(mask), step))
    runs = sum(np.count_nonzero(part[:, 1:] != part[:, :-1]) for part in some)
    return bool(_PLAIN_PX * runs < mask.size)


def piece_numbers(patches: list[Patch], settings: ReadSettings) -> dict[int, list[int]]:
    """Return the ids of the further pieces of every patch that is split.

    They come after the largest id (where ids end: the free ones from 1), whatever is skipped.
    """
    if settings.pieces != "split" or not patches:
        return {}
    stones, _ = without_specks(patches, smallest_stone_px(patches, settings))
    whole, _ = filled(stones, settings)
    used = {patch.id for patch in patches}
    next_id = max(used)
    numbers: dict[int, list[int]] = {}
    for patch in whole:
        for _ in patch.piece_areas_px[1:]:
            next_id = next_id + 1 if next_id < MAX_ID else 1
            while next_id in used:
                next_id = next_id + 1 if next_id < MAX_ID else 1
            used.add(next_id)
            numbers.setdefault(patch.id, []).append(next_id)
    return numbers


def in_one_piece(
    patches: list[Patch], settings: ReadSettings, where: str, numbers: Mapping[int, list[int]]
) -> tuple[list[Patch], list[Notice]]:
    """Leave every stone one 8-connected piece."""
    result, refused, dropped = [], [], []
    several: list[tuple[Patch, list[Patch]]] = []
    for patch in patches:
        pieces = patch.pieces()
        result.append(pieces[0])
        if len(pieces) == 1:
            continue
        several.append((patch, pieces[1:]))
        if _is_refused(pieces, settings.pieces):
            refused.append(_describe(patch, pieces))
        dropped.append(_describe(patch, pieces[1:]))
    if refused:
        raise _in_pieces(refused, where)
    if not several:
        return result, []
    if settings.pieces == "split":
        new, text = _as_stones(several, numbers, settings.skip)
        kept = [patch for patch in result if patch.id not in settings.skip] + new
        said = [Notice("W111", f"pieces became stones of their own: {text}.")] if new else []
        return kept, said
    cure = "Use --pieces split (pieces='split' in Python) to make them stones."
    text = f"smaller pieces left out: {listed(dropped, '; ', MANY)}."
    return result, [Notice("W111", text, cure)]


def _is_refused(pieces: list[Patch], rule: Pieces) -> bool:
    if rule == "auto":
        areas = [piece.area_px for piece in pieces]
        return sum(areas[1:]) >= SMALL_SHARE * sum(areas)
    return rule == "error"


def _describe(patch: Patch, pieces: Iterable[Patch]) -> str:
    places = listed(f"{p.area_px} px at column {p.col}, row {p.row}" for p in pieces)
    return f"stone {patch}: {places}"


def _in_pieces(refused: list[str], where: str) -> LabelImageError:
    return LabelImageError(
        "E103",
        f"{len(refused)} stones are in several pieces: {listed(refused, '; ')}.",
        where=where,
        cure="Correct the picture, or choose --pieces keep-largest (leave the others out) or "
        "--pieces split (each piece a stone); in Python pieces='keep-largest' or pieces='split'.",
    )


def _as_stones(
    several: list[tuple[Patch, list[Patch]]],
    numbers: Mapping[int, list[int]],
    skip: tuple[int, ...],
) -> tuple[list[Patch], str]:
    """Give pieces their ids, and leave out those that are skipped."""
    stones, text = [], []
    for patch, pieces in several:
        new = [
            replace(piece, id=number)
            for piece, number in zip(pieces, numbers[patch.id], strict=True)
            if number not in skip
        ]
        stones += new
        if new:
            text.append(f"stone {patch}: {listed(f'{p.id} ({p.area_px} px)' for p in new)}")
    return stones, listed(text, "; ", MANY)
