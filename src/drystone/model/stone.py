"""A found stone, as it lies in the source image."""

from collections.abc import Iterator
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage

from drystone.errors import InputError, Notice, PlanError
from drystone.kernels.polygons import Points, area_and_centroid
from drystone.kernels.raster import Mask
from drystone.kernels.silhouette import pixel_hull
from drystone.model.outline import (
    centroid_of,
    drawn_outline,
    is_outline_of,
    solid,
    stone_outline,
)
from drystone.model.settings import typed

OUTLINE_TOLERANCE_PX = 0.75
"""How far the contour of the pixels may stay away from the lines of an outline.

A straight side moves by up to half a pixel when it is rasterised, and a fitted line by some more at
its ends.  Smaller tolerances (DESIGN 4.9: .35) follow the steps of the grid: their slopes do not go
away as the resolution grows, nor does what they do to walls and to the load multiplier.
"""


@typed  # ids of NumPy would wrap where wedges are numbered after them
@dataclass(frozen=True, eq=False)
class Stone:
    """One stone of the source image, immutable.

    Parameters
    ----------
    id : int
        Label in the source image, from 1 to 4294967295.
    mask : (h, w) bool array
        The stone's pixels, cropped to their bounding box, row 0 at the top, one 8-connected piece.
        Holes are filled unless they are kept: then area and centroid are without them, and the
        outline is the outer one all the same.
    left_px, bottom_px : int
        Position of the mask's bottom-left corner in the source frame (x right, y up from the
        image's bottom-left corner).
    name : str
        File name of a one-stone mask; empty for label images.
    drawn : (n, 2) array, optional
        The outline that its file draws, simple, counter-clockwise, from the mask's bottom-left
        corner, y up, px.  The mask is its pixels; without it the outline is that of the mask.

    Raises
    ------
    InputError
        E183 when id, mask or outline are not as said here.

    Examples
    --------
    >>> stone = Stone(7, np.ones((2, 4), bool), left_px=10, bottom_px=20)
    >>> stone.area_px, stone.centroid
    (8, (12.0, 21.0))
    """

    id: int
    mask: Mask
    left_px: int = 0
    bottom_px: int = 0
    name: str = ""
    drawn: Points | None = None

    def __post_init__(self) -> None:
        mask = _own(np.ma.filled(self.mask, 0), "mask", bool, "biu")  # what is masked is no stone
        drawn = self.drawn
        if drawn is not None:
            drawn = _own(np.asarray(drawn), "drawn", float, "iuf")
        object.__setattr__(self, "mask", mask)
        object.__setattr__(self, "drawn", drawn)
        object.__setattr__(self, "name", writable(self.name))
        if not 0 < self.id < 2**32:
            wrong = "the id must be a whole number from 1 to 4294967295."
        elif mask.ndim != 2 or not mask.any():
            wrong = "the mask must be a two-dimensional array with at least one pixel."
        elif not all(side.any() for side in (mask[0], mask[-1], mask[:, 0], mask[:, -1])):
            wrong = "the mask must be cropped to the box around its pixels."
        elif ndimage.label(mask, np.ones((3, 3)))[1] > 1:
            wrong = "the mask must be one connected piece."
        elif drawn is not None and not is_outline_of(drawn, self.solid):
            wrong = "the drawn outline must be simple, counter-clockwise, y up, and of the mask."
        else:
            return
        cure = "`read_stones` makes stones of pictures and of files of outlines."
        raise InputError("E183", wrong, where=f"stone {self.id}", cure=cure)

    def __repr__(self) -> str:
        height, width = self.mask.shape
        named = f" ({self.name})" if self.name else ""
        return f"<Stone {self.id}{named}: {width} x {height} px, area {self.area_px} px²>"

    @cached_property
    def area_px(self) -> int:
        """Number of pixels."""
        return int(self.mask.sum())

    @cached_property
    def local_centroid(self) -> tuple[float, float]:
        """Centroid of the drawn outline, else of the pixels, (x, y) from the mask's bottom left."""
        if self.drawn is not None and np.array_equal(self.solid, self.mask):
            return self._outline_centre
        return centroid_of(self.mask)

    @cached_property
    def _outline_centre(self) -> tuple[float, float]:
        """Centroid of what the outline encloses."""
        if self.drawn is None:
            return centroid_of(self.solid)
        return area_and_centroid(self.drawn)[1:]

    @cached_property
    def solid(self) -> Mask:
        """The pixels with all holes filled: what other stones meet."""
        found = solid(self.mask)
        found.flags.writeable = False
        return found

    @cached_property
    def centroid(self) -> tuple[float, float]:
        """Centroid (x, y) in the source frame, y up from the image's bottom edge, px."""
        x, y = self.local_centroid
        return self.left_px + x, self.bottom_px + y

    @property
    def outline(self) -> Points:
        """Simplified contour, as of :meth:`outline_within` at `OUTLINE_TOLERANCE_PX`."""
        return self.outline_within(OUTLINE_TOLERANCE_PX)

    def outline_within(self, tolerance_px: float) -> Points:
        """Return the outline, (n, 2), that stays within a tolerance of the contour of the pixels.

        A simple polygon (x, y) relative to the stone's centroid, counter-clockwise; area and
        centroid are those of its solid (:func:`drystone.model.outline.stone_outline`), which of a
        stone with a hole are others than its own.  One that was drawn has its own area and
        centroid.  It is worked out once for each tolerance.
        """
        outline = self._outlines.get(tolerance_px)
        if outline is None:
            if self.drawn is None:
                outline = stone_outline(self.solid, tolerance_px)
            else:
                outline = drawn_outline(self.drawn, tolerance_px)
            outline += np.array(self._outline_centre) - np.array(self.local_centroid)
            outline.flags.writeable = False
            self._outlines[tolerance_px] = outline
        return outline

    @cached_property
    def _outlines(self) -> dict[float, Points]:
        """Outlines that were asked for, by tolerance: a memory, like any cached property."""
        return {}

    @cached_property
    def hull(self) -> Points:
        """Corners of the convex hull of the pixel squares, (n, 2), relative to the centroid."""
        return np.asarray(pixel_hull(self.mask) - self.local_centroid)

    @cached_property
    def eccentricity(self) -> float:
        """Eccentricity of the ellipse with the same second moments, 0 (circle) to 1 (§3.4)."""
        rows, cols = np.nonzero(self.mask)
        # A pixel is a unit square: 1/12 is its own second moment.
        xx, yy = float(cols.var()) + 1 / 12, float(rows.var()) + 1 / 12
        xy = float(((cols - cols.mean()) * (rows - rows.mean())).mean())
        root = float(np.hypot(xx - yy, 2 * xy))
        return float(np.sqrt(max(0.0, 2 * root / (xx + yy + root))))


