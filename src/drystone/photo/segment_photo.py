"""From a photograph to stones: scale and view, the picture from above, which px are stone."""

import math
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray
from PIL import Image
from skimage.draw import polygon2mask

from drystone.errors import Notice, UsageError
from drystone.kernels.raster import Mask
from drystone.photo.layout import MarkerLayout, page_mm
from drystone.photo.markers import FoundMarker, find_markers
from drystone.photo.rectify import rectify
from drystone.photo.scale import scale_and_view
from drystone.photo.segment import WORKING_PX, Found, segment
from drystone.photo.segment_settings import SegmentSettings
from drystone.photo.view import View, apply

QUIET_ZONE = 0.3
"""White border of a single marker over its side, that is no ground."""


@dataclass(frozen=True, eq=False)
class SegmentedPhoto:
    """Stones of a photograph, in the picture that a camera far above would take.

    Parameters
    ----------
    picture : (h, w, 3) uint8 array
        That picture, RGB; black where the photograph shows nothing.
    found : Found
        The stones in it.
    from_photo : (3, 3) float array
        Homography from photo px to px of the picture (pixel centres at +0.5 in both).
    px_per_m : float or None
        Px of the picture in a metre.
    view : View or None
        What the scale was taken from.
    unasked : tuple of int
        Markers that are in the photograph and were not asked about: their papers are left out.
    """

    picture: NDArray[np.uint8]
    found: Found
    from_photo: NDArray[np.float64]
    px_per_m: float | None = None
    view: View | None = None
    unasked: tuple[int, ...] = ()

    @property
    def notices(self) -> tuple[Notice, ...]:
        """What there is to say of the markers."""
        if self.unasked:
            said = ", ".join(map(str, self.unasked))
            return (
                Notice(
                    "W170",
                    f"The photograph has markers that give no scale here: {said}. They and their "
                    "paper are no stones.",
                    "--aruco takes the scale and the view from them.",
                ),
            )
        return () if self.view is None else self.view.notices


def segment_photo(
    image: NDArray[np.uint8],
    scale: MarkerLayout | float | None = None,
    settings: SegmentSettings | None = None,
    min_area: tuple[float, str] | None = None,
    max_px: int = WORKING_PX,
) -> SegmentedPhoto:
    """Find the stones of a photograph.

    Parameters
    ----------
    image : (h, w, 3) uint8 array
        RGB, the right way up.
    scale : MarkerLayout, float or None
        Markers that are in it, or photo px in a metre.  Only markers correct the perspective.
    settings : SegmentSettings, optional
        How stones are told from the ground.
    min_area : (float, str), optional
        Smaller is no stone: a number of ``"px"`` of the result or of ``"cm2"``; this replaces
        what the settings say.
    max_px : int
        Size of the picture in which stones are found.

    Raises
    ------
    InputError
        E170 to E173 of the markers, E175 no stones, E176 no ground.
    """
    if isinstance(scale, MarkerLayout):
        return _by_markers(image, scale, settings, min_area, max_px)
    height, width = image.shape[:2]
    share = min(1.0, math.sqrt(max_px / (height * width)))
    size = (max(1, int(width * share)), max(1, int(height * share)))
    picture = image
    if share < 1.0:
        picture = np.asarray(Image.fromarray(image).resize(size, Image.Resampling.LANCZOS))
    by = (size[0] / width, size[1] / height)
    px_per_m = None if scale is None else scale * math.sqrt(by[0] * by[1])
    from_photo = np.diag([*by, 1.0])
    markers = _markers_if_possible(image)
    papers = papers_of(markers, None, from_photo, picture.shape[:2])
    found = segment(picture, None, _with_area(settings, min_area, px_per_m), papers)
    view = None if scale is None else View.flat(scale)
    ids = tuple(dict.fromkeys(marker.id for marker in markers))
    return SegmentedPhoto(picture, found, from_photo, px_per_m, view, ids)


def _markers_if_possible(image: NDArray[np.uint8]) -> tuple[FoundMarker, ...]:
    """Return the markers of a photograph whose scale is not theirs; none without OpenCV."""
    try:
        return find_markers(image)
    except UsageError:
        return ()


def _by_markers(
    image: NDArray[np.uint8],
    layout: MarkerLayout,
    settings: SegmentSettings | None,
    min_area: tuple[float, str] | None,
    max_px: int,
) -> SegmentedPhoto:
    markers = find_markers(image)
    view = scale_and_view(markers, layout, (image.shape[1], image.shape[0]))
    above = rectify(image, view, max_px=max_px)
    papers = papers_of(markers, layout, above.from_photo, above.inside.shape)
    settings = _with_area(settings, min_area, above.px_per_m)
    found = segment(above.values, above.inside, settings, papers)
    return SegmentedPhoto(above.values, found, above.from_photo, above.px_per_m, view)


def _with_area(
    settings: SegmentSettings | None, min_area: tuple[float, str] | None, px_per_m: float | None
) -> SegmentSettings:
    settings = settings or SegmentSettings()
    if min_area is None:
        return settings
    value, unit = min_area
    if unit == "cm2":
        if px_per_m is None:
            raise ValueError("an area in cm2 needs a scale")
        value *= 1e-4 * px_per_m**2
    return replace(settings, min_area_px=value)


def papers_of(
    markers: tuple[FoundMarker, ...],
    layout: MarkerLayout | None,
    from_photo: NDArray[np.float64],
    shape: tuple[int, int],
) -> Mask:
    """Return where sheets and markers lie, those that are not used too.

    Parameters
    ----------
    markers : tuple of FoundMarker
        All that are in the photograph.
    layout : MarkerLayout or None
        Whether they are sheets; None when nobody said.
    from_photo : (3, 3) float array
        Photo px to px of the picture.
    shape : (int, int)
        Height and width of the picture.

    Returns
    -------
    covered : (h, w) bool array
        Paper, as far as it is known: all of a sheet, and the border of a single marker.
    """
    covered = np.zeros(shape, bool)
    for marker in markers:
        seen = apply(from_photo, marker.corners_px)
        if layout is not None and layout.page is not None and layout.lists(marker.id):
            side = np.array(page_mm(layout.page)) / 1000.0 * layout.printed
            paper = np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]]) * side
            outline = _similar(layout.corners_m(marker.id), seen, paper)
        else:
            middle = seen.mean(axis=0)
            outline = middle + (seen - middle) * (1 + 2 * QUIET_ZONE)
        covered |= polygon2mask(shape, outline[:, ::-1])
    return covered


def _similar(
    known: NDArray[np.float64], seen: NDArray[np.float64], points: NDArray[np.float64]
) -> NDArray[np.float64]:
    """Move points as the turn, shift and scale do that bring `known` to `seen`."""
    # Points of the plane as complex numbers: a turn with a scale is one factor.
    one, other = (side[:, 0] + 1j * side[:, 1] for side in (known, seen))
    centred = one - one.mean()
    factor = np.vdot(centred, other - other.mean()) / np.vdot(centred, centred)
    moved = (points[:, 0] + 1j * points[:, 1] - one.mean()) * factor + other.mean()
    return np.column_stack([moved.real, moved.imag])
