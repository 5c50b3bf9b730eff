"""The automatic masks of Segment Anything: a JSON list, a mask an entry."""

from collections.abc import Mapping
from typing import Any

import numpy as np

from drystone.io.outlines_in.coco import image_needed, shape_of, size_in
from drystone.io.outlines_in.fill import Room, check_reach, trimmed
from drystone.io.outlines_in.model import OutlinedStone, OutlineFile, PlacedMask, entry
from drystone.io.outlines_in.nested import without_nested
from drystone.io.outlines_in.run_lengths import is_runs, size_of
from drystone.io.read_settings import ReadSettings


def is_sam(content: object) -> bool:
    """Tell SAM (and lists of results in COCO's form) by their keys."""
    return isinstance(content, list) and all(
        isinstance(found, Mapping) and "segmentation" in found for found in content
    )


def read_sam(content: list[Mapping[str, Any]], where: str, settings: ReadSettings) -> OutlineFile:
    """Read a list of masks, numbered from 1 in the order of the file.

    Masks may lie in each other: what is ground, a group or a part of a stone is left out as
    :func:`~drystone.io.outlines_in.nested.without_nested` says.
    """
    images = {str(found["image_id"]) for found in content if "image_id" in found}
    several = len({str(found.get("image_id")) for found in content}) > 1
    if images and (several or settings.image):
        if settings.image not in images:
            no_such = f"no image is called {settings.image!r}"
            what = no_such if settings.image else f"masks of {len(images)} images are in it"
            raise image_needed(what, where, sorted(images))
        content = [found for found in content if str(found.get("image_id")) == settings.image]
    stones, sizes = [], set()
    room = Room(where, int(settings.max_image_mpx * 1e6))
    for number, found in enumerate(content, start=1):
        with entry(where, f"mask {number}"):
            segmentation = found["segmentation"]
            if _is_nested_list(segmentation):
                rows = np.asarray(segmentation)
                if rows.ndim != 2 or rows.dtype.kind not in "biu":
                    raise ValueError("its rows are not of one length, or of no truth values")
                sizes.add((rows.shape[1], rows.shape[0]))
                mask = trimmed(PlacedMask(rows.astype(bool), 0, 0))
                stones.append(OutlinedStone(number, masks=() if mask is None else (mask,)))
                continue
            areas, masks = shape_of(segmentation, room)
            if is_runs(segmentation):
                sizes.add(size_of(segmentation))
            stones.append(OutlinedStone(number, "", areas, masks))
    check_reach(stones, where, room.max_px)
    kept, notices = without_nested(stones, where, settings.skip)
    return OutlineFile(
        tuple(kept),
        size_px=size_in(None, sizes, where),
        notices=tuple(notices),
        names_images=bool(images),
    )


def _is_nested_list(segmentation: Any) -> bool:
    """Tell rows of truth values from polygons, which have at least 6 numbers that are none."""
    if not isinstance(segmentation, list) or not segmentation:
        return False
    first = segmentation[0]
    return isinstance(first, list) and all(value in (0, 1) for value in first)