@dataclass(frozen=True)
class Source:
    """Where stones came from."""

    path: str = ""  # base name of the file or folder; empty for arrays
    sha256: str = ""  # digest of the bytes that were read
    # size of the source image (of a folder of masks: of the largest)
    width_px: int = 0
    height_px: int = 0
    # file names in the order of their numbers when the source is a folder
    files: tuple[str, ...] = ()
    # settings that the source was read with, where they are not the defaults: what reads it again
    # needs them
    reading: tuple[tuple[str, Any], ...] = ()
    # source px in a metre, when the source says so itself: a rectified photograph, a drawing in
    # millimetres
    px_per_m: float | None = None
    # of the photograph that the stones were found in: its name, its markers with their corners in
    # the frame P, and P_from_marker, the frame of one of them in P
    photograph: tuple[tuple[str, Any], ...] = ()

    def __post_init__(self) -> None:
        object.__setattr__(self, "path", writable(self.path))
        object.__setattr__(self, "files", tuple(writable(name) for name in self.files))


def _own(array: NDArray[Any], name: str, dtype: type, kinds: str) -> NDArray[Any]:
    """Return a copy that never changes; TypeError when it is an array of something else."""
    if array.dtype.kind not in kinds:
        raise TypeError(f"{name} must be an array of {dtype.__name__}, not of {array.dtype}")
    own: NDArray[Any] = array.astype(dtype)
    own.flags.writeable = False
    return own


def writable(name: str) -> str:
    """Return a name that files can hold: bytes of one that is no UTF-8 become question marks."""
    return name.encode("utf-8", "replace").decode()


@typed
@dataclass(frozen=True)
class StoneSet:
    """The stones to build with, in the order of their ids.

    Parameters
    ----------
    stones : tuple of Stone
        With different ids.
    source : Source
        Where they came from.
    notices : tuple of Notice
        What reading them had to decide: specks left out, holes filled, pieces dropped.
    """

    stones: tuple[Stone, ...]
    source: Source = field(default_factory=Source)
    notices: tuple[Notice, ...] = ()

    def __post_init__(self) -> None:
        ids = [stone.id for stone in self.stones]
        if len(set(ids)) != len(ids):
            raise ValueError("two stones have the same id")
        object.__setattr__(self, "stones", tuple(sorted(self.stones, key=lambda s: s.id)))

    def __repr__(self) -> str:
        source = f" of {self.source.path}" if self.source.path else ""
        said = f", {len(self.notices)} notices" if self.notices else ""
        return f"<StoneSet{source}: {len(self)} stones, area {self.total_area_px} px²{said}>"

    def __len__(self) -> int:
        return len(self.stones)

    def __iter__(self) -> Iterator[Stone]:
        return iter(self.stones)

    @cached_property
    def _by_id(self) -> dict[int, Stone]:
        return {stone.id: stone for stone in self.stones}

    def by_id(self, stone_id: int) -> Stone:
        """Return the stone of an id; raise PlanError (E201) when there is none."""
        try:
            return self._by_id[stone_id]
        except KeyError:
            what = f"there is no stone {stone_id} among the {len(self)} stones."
            cure = "Give the stones that the plan was made from."
            raise PlanError("E201", what, where=self.source.path, cure=cure) from None

    @cached_property
    def total_area_px(self) -> int:
        """Area of all stones together in source px."""
        return sum(stone.area_px for stone in self.stones)
