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
from drystone.photo.marker_places import PlacedMarker, placed_markers
from drystone.photo.markers import FoundMarker, find_markers
from drystone.photo.rectify import rectify
from drystone.photo.scale import scale_and_view
from drystone.photo.segment import WORKING_PX, FoundStones, segment
from drystone.photo.segment_settings import SegmentSettings
from drystone.photo.view import SQUARE, View, apply

QUIET_ZONE = 0.3
"""White border of a single marker over its side, that is no ground."""


@dataclass(frozen=True, eq=False)
class SegmentedPhoto:
    """Stones of a photograph, in the picture that a camera far above would take."""

    picture: NDArray[np.uint8]  # (h, w, 3) RGB; black where the photograph shows nothing
    found: FoundStones
    # (3, 3) homography from photo px to px of the picture (pixel centres at +0.5 in both).
    from_photo: NDArray[np.float64]
    px_per_m: float | None = None  # px of the picture in a metre
    view: View | None = None  # what the scale was taken from
    markers: tuple[PlacedMarker, ...] = ()  # those of the view, in the frame of the picture
    unasked: tuple[int, ...] = ()  # markers that nobody asked about: their papers are left out

    @property
    def notices(self) -> tuple[Notice, ...]:
        """What there is to say of the markers."""
        if self.unasked:
            ids = ", ".join(map(str, self.unasked))
            said = f"The photograph has markers that give no scale here: {ids}. They and their "
            cure = "--aruco takes the scale and the view from them."
            return (Notice("W170", f"{said}paper are not stones.", cure),)
        return () if self.view is None else self.view.notices


def segment_photo(
    image: NDArray[np.uint8],
    scale: MarkerLayout | float | None = None,
    settings: SegmentSettings | None = None,
    min_area: tuple[float, str] | None = None,
    max_px: int = WORKING_PX,
) -> SegmentedPhoto:
    """Find the stones of an RGB photograph, the right way up.

    `scale` is photo px in a metre, or the markers that are in it; only markers correct the
    perspective.  `min_area` is in "px" of the result or in "cm2", and replaces what the settings
    say.  E170 to E173 of the markers, E175 no stones, E176 no ground.
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
    return SegmentedPhoto(picture, found, from_photo, px_per_m, view, unasked=ids)


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
    used = [marker for marker in markers if marker.id in view.ids]
    height = above.values.shape[0]
    placed = placed_markers(used, layout, above.from_photo, above.px_per_m, height)
    return SegmentedPhoto(above.values, found, above.from_photo, above.px_per_m, view, placed)


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

    True is paper, as far as it is known: all of a sheet, and the border of a single marker.  The
    layout is None when nobody said whether they are sheets.
    """
    covered = np.zeros(shape, bool)
    for marker in markers:
        seen = apply(from_photo, marker.corners_px)
        if layout is not None and layout.page is not None and layout.lists(marker.id):
            paper = SQUARE * (np.array(page_mm(layout.page)) / 1000.0 * layout.printed)
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
