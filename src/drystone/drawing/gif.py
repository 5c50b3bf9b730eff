"""GIF files that loop, small and with the same bytes for the same pictures."""

from collections.abc import Sequence
from io import BytesIO

import numpy as np
from numpy.typing import ArrayLike
from PIL import Image


def palette_of(colours: ArrayLike) -> Image.Image:
    """Return the palette that pictures are reduced to.

    Parameters
    ----------
    colours : (n, 3) float array-like
        Red, green and blue in [0, 1]; at most 256 of them.
    """
    palette = Image.new("P", (1, 1))
    palette.putpalette(np.rint(255 * np.asarray(colours, float)).astype(np.uint8).tobytes())
    return palette


def gif_bytes(
    pictures: Sequence[Image.Image], palette: Image.Image, duration_ms: int | Sequence[int]
) -> bytes:
    """Return a GIF that loops.

    Parameters
    ----------
    pictures : sequence of Image
        RGB, all of one size.
    palette : Image
        Of :func:`palette_of`.  One palette for all frames: colours chosen from a picture would
        tint its black lines, and differ from frame to frame.
    duration_ms : int or sequence of int
        How long a frame is shown; of all frames, or of each.

    Examples
    --------
    >>> two = [Image.new("RGB", (4, 4), colour) for colour in ("black", "white")]
    >>> gif_bytes(two, palette_of([[0, 0, 0], [1, 1, 1]]), 80)[:6]
    b'GIF89a'
    """
    first, *others = (
        picture.quantize(palette=palette, dither=Image.Dither.NONE) for picture in pictures
    )
    with BytesIO() as file:
        first.save(
            file,
            format="GIF",
            save_all=True,
            append_images=others,
            duration=duration_ms,
            loop=0,
            disposal=1,
            optimize=False,
        )
        return file.getvalue()
