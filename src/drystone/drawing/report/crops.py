"""Pieces of the photograph that the stones lie on, one for each stone."""

import base64
from collections.abc import Mapping
from io import BytesIO
from pathlib import Path
from typing import Any

import numpy as np
from PIL import Image

from drystone.io.photo_picture import read_photo_picture
from drystone.kernels.polygons import Points

LONGEST_PX = 96
"""Of a crop: enough to know a stone by, and 100 of them are a few hundred kB."""

MARGIN = 0.08
"""Around the box of an outline, as a share of its longer side."""

QUALITY = 72


def photo_crops(
    photo: Path, source_px: tuple[float, float], outlines: Mapping[int, Points]
) -> dict[int, dict[str, Any]]:
    """Cut the stones out of a photograph.

    Parameters
    ----------
    photo : Path
        Shows the whole source image, at any resolution.
    source_px : (float, float)
        Width and height of the source image.
    outlines : mapping of int to (n, 2) float array
        Of the stones where they lie, source px, y up.

    Returns
    -------
    crops : dict
        By id: ``data``, a JPEG as data URL, and ``box``, what it shows (x0, y0, x1, y1; source
        px, y up).  Stones outside of the picture have none.

    Raises
    ------
    InputError
        E189 when it cannot be read, or shows something of another shape than the source image.
    """
    picture = read_photo_picture(photo, source_px)
    found = {
        stone: _crop(picture, source_px, corners) for stone, corners in sorted(outlines.items())
    }
    return {stone: crop for stone, crop in found.items() if crop is not None}


def _crop(
    picture: Image.Image, source_px: tuple[float, float], corners: Points
) -> dict[str, Any] | None:
    low, high = corners.min(axis=0), corners.max(axis=0)
    margin = MARGIN * float((high - low).max())
    width, height = source_px
    across, down = picture.width / width, picture.height / height
    x0, x1 = (low[0] - margin) * across, (high[0] + margin) * across
    y0, y1 = (height - high[1] - margin) * down, (height - low[1] + margin) * down
    left, upper = max(0, int(np.floor(x0))), max(0, int(np.floor(y0)))
    right, lower = min(picture.width, int(np.ceil(x1))), min(picture.height, int(np.ceil(y1)))
    if right <= left or lower <= upper:
        return None
    piece = picture.crop((left, upper, right, lower))
    piece.thumbnail((LONGEST_PX, LONGEST_PX), Image.Resampling.LANCZOS)
    written = BytesIO()
    piece.save(written, "JPEG", quality=QUALITY, optimize=True)
    box = (left / across, height - lower / down, right / across, height - upper / down)
    data = base64.b64encode(written.getvalue()).decode("ascii")
    return {
        "data": f"data:image/jpeg;base64,{data}",
        "box": [round(value, 2) for value in box],
    }
