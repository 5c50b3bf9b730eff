"""From a photograph to stones: scale and view, the picture from above, which px are stone."""

import math
from collections.abc import Sequence
from contextlib import suppress
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from PIL import Image
from skimage.draw import polygon2mask
from skimage.transform import estimate_transform

from drystone.errors import Notice, UsageError
from drystone.kernels.raster import Mask
from drystone.model.frames3d import Pose3d, Quaternion
from drystone.photo.layout import MarkerLayout, page_mm
from drystone.photo.markers import FoundMarker, find_markers
from drystone.photo.scale import rigid, scale_and_view
from drystone.photo.segment import WORKING_PX, FoundStones, segment
from drystone.photo.segment_ground import Ground
from drystone.photo.view import SQUARE, View, apply, rectify, without_bands

QUIET_ZONE = 0.3
"""White border of a single marker over its side, that is no ground."""


@dataclass(frozen=True, eq=False)
class PlacedMarker:
    """A marker in P: corners (4, 2) in metres, y up, from the upper left of its print, clockwise.

    The pose is that of its frame: the origin in its middle, X to the right and Y up in its print, Z
    out of it, as OpenCV has it.  All markers that were seen of its sheet say where that is.
    """

    id: int
    corners_m: NDArray[np.float64]
    pose: Pose3d


@dataclass(frozen=True, eq=False)
class SegmentedPhoto:
    """Stones of a photograph, in the picture that a camera far above would take."""

    picture: NDArray[np.uint8]  # (h, w, 3) RGB; black where the photograph shows nothing
    found: FoundStones
    # (3, 3) homography from photo px to px of the picture (pixel centres at +0.5 in both).
    from_photo: NDArray[np.float64]
    px_per_m: float | None  # px of the picture in a metre
    view: View | None  # what markers gave
    markers: tuple[PlacedMarker, ...]  # those of the view, in the frame of the picture
    unasked: tuple[int, ...]  # markers that nobody asked about: their papers are left out

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
    *,
    ground: Ground = "auto",
    min_area: tuple[float, str] | None = None,
    split: bool = True,
    max_px: int = WORKING_PX,
) -> SegmentedPhoto:
    """Find the stones of an RGB photograph, the right way up.

    `scale` is photo px in a metre, or the markers that are in it; only markers correct the
    perspective.  `min_area` is in "px" of the result or in "cm2"; for it, `ground` and `split` see
    :func:`drystone.photo.segment.segment`.  E170 to E173 of the markers, E175 no stones, E176 no
    ground.
    """
    layout: MarkerLayout | None = None
    view: View | None = None
    px_per_m: float | None = None
    markers: tuple[FoundMarker, ...] = ()
    placed: tuple[PlacedMarker, ...] = ()
    unasked: tuple[int, ...] = ()
    height, width = image.shape[:2]
    if isinstance(scale, MarkerLayout):
        layout, markers = scale, find_markers(image)
        view = scale_and_view(markers, layout, (width, height))
        picture, px_per_m, inside, from_photo = rectify(image, view, max_px)
        used = [marker for marker in markers if marker.id in view.ids]
        placed = placed_markers(used, layout, from_photo, px_per_m, len(picture))
    else:
        share = min(1.0, math.sqrt(max_px / (height * width)))
        size = (max(1, int(width * share)), max(1, int(height * share)))
        picture = np.asarray(Image.fromarray(image).resize(size, Image.Resampling.LANCZOS))
        inside = without_bands(picture)
        by = (size[0] / width, size[1] / height)
        from_photo = np.diag([*by, 1.0])
        if scale is not None:
            px_per_m = scale * math.sqrt(by[0] * by[1])
        with suppress(UsageError):  # nobody asked for markers: none without OpenCV
            markers = find_markers(image)
        unasked = tuple(dict.fromkeys(marker.id for marker in markers))
    least_px, unit = min_area or (None, "px")
    if least_px is not None and unit == "cm2":
        if px_per_m is None:
            raise ValueError("an area in cm2 needs a scale")
        least_px *= 1e-4 * px_per_m**2
    papers = papers_of(markers, layout, from_photo, picture.shape[:2])
    found = segment(picture, inside, papers, ground=ground, min_area_px=least_px, split=split)
    return SegmentedPhoto(picture, found, from_photo, px_per_m, view, placed, unasked)


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
            outline = estimate_transform("similarity", layout.corners_m(marker.id), seen)(paper)
        else:
            middle = seen.mean(axis=0)
            outline = middle + (seen - middle) * (1 + 2 * QUIET_ZONE)
        covered |= polygon2mask(shape, outline[:, ::-1])
    return covered


def placed_markers(
    markers: Sequence[FoundMarker],
    layout: MarkerLayout,
    from_photo: NDArray[np.float64],
    px_per_m: float,
    height_px: int,
) -> tuple[PlacedMarker, ...]:
    """Place markers of a photograph in P, by their ids.

    `from_photo` leads from px of the photograph to those of the picture from above.
    """
    flip, top = np.array([1.0, -1.0]), np.array([0.0, height_px / px_per_m])
    ordered = sorted(markers, key=lambda marker: marker.id)
    seen = {one.id: apply(from_photo, one.corners_px) / px_per_m * flip + top for one in ordered}
    printed = {one: layout.corners_m(one) * flip for one in seen}
    placed = []
    for one, corners in seen.items():
        paper = [other for other in seen if layout.group(other) == layout.group(one)]
        on_paper, in_p = (np.concatenate([of[i] for i in paper]) for of in (printed, seen))
        turn, shift = rigid(on_paper, in_p)
        x, y = (turn @ printed[one].mean(axis=0) + shift).tolist()
        half = math.atan2(turn[1, 0], turn[0, 0]) / 2.0
        pose = Pose3d(x, y, 0.0, Quaternion(0.0, 0.0, math.sin(half), math.cos(half)))
        placed.append(PlacedMarker(one, corners, pose))
    return tuple(placed)
