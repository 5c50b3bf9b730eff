"""Pieces of the photograph that the stones lie on, for build sheets and the viewer."""

import base64
from collections.abc import Mapping
from dataclasses import dataclass
from io import BytesIO
from typing import Any

import numpy as np
from numpy.typing import NDArray
from PIL import Image

from drystone.drawing.assembly import Assembly
from drystone.io.photo_file import read_photo_picture
from drystone.kernels.polygons import Points

CROP_PX = 240  # longer side of a piece: 200 px an inch on paper, and small files
VIEWER_PX, VIEWER_MARGIN, QUALITY = 96, 0.08, 72
"""Of the viewer's pieces: enough to know a stone by, and 100 of them are a few hundred kB; what is
around the box of an outline over its longer side."""


@dataclass(frozen=True, eq=False)
class StonePhoto:
    """A photograph, RGB, that shows all of a source image of some size."""

    image: Image.Image
    width_px: float
    height_px: float

    def crop(
        self, box: tuple[float, float, float, float], longest_px: int = CROP_PX
    ) -> NDArray[np.uint8]:
        """Return a piece as an (h, w, 3) array; what lies outside the photograph is white.

        The box (x0, y0, x1, y1) is in the source image, px, y up.
        """
        across, down = self.image.width / self.width_px, self.image.height / self.height_px
        x0, y0, x1, y1 = box
        left, right = x0 * across, x1 * across
        top, bottom = (self.height_px - y1) * down, (self.height_px - y0) * down
        shrink = min(1.0, longest_px / max(right - left, bottom - top))
        size = max(1, round((right - left) * shrink)), max(1, round((bottom - top) * shrink))
        piece = Image.new("RGB", size, "white")
        finer = np.array(size) / (right - left, bottom - top)
        corner = np.array([left, top])
        inside = np.clip([corner, (right, bottom)], 0, self.image.size)
        at, end = np.rint((inside - corner) * finer).astype(int).tolist()
        if end[0] > at[0] and end[1] > at[1]:
            part = (end[0] - at[0], end[1] - at[1])
            there = tuple(inside.ravel().tolist())
            shrunk = self.image.resize(part, Image.Resampling.BILINEAR, there, reducing_gap=2.0)
            piece.paste(shrunk, tuple(at))
        return np.asarray(piece)

    def viewer_crops(self, outlines: Mapping[int, Points]) -> dict[int, dict[str, Any]]:
        """Cut stones out, by their outlines in the source image, for the viewer.

        By id: ``data``, a JPEG as data URL, and ``box``, what it shows (x0, y0, x1, y1; source px,
        y up).  Stones outside of the picture have none.
        """
        crops = {}
        for stone, corners in sorted(outlines.items()):
            margin = VIEWER_MARGIN * float(np.ptp(corners, axis=0).max())
            x0, y0 = np.maximum(corners.min(axis=0) - margin, 0.0).tolist()
            reach = (self.width_px, self.height_px)
            x1, y1 = np.minimum(corners.max(axis=0) + margin, reach).tolist()
            if x1 <= x0 or y1 <= y0:
                continue
            written = BytesIO()
            piece = Image.fromarray(self.crop((x0, y0, x1, y1), VIEWER_PX))
            piece.save(written, "JPEG", quality=QUALITY, optimize=True)
            data = base64.b64encode(written.getvalue()).decode("ascii")
            box = [round(value, 2) for value in (x0, y0, x1, y1)]
            crops[stone] = {"data": f"data:image/jpeg;base64,{data}", "box": box}
        return crops


def read_photo(assembly: Assembly) -> StonePhoto | None:
    """Read the photograph of the stones; None when there is none, E189 when it cannot be used."""
    if assembly.photo is None:
        return None
    width, height = (float(assembly.plan.source.get(f"{side}_px") or 0) for side in
                     ("width", "height"))  # fmt: skip
    image = read_photo_picture(assembly.photo, (width, height))
    return StonePhoto(image, width, height)
