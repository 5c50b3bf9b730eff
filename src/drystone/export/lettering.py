"""Words in pictures that Pillow draws, in the typeface of Matplotlib's."""

from pathlib import Path

import matplotlib as mpl
from PIL import ImageFont


def font(size_px: float, *, bold: bool = False) -> ImageFont.FreeTypeFont:
    """Return DejaVu Sans, which comes with Matplotlib: the same on every machine.

    Parameters
    ----------
    size_px : float
        Height of a line, px.
    bold : bool
        Its bold cut.
    """
    name = "DejaVuSans-Bold.ttf" if bold else "DejaVuSans.ttf"
    return ImageFont.truetype(Path(mpl.get_data_path()) / "fonts" / "ttf" / name, size_px)
