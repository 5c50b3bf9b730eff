"""Walls as label images: wall.png out, any label image in (DESIGN 2, 4.1)."""

import io
from pathlib import Path

import numpy as np
import tifffile
from PIL import Image

from drystone.errors import Notice, UsageError
from drystone.io import checks
from drystone.io.file_bytes import given_bytes
from drystone.io.file_errors import naming
from drystone.io.images import decode
from drystone.io.labels import check_no_zero, to_ids
from drystone.model.wall import Labels
from drystone.whole_files import write_whole

_MAX_ID_16_BIT = 65535
_BLENDED_PX = 4
"""Of a piece of a blended edge, at most one less: wedges are small."""
_CURE = "Set those pixels to 0, or use --background {0} (background={0} in Python)"


def write_wall_image(labels: Labels, folder: str | Path) -> Path:
    """Write the label image of a wall into a folder.

    Parameters
    ----------
    labels : (h, w) integer array
        0 where nothing is, otherwise the id of a stone or wedge, at most 2^32-1; row 0 at the top.
    folder : str or Path
        Exists.

    Returns
    -------
    path : Path
        ``wall.png`` with 16 bits, or ``wall.tif`` with 32 bits when an id is above 65535.

    Raises
    ------
    PlanError
        E206: the file cannot be written.
    """
    narrow = int(labels.max(initial=0)) <= _MAX_ID_16_BIT
    path = Path(folder) / ("wall.png" if narrow else "wall.tif")
    write_labels(labels, path)
    return path


def write_labels(labels: Labels, path: str | Path) -> None:
    """Write a label image: 16-bit PNG, or 32-bit TIFF when the path ends in .tif or .tiff.

    Raises
    ------
    UsageError
        E139: another ending, or an id above 65535 in a PNG.
    PlanError
        E206: the file cannot be written.
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
    path: str | Path, *, background: int = 0, max_image_mpx: float = 200.0, planned: bool = False
) -> Labels:
    """Read any label image as a wall: every pixel keeps its id, nothing is dropped or split.

    Parameters
    ----------
    path : str or Path
        PNG, TIFF, BMP, GIF or NPY: ids of 8, 16 or 32 bits, palette indices, or colours, where
        the id is the grey value for R = G = B, else R + 256 G + 65536 B (DESIGN 4.1).
    background : int
        The value that is no stone; it becomes 0.
    max_image_mpx : float
        Largest picture that is decoded, in millions of pixels.
    planned : bool
        It was written with a plan, which says what the ids are: that they look like blended ones,
        as those of stones of a few px do, means nothing.

    Returns
    -------
    labels : (h, w) uint32 array
        0 where nothing is, row 0 at the top.

    Raises
    ------
    InputError
        E100, E106, E107, E109, E110: the file cannot be read, is damaged, of an unknown format, a
        stack, or too large.
    LabelImageError
        E101 values were blended (JPEG), E102 a photo, E104 no stone, E105 another background,
        E108 values that cannot be ids (0 too, when the background is another value).
    """
    labels, _ = read_wall_picture(
        Path(path), background=background, max_image_mpx=max_image_mpx, planned=planned
    )
    return labels


def read_wall_picture(
    path: Path, *, background: int = 0, max_image_mpx: float = 200.0, planned: bool = False
) -> tuple[Labels, tuple[Notice, ...]]:
    """Return the same, and what was made background, repaired or turned on the way."""
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
