"""Words in pictures and on paper, in the typeface that comes with Matplotlib."""

import unicodedata
from functools import cache
from pathlib import Path

import matplotlib as mpl
from matplotlib.font_manager import get_font
from PIL import ImageFont

MISSING = "\N{WHITE SQUARE}"  # stands for a letter that the typeface does not have
ELLIPSIS = "\N{HORIZONTAL ELLIPSIS}"


def font(size_px: float, *, bold: bool = False) -> ImageFont.FreeTypeFont:
    """Return DejaVu Sans, which comes with Matplotlib: the same on every machine."""
    return ImageFont.truetype(_file(bold=bold), size_px)


def one_line(text: str) -> str:
    """Return what somebody calls a thing without breaks and control characters.

    XML may not hold them, and a drawing would have a line too many.
    """
    return "".join(
        " " if unicodedata.category(letter) in ("Cc", "Cs", "Zl", "Zp") else letter
        for letter in text
    )


def drawable(text: str) -> str:
    """Return a text in letters that the typeface has, regular and bold, on one line."""
    known = _letters()
    return "".join(letter if ord(letter) in known else MISSING for letter in one_line(text))


def fitted(text: str, size: float, room: float, *, bold: bool = False) -> str:
    """Return a text that is no wider than its room; its end is left out when it has to be."""
    # Letters are measured large: Pillow's widths of small ones are whole px.
    measure = font(100.0, bold=bold)
    room *= 100.0 / size
    if measure.getlength(text) <= room:
        return text
    end = len(text)
    while end and measure.getlength(text[:end] + ELLIPSIS) > room:
        end -= 1
    return text[:end] + ELLIPSIS


def _file(*, bold: bool) -> Path:
    name = "DejaVuSans-Bold.ttf" if bold else "DejaVuSans.ttf"
    return Path(mpl.get_data_path()) / "fonts" / "ttf" / name


@cache
def _letters() -> frozenset[int]:
    regular, bold = (get_font(_file(bold=cut)).get_charmap() for cut in (False, True))
    return frozenset(regular) & frozenset(bold)
