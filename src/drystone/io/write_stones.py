"""Stones as they were read, as a label image or as outlines for labelme."""

import io
import json
from pathlib import Path
from typing import Any

import numpy as np

from drystone.errors import Notice, UsageError
from drystone.io.painted import painted
from drystone.io.photo_beside import SIDECAR, PhotoSidecar, read_sidecar, write_sidecar
from drystone.io.wall_image import write_labels
from drystone.model.stone import Stone, StoneSet
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
        write_whole(path, (json.dumps(content | {"imageData": None}, indent=1) + "\n").encode())
        if px_per_m is None:
            return ()
        what = f"labelme keeps no scale, and that of these stones is {px_per_m:g} px a metre."
        return (Notice("W119", what, f"Give it again with --px-per-m {px_per_m:g}."),)
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
