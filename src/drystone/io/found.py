"""Patches of a source put in order, as stones."""

from dataclasses import dataclass

from drystone.errors import LabelImageError, Notice
from drystone.io.listed import listed
from drystone.io.necks import suspect_necks
from drystone.io.patches import (
    Patch,
    check_count,
    filled,
    in_one_piece,
    piece_numbers,
    smallest_stone_px,
    without_specks,
)
from drystone.io.read_settings import ReadSettings
from drystone.model.stone import Source, StoneSet


@dataclass(frozen=True, eq=False)
class Found:
    """Patches of a source and what was noticed on the way."""

    patches: list[Patch]
    notices: list[Notice]
    where: str


def stone_set(found: Found, source: Source, settings: ReadSettings) -> StoneSet:
    """Put patches in order and make stones of them; every decision becomes a notice."""
    pieces_so_far = 0
    for patch in found.patches:
        pieces_so_far += len(patch.piece_areas_px)
        check_count(pieces_so_far, found.where)
    numbers = piece_numbers(found.patches, settings)
    known = {patch.id for patch in found.patches}.union(*numbers.values())
    unknown = sorted(set(settings.skip) - known)
    notices = list(found.notices)
    if unknown:
        notices.append(Notice("W116", f"no stone {listed(unknown)} to skip.", "Check the ids."))
    skip = set(settings.skip)
    # One of several numbers stays until it is split.
    patches = [p for p in found.patches if not {p.id, *numbers.get(p.id, ())} <= skip]
    # What is split must not depend on what is skipped.
    judged = found.patches if settings.pieces == "split" else patches
    limit_px = smallest_stone_px(judged, settings)
    patches, specks = without_specks(patches, limit_px)
    patches, holes = filled(patches, settings)
    patches, pieces = in_one_piece(patches, settings, found.where, numbers)
    patches, bits = without_specks(patches, limit_px)
    notices += [*specks, *holes, *pieces, *bits, *suspect_necks(patches)]
    if not patches:
        said = specks or (() if known else found.notices)
        why = " ".join(notice.message for notice in said)
        why = why or ("all were skipped." if known else "none has a pixel.")
        raise LabelImageError(
            "E104", f"no stones are left: {why}", where=found.where,
            cure="Check the picture, and what --min-area and --skip (min_area_px and skip in "
            "Python) leave out.",
        )  # fmt: skip
    return StoneSet(tuple(patch.to_stone() for patch in patches), source, tuple(notices))
