"""Label images of walls in and out, and stones as label images or outlines (DESIGN 2, 4.1)."""

import base64
import io
import json
from pathlib import Path
from typing import Any

import numpy as np
import tifffile
from PIL import Image

from drystone.errors import InputError, Notice, UsageError
from drystone.io import checks
from drystone.io.files import MANY, given_bytes, listed, naming
from drystone.io.images import decode
from drystone.io.labels import check_no_zero, to_ids
from drystone.io.photo_beside import SIDECAR, PhotoSidecar, read_sidecar, write_sidecar
from drystone.model.stone import Stone, StoneSet
from drystone.model.wall import Labels
from drystone.whole_files import write_whole

_MAX_ID_16_BIT = 65535
_BLENDED_PX = 4
"""Of a piece of a blended edge, at most one less: wedges are small."""
_CURE = "Set those pixels to 0, or use --background {0} (background={0} in Python)"


def write_wall_image(labels: Labels, folder: str | Path) -> Path:
    """Write the label image of a wall, (h, w), into a folder that exists; return its path.

    It has 0 where nothing is, otherwise the id of a stone or wedge, at most 2^32-1; row 0 is at the
    top.  It is ``wall.png`` with 16 bits, or ``wall.tif`` with 32 when an id is above 65535.  E206
    when it cannot be written.
    """
    narrow = int(labels.max(initial=0)) <= _MAX_ID_16_BIT
    path = Path(folder) / ("wall.png" if narrow else "wall.tif")
    write_labels(labels, path)
    return path


def write_labels(labels: Labels, path: str | Path) -> None:
    """Write a label image: 16-bit PNG, or 32-bit TIFF when the path ends in .tif or .tiff.

    E139 for another ending, or an id above 65535 in a PNG; E206 when it cannot be written.
    """
    path, buffer = Path(path), io.BytesIO()
    suffix = path.suffix.lower()
    if suffix in (".tif", ".tiff"):
        wide = labels.astype(np.uint32)
        tifffile.imwrite(buffer, wide, photometric="minisblack", compression="zlib", metadata=None)
    elif suffix == ".png" and int(labels.max(initial=0)) <= _MAX_ID_16_BIT:
        Image.fromarray(labels.astype(np.uint16)).save(buffer, format="PNG")
    else:
        what = "label images are written as .png (ids to 65535) or .tif (any id)."
        raise UsageError("E139", what, where=str(path), cure="Choose another ending.")
    write_whole(path, buffer.getvalue())


def read_wall_image(
    path: str | Path, *, background: int = 0, max_image_mpx: float = 200.0
) -> Labels:
    """Read any label image as a wall, (h, w): every pixel keeps its id, none is dropped or split.

    It is a PNG, TIFF, BMP, GIF or NPY: ids of 8, 16 or 32 bits, palette indices, or colours, where
    the id is the grey value for R = G = B, else R + 256 G + 65536 B (DESIGN 4.1).  Row 0 is at the
    top; the `background` becomes 0.  `max_image_mpx` is the largest picture that is decoded, in
    millions of pixels.

    E100, E106, E107, E109 or E110 when the file cannot be read, is damaged, of an unknown format, a
    stack, or too large.  E101 when values were blended (JPEG), E102 for a photo, E104 no stone,
    E105 another background, E108 values that cannot be ids (0 too, when the background is another).
    """
    return read_wall_picture(Path(path), background=background, max_image_mpx=max_image_mpx)[0]


def read_wall_picture(
    path: Path, *, background: int = 0, max_image_mpx: float = 200.0, planned: bool = False
) -> tuple[Labels, tuple[Notice, ...]]:
    """Return the same, and what was made background, repaired or turned on the way.

    One that was `planned` was written with a plan, which says what the ids are: that they look like
    blended ones, as those of stones of a few px do, means nothing.
    """
    with naming(path.name):
        picture = decode(given_bytes(path), int(max_image_mpx * 1e6))
        image = to_ids(picture, background)
        if picture.lossy:
            checks.check_not_lossy(image)
        if len(image.census.values) > 1:
            if not planned:
                image = checks.without_net(image, wall=True)
            checks.check_background(image.census, image.background, _CURE, int(image.has_edges))
            checks.check_not_photo(image.census)
            if not planned:
                image = checks.without_blends(image, _BLENDED_PX, wall=True)
                checks.check_not_resampled(image)
        elif int(image.census.values[0]) == image.background:
            # One stone may fill the whole image; no stone may not.
            checks.check_not_uniform(image)
        check_no_zero(image)
    labels = image.ids.astype(np.uint32)
    labels[labels == image.background] = 0
    return labels, image.said


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
    """Return a stone as a shape of labelme, y down from the top of the image.

    Polygons of labelme have no holes: a stone that has some is a mask.
    """
    if not np.array_equal(stone.mask, stone.solid):
        rows, cols = stone.mask.shape
        left, top = stone.left_px, height_px - stone.bottom_px - rows
        ends, buffer = [[left, top], [left + cols - 1, top + rows - 1]], io.BytesIO()
        Image.fromarray(stone.mask).save(buffer, format="PNG")
        mask = base64.b64encode(buffer.getvalue()).decode()
        shape = {"label": str(stone.id), "points": ends, "shape_type": "mask", "flags": {}}
        return shape | {"mask": mask}
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
