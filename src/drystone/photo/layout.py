"""How large printed markers are, and where they lie on their sheet."""

import math
import re
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from drystone.errors import UsageError
from drystone.photo.view import SQUARE

PAGES_MM = {"A4": (210.0, 297.0), "A3": (297.0, 420.0), "letter": (215.9, 279.4)}
"""Width and height of pages."""

ON_A_SHEET = 4
"""Markers of a sheet: upper left, upper right, lower right, lower left."""

FIRST_SHEET = tuple(range(ON_A_SHEET))
"""Markers that a sheet has when nobody says which."""

CHECK_LINE_MM = 100.0
LEAST_MARGIN_MM = 15.0
LEAST_SIZE_MM = 10.0

MIDDLE_MM = 45.0
"""Room for the check line and the text, between the margins of the upper and lower markers."""

_SIZE = re.compile(r"\s*(\d+(?:\.\d*)?|\.\d+)\s*(mm|cm|m|in|ft)\s*")
_MM = {"mm": 1.0, "cm": 10.0, "m": 1000.0, "in": 25.4, "ft": 304.8}


@dataclass(frozen=True)
class MarkerLayout:
    """What is known of the markers in a photograph."""

    size_m: float  # side of the black square of a marker, metres, as it was printed
    # Key of `PAGES_MM` when they are sheets of four that `drystone markers` made: markers 4 k to
    # 4 k + 3 are one sheet, and their distances are known.  None for single ones of this size.
    page: str | None = None
    ids: tuple[int, ...] | None = None  # others are left out with a notice; None for any
    printed: float = 1.0  # printed check line over 100 mm; it multiplies size and distances

    @property
    def side_m(self) -> float:
        """Side of a marker as it was printed, metres."""
        return self.size_m * self.printed

    def lists(self, marker_id: int) -> bool:
        """Whether a marker belongs to it."""
        return self.ids is None or marker_id in self.ids

    def group(self, marker_id: int) -> int:
        """Return the number of the piece of paper that a marker is on."""
        return marker_id if self.page is None else marker_id // ON_A_SHEET

    def corners_m(self, marker_id: int) -> NDArray[np.float64]:
        """Return (4, 2) corners of a marker's pattern on its piece of paper, from its upper left.

        Metres, x to the right and y down, from the upper left of the sheet (or of a single marker).
        """
        unit = SQUARE * self.size_m
        if self.page is not None:
            unit = unit + sheet_positions_m(self.page, self.size_m)[marker_id % ON_A_SHEET]
        return np.asarray(unit * self.printed, dtype=np.float64)


def sheet_positions_m(page: str, size_m: float) -> NDArray[np.float64]:
    """Return the upper left corners of the four markers of a sheet, metres.

    E174 when there is no such page, or they do not fit on it.
    """
    width, height = page_mm(page)
    size = size_m * 1000.0

    def fits(size_mm: float) -> bool:
        # Two markers may not come nearer to each other than to the edge: that is their quiet zone.
        both, margin = 2 * size_mm, margin_mm(size_mm)
        return both + 3 * margin <= width and both + 4 * margin + MIDDLE_MM <= height

    if not size >= LEAST_SIZE_MM:
        raise _no_sheet(f"markers of {size:g} mm are too small", f"{LEAST_SIZE_MM:g} mm or more")
    if not fits(size):
        largest = max(filter(fits, range(int(LEAST_SIZE_MM), int(width))))
        what = f"four markers of {size:g} mm do not fit on {page}"
        raise _no_sheet(what, f"{largest:g} mm or less")
    margin = margin_mm(size)
    left, right = margin, width - margin - size
    top, bottom = margin, height - margin - size
    return np.array([[left, top], [right, top], [right, bottom], [left, bottom]]) / 1000.0


def single_position_m(page: str, size_m: float) -> NDArray[np.float64]:
    """Return the upper left corner of the marker of a single page, metres; E174 as for sheets."""
    width, height = page_mm(page)
    size = size_m * 1000.0
    room = min(width - 2 * margin_mm(size), height - 3 * margin_mm(size) - MIDDLE_MM)
    if not LEAST_SIZE_MM <= size <= room:
        what = f"a marker of {size:g} mm does not fit on {page}"
        raise _no_sheet(what, f"{LEAST_SIZE_MM:g} mm or more, and less than its width")
    return np.array([(width - size) / 2.0, margin_mm(size)]) / 1000.0


def margin_mm(size_mm: float) -> float:
    """Return the white border around markers: the printer's, and at least 1.5 squares."""
    return max(LEAST_MARGIN_MM, float(math.ceil(size_mm / 4.0)))


def page_mm(page: str) -> tuple[float, float]:
    """Return width and height of a page; E174 for one that is not known."""
    if page not in PAGES_MM:
        raise _no_sheet(f"{page!r} is not a page", f"one of {', '.join(PAGES_MM)}")
    return PAGES_MM[page]


def parse_size_m(text: str, option: str) -> float:
    """Read a length such as ``50mm``, ``5cm``, ``0.05m`` or ``2in``; E174 for anything else."""
    found = _SIZE.fullmatch(text)
    value = 0.0 if found is None else float(found[1]) * _MM[found[2]]
    if not 0.0 < value < 10_000.0:
        raise _no_sheet(f"{text!r} is not a length", "one such as 50mm, 5cm or 2in", option)
    return value / 1000.0


def parse_layout(
    text: str, ids: tuple[int, ...] | None = None, printed: float = 1.0
) -> MarkerLayout:
    """Read what `drystone segment` is told of the markers; E174 for what cannot be.

    ``50mm``: single markers of this size, anywhere on the ground; ``A4:50mm`` or ``A4`` (50 mm): a
    sheet of four, with markers 0 to 3 unless given.
    """
    if not 0.5 < printed < 2.0:
        raise _no_sheet(
            f"a check line of {CHECK_LINE_MM * printed:g} mm is not plausible",
            "what a ruler says, such as 97mm or 3.82in",
            "--check-line",
        )
    page, _, size = text.partition(":")
    named = {known.lower(): known for known in PAGES_MM}.get(page.strip().lower())
    if named is None:
        return MarkerLayout(parse_size_m(text, "--aruco"), None, ids, printed)
    size_m = parse_size_m(size or "50mm", "--aruco")
    sheet_positions_m(named, size_m)
    return MarkerLayout(size_m, named, FIRST_SHEET if ids is None else ids, printed)


def _no_sheet(what: str, instead: str, where: str = "markers") -> UsageError:
    return UsageError("E174", f"{what}.", where=where, cure=f"Give {instead}.")
