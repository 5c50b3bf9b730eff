"""Stones as they were read, as a label image or as outlines for labelme."""

import io
import json
from pathlib import Path
from typing import Any

import numpy as np

from drystone.errors import InputError, Notice, UsageError
from drystone.io.file_errors import MANY, listed
from drystone.io.photo_beside import SIDECAR, PhotoSidecar, read_sidecar, write_sidecar
from drystone.io.wall_image import write_labels
from drystone.model.stone import Stone, StoneSet
from drystone.model.wall import Labels
from drystone.whole_files import write_whole

PICTURES = (".png", ".tif", ".tiff", ".npy")


def written_as(path: Path) -> tuple[Path, ...]:
    """Return the files that stones are written to, by the ending of the first; E139 for another."""
    suffix = path.suffix.lower()
    if suffix == ".json" and path.name != SIDECAR:
        return (path,)
    if suffix not in PICTURES:
        what = f"stones are written as {', '.join(PICTURES)} or .json (labelme)."
        cure = "Choose another ending."
        if path.name == SIDECAR:
            what, cure = f"{SIDECAR} is what stands beside a label image.", "Choose another name."
        raise UsageError("E139", what, where=str(path), cure=cure)
    return path, path.with_name(SIDECAR)


def write_stones(stones: StoneSet, path: Path, px_per_m: float | None) -> tuple[Notice, ...]:
    """Write stones under their ids, and their scale beside a label image; say what is not kept."""
    height, width = stones.source.height_px, stones.source.width_px
    if path.suffix.lower() == ".json":
        shapes = [_shape(stone, height) for stone in stones]
        size = {"imageHeight": height, "imageWidth": width}
        content = {"version": "5.0.0", "flags": {}, "shapes": shapes, "imagePath": "", **size}
        content |= {"imageData": None, "drystone": {"px_per_m": px_per_m}}
        write_whole(path, (json.dumps(content, indent=1) + "\n").encode())
        return ()
    labels, notices = painted(stones)
    if path.suffix.lower() == ".npy":
        buffer = io.BytesIO()
        np.save(buffer, labels)
        write_whole(path, buffer.getvalue())
    else:
        write_labels(labels, path)
    if px_per_m is not None:
        write_sidecar(PhotoSidecar(width, height, px_per_m, labels=path.name), path.parent)
    elif read_sidecar(path) is not None:  # of what was there before
        path.with_name(SIDECAR).unlink()
    return notices


def _shape(stone: Stone, height_px: int) -> dict[str, Any]:
    """Return a stone as a shape of labelme, y down from the top of the image."""
    x, y = stone.centroid
    corners = stone.outline * (1.0, -1.0) + (x, height_px - y)
    points = np.round(corners, 3).tolist()
    return {"label": str(stone.id), "points": points, "shape_type": "polygon", "flags": {}}


MOST_HIDDEN = 0.5
"""A stone of which more lies under others is not where it was drawn: masks were cropped."""


def painted(stones: StoneSet) -> tuple[Labels, tuple[Notice, ...]]:
    """Return a label image of the size of the source, and which stones lie over each other.

    What several stones have in common goes to the smallest (W119).  E304: half of a stone lies
    under others.
    """
    height, width = stones.source.height_px, stones.source.width_px
    labels = np.zeros((height, width), np.uint32)
    for stone in sorted(stones, key=lambda one: (-one.area_px, one.id)):
        rows, cols = stone.mask.shape
        top = height - stone.bottom_px - rows
        window = labels[top : top + rows, stone.left_px : stone.left_px + cols]
        window[stone.mask] = stone.id
    ids, counts = np.unique(labels, return_counts=True)
    left = dict(zip(ids.tolist(), counts.tolist(), strict=True))
    under = {stone.id: stone.area_px - left.get(stone.id, 0) for stone in stones}
    hidden = [stone.id for stone in stones if under[stone.id] > MOST_HIDDEN * stone.area_px]
    if hidden:
        raise InputError(
            "E304",
            f"more than half of these stones lies under others: {listed(hidden)}.",
            where=stones.source.path,
            cure="Nothing says where they lie in the wall if their masks were cropped: give masks "
            "of the whole picture. --skip leaves out a stone that lies over others.",
        )
    found = [f"{stone} ({px} px)" for stone, px in sorted(under.items()) if px]
    if not found:
        return labels, ()
    text = f"what stones have in common went to the smaller one, from: {listed(found, most=MANY)}."
    return labels, (Notice("W119", text, "Draw them beside each other."),)
