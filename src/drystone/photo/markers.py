"""Find square markers in a photograph, with corners where their edges meet.

Each edge is measured along its length.  Where two edges meet, blur rounds the corner off, and what
looks for the corner itself finds it too far inside: the marker then reads small and the scale with
it.  Edges are not moved by blur.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from drystone.errors import UsageError, extra
from drystone.kernels.polygons import Points

_ALONG = np.linspace(0.1, 0.9, 81)
"""Places along an edge: not near the corners, which are rounded."""

_ACROSS = np.linspace(-1.0, 1.0, 41)
"""Places across an edge, in reaches: from the black border to the white one."""

_REACHES_PX = (2.0, 10.0)
"""Least and largest reach: farther off, samples would be more than half a px apart."""

_LEAST_CONTRAST = 8.0

SEARCHES = ((0.05, 0.03), (0.05, 0.02), (0.125, 0.03))
"""How OpenCV looks for quadrangles: how near two may be, and how straight their sides must be.

The edge of the paper is a quadrangle near to the marker's and may be taken for it, by one search
here and by another one there; what any of them reads without a wrong square is a marker.
"""

FEW_SQUARES = 6
"""Squares along the edge of a marker, its black border too, of which a chance find is likely."""

DICTIONARIES = ("aruco", "apriltag")
"""Families that are printed; they come first."""

FAMILIES = {
    "aruco": ("ArUco 4x4_50", "DICT_4X4_50"),
    "apriltag": ("AprilTag 36h11", "DICT_APRILTAG_36h11"),
    "aruco5x5": ("ArUco 5x5", "DICT_5X5_1000"),
    "aruco6x6": ("ArUco 6x6", "DICT_6X6_1000"),
    "aruco7x7": ("ArUco 7x7", "DICT_7X7_1000"),
    "original": ("ArUco Original", "DICT_ARUCO_ORIGINAL"),
    "mip36h12": ("ArUco MIP 36h12", "DICT_ARUCO_MIP_36h12"),
    "apriltag25h9": ("AprilTag 25h9", "DICT_APRILTAG_25h9"),
    "apriltag36h10": ("AprilTag 36h10", "DICT_APRILTAG_36h10"),
    "aruco4x4": ("ArUco 4x4", "DICT_4X4_1000"),
    "apriltag16h5": ("AprilTag 16h5", "DICT_APRILTAG_16h5"),
}
"""Names of families for people, and in OpenCV; the smaller dictionaries of OpenCV are the first ids
of these."""


@dataclass(frozen=True, eq=False)
class FoundMarker:
    """A marker in a photograph.

    Its corners are (4, 2): upper left, upper right, lower right, lower left of its pattern
    (clockwise as printed), x to the right, y down.  A pixel is a unit square with its centre at
    +0.5.
    """

    id: int
    corners_px: NDArray[np.float64]
    dictionary: str  # its family, a key of `FAMILIES`

    @property
    def side_px(self) -> float:
        """Mean length of its sides, px."""
        sides = self.corners_px - np.roll(self.corners_px, 1, axis=0)
        return float(np.hypot(*sides.T).mean())


def find_markers(image: NDArray[np.uint8]) -> tuple[FoundMarker, ...]:
    """Find markers with the white border around them, in any position, in grey or RGB.

    They are of the family with more markers in the picture, "aruco" or "apriltag"; where there are
    not two of either, of the one with most of all families.  They are in the order of their ids; an
    id may occur twice.  E305 without OpenCV.
    """
    cv2 = load_cv2()
    grey = image if image.ndim == 2 else cv2.cvtColor(image, cv2.COLOR_RGB2GRAY)
    grey = np.ascontiguousarray(grey)
    # The patterns of AprilTag have more squares, so of two the same number they are the surer.
    best = max((_find(grey, name) for name in reversed(DICTIONARIES)), key=len)
    if len(best) > 1:
        return best
    others = [name for name in FAMILIES if name not in DICTIONARIES]
    counts = {name: len(_quads(grey, name, SEARCHES[:1])) for name in others}
    most = max(others, key=lambda name: counts[name])
    # Among quadrangles of stones one in twenty reads as a pattern of so few squares.
    least = 1 if modules_across(most) > FEW_SQUARES else 2
    return best if counts[most] < max(least, len(best) + 1) else _find(grey, most)


def _find(grey: NDArray[np.uint8], dictionary: str) -> tuple[FoundMarker, ...]:
    across = modules_across(dictionary)
    found = [
        FoundMarker(one, _refined(grey, quad, across), dictionary)
        for one, quad in _quads(grey, dictionary)
    ]
    return tuple(sorted(found, key=lambda marker: (marker.id, *marker.corners_px[0])))


def _quads(
    grey: NDArray[np.uint8], dictionary: str, searches: Sequence[tuple[float, float]] = SEARCHES
) -> list[tuple[int, NDArray[Any]]]:
    """Return ids and corners of the patterns that are there, each once."""
    aruco = load_cv2().aruco
    quads: list[tuple[int, NDArray[Any]]] = []
    for distance, accuracy in searches:
        parameters = aruco.DetectorParameters()
        # Stones are many quadrangles: a pattern with a wrong square is no marker here.
        parameters.errorCorrectionRate = 0.0
        # A square of less than a pixel cannot be read, and each speck is compared with all ids.
        least_px = 4.0 * modules_across(dictionary)
        longest_px = max(grey.shape)
        parameters.minMarkerPerimeterRate = max(min(0.03 * longest_px, 80.0), least_px) / longest_px
        parameters.minMarkerDistanceRate = distance
        parameters.polygonalApproxAccuracyRate = accuracy
        detector = aruco.ArucoDetector(opencv_dictionary(dictionary), parameters)
        corners, ids, _ = detector.detectMarkers(grey)
        for one, quad in zip([] if ids is None else np.ravel(ids), corners, strict=True):
            at = quad.reshape(4, 2)
            middle = at.mean(axis=0)
            # Two finds are one marker when one lies over the other of the same id.
            if not any(
                known == one
                and np.hypot(*(middle - by.mean(axis=0))) < 0.5 * np.hypot(*(by[0] - by[2]))
                for known, by in quads
            ):
                quads.append((int(one), at))
    return quads


def _refined(grey: NDArray[np.uint8], corners: NDArray[Any], across: int) -> NDArray[np.float64]:
    """Move corners to where both edges meet; the window stays within half a square."""
    cv2 = load_cv2()
    sides = np.hypot(*(corners - np.roll(corners, 1, axis=0)).T)
    window = int(np.clip(round(0.5 * float(sides.min()) / across), 2, 30))
    ends = (cv2.TERM_CRITERIA_EPS + cv2.TERM_CRITERIA_MAX_ITER, 50, 0.001)
    start = np.ascontiguousarray(corners, dtype=np.float32).reshape(-1, 1, 2)
    refined = cv2.cornerSubPix(grey, start, (window, window), (-1, -1), ends)
    # OpenCV puts 0 at the centre of the first pixel.
    near = np.asarray(refined.reshape(4, 2), dtype=np.float64) + 0.5
    measured = corners_by_edges(grey, near, across)
    return near if measured is None else measured


def corners_by_edges(grey: NDArray[np.uint8], corners_px: Points, modules: int) -> Points | None:
    """Measure where the four edges of a marker meet.

    `corners_px` (4, 2) are right to within a third of a square of the pattern, clockwise; pixel
    centres at +0.5.  `modules` squares are along an edge.  None when an edge cannot be measured:
    little contrast, or no straight line.
    """
    corners = corners_px
    for _ in range(2):
        lines = [_edge(grey, np.roll(corners, -i, axis=0), modules) for i in range(4)]
        found = [line for line in lines if line is not None]
        if len(found) < 4:
            return None
        corners = np.array([_meeting(found[i - 1], found[i]) for i in range(4)])
        sides = np.hypot(*(corners_px - np.roll(corners_px, 1, axis=0)).T)
        if not (np.hypot(*(corners - corners_px).T) < sides.min() / modules / 2).all():
            return None
    return corners


def _edge(grey: NDArray[np.uint8], corners: Points, modules: int) -> tuple[Points, Points] | None:
    """Return a point and the direction of the first edge; None when it is no straight edge."""
    start, end = corners[:2]
    along = (end - start) / float(np.hypot(*(end - start)))
    # Clockwise as printed and never mirrored: with y down, outside is to the left.
    outward = np.array([along[1], -along[0]])
    # Squares are foreshortened: what counts is how wide they are across this edge.
    width = -float(((corners[2:] - start) @ outward).mean()) / modules
    reach = float(np.clip(0.7 * width, *_REACHES_PX))
    places = start + _ALONG[:, None] * (end - start)
    at = places[:, None, :] + reach * _ACROSS[:, None] * outward
    cv2 = load_cv2()
    x, y = ((at[..., axis] - 0.5).astype(np.float32) for axis in (0, 1))
    seen = cv2.remap(grey, x, y, cv2.INTER_LINEAR, borderMode=cv2.BORDER_REPLICATE)
    # Lenses blur light, not the grey values of sRGB, in which black squares would seem smaller.
    light = 255.0 * ((seen.astype(np.float64) / 255.0 + 0.055) / 1.055) ** 2.4
    # Light changes along an edge, but slowly.
    ends = len(_ACROSS) // 5
    dark = np.polyval(np.polyfit(_ALONG, light[:, :ends].mean(axis=1), 1), _ALONG)
    bright = np.polyval(np.polyfit(_ALONG, light[:, -ends:].mean(axis=1), 1), _ALONG)
    if not (bright - dark > _LEAST_CONTRAST).all():
        return None
    share = (light - dark[:, None]) / (bright - dark)[:, None]
    # Where each profile, dark to bright, has its step, in reaches from its middle.
    offset = 1.0 - np.trapezoid(share, _ACROSS, axis=1)
    return _line(places + reach * offset[:, None] * outward)


def _line(points: Points) -> tuple[Points, Points] | None:
    """Return a point and the direction of the line through points, without the odd ones."""
    keep = np.ones(len(points), dtype=bool)
    middle, direction = points.mean(axis=0), np.zeros(2)
    for _ in range(3):
        middle = points[keep].mean(axis=0)
        direction = np.linalg.svd(points[keep] - middle)[2][0]
        off = np.abs((points - middle) @ np.array([-direction[1], direction[0]]))
        keep = off <= max(3.0 * float(np.median(off)), 0.1)
        if keep.sum() < len(points) / 2:
            return None
    return middle, direction


def _meeting(one: tuple[Points, Points], other: tuple[Points, Points]) -> Points:
    matrix = np.column_stack([one[1], -other[1]])
    if abs(np.linalg.det(matrix)) < 1e-6:
        return np.full(2, np.nan)
    return np.asarray(one[0] + np.linalg.solve(matrix, other[0] - one[0])[0] * one[1])


def load_cv2() -> Any:
    """Return OpenCV (E305 without it)."""
    return extra("cv2", "is OpenCV, which finds the markers", "photo", "photo")


def opencv_dictionary(name: str) -> Any:
    """Return OpenCV's dictionary of a family; E174 for a name that is none."""
    if name not in FAMILIES:
        what, cure = f"{name!r} is not a family of markers.", f"Known: {', '.join(DICTIONARIES)}."
        raise UsageError("E174", what, where="--dictionary", cure=cure)
    aruco = load_cv2().aruco
    return aruco.getPredefinedDictionary(getattr(aruco, FAMILIES[name][1]))


def modules_across(name: str) -> int:
    """Return how many squares a marker of this family is wide, with its black border."""
    return int(opencv_dictionary(name).markerSize) + 2


def marker_modules(name: str, marker_id: int) -> NDArray[np.bool_]:
    """Return (n, n) squares of a marker, row 0 at its top, True where black; the outermost all are.

    E174 for an id that the family does not have.
    """
    dictionary = opencv_dictionary(name)
    if not 0 <= marker_id < len(dictionary.bytesList):
        what = f"the family {name!r} has no marker {marker_id}."
        cure = f"Its ids are 0 to {len(dictionary.bytesList) - 1}."
        raise UsageError("E174", what, where="--ids", cure=cure)
    across = modules_across(name)
    picture = load_cv2().aruco.generateImageMarker(dictionary, marker_id, across)
    return np.asarray(picture < 128)
