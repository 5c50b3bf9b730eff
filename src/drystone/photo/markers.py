"""Find square markers in a photograph."""

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from drystone.photo.dictionaries import DICTIONARIES, load_cv2, modules_across, opencv_dictionary
from drystone.photo.edges import corners_by_edges

SEARCHES = ((0.05, 0.03), (0.05, 0.02), (0.125, 0.03))
"""How OpenCV looks for quadrangles: how near two may be, and how straight their sides must be.

The edge of the paper is a quadrangle near to the marker's and may be taken for it, by one search
here and by another one there; what any of them reads without a wrong square is a marker.
"""


@dataclass(frozen=True, eq=False)
class FoundMarker:
    """A marker in a photograph.

    Parameters
    ----------
    id : int
        Its number in its family.
    corners_px : (4, 2) float array
        Upper left, upper right, lower right and lower left corner of its pattern (clockwise as
        printed), x to the right and y down.  A pixel is a unit square with its centre at +0.5.
    dictionary : str
        Its family, ``"aruco"`` or ``"apriltag"``.
    """

    id: int
    corners_px: NDArray[np.float64]
    dictionary: str

    @property
    def side_px(self) -> float:
        """Mean length of its sides, px."""
        sides = self.corners_px - np.roll(self.corners_px, 1, axis=0)
        return float(np.hypot(*sides.T).mean())


def find_markers(image: NDArray[np.uint8], dictionary: str = "auto") -> tuple[FoundMarker, ...]:
    """Find markers with the white border around them, in any position.

    Parameters
    ----------
    image : (h, w) or (h, w, 3) uint8 array
        Grey or RGB.
    dictionary : str
        ``"aruco"``, ``"apriltag"``, or ``"auto"``: the family with more markers in the picture.

    Returns
    -------
    markers : tuple of FoundMarker
        In the order of their ids; an id may occur twice.  Empty when there are none.

    Raises
    ------
    UsageError
        E305 without OpenCV, E174 for another dictionary.
    """
    cv2 = load_cv2()
    grey = image if image.ndim == 2 else cv2.cvtColor(image, cv2.COLOR_RGB2GRAY)
    grey = np.ascontiguousarray(grey)
    if dictionary != "auto":
        return _find(grey, dictionary)
    # The patterns of AprilTag have more squares, so of two the same number they are the surer.
    return max((_find(grey, name) for name in reversed(DICTIONARIES)), key=len)


def _find(grey: NDArray[np.uint8], dictionary: str) -> tuple[FoundMarker, ...]:
    across = modules_across(dictionary)
    found = [
        FoundMarker(one, _refined(grey, quad, across), dictionary)
        for one, quad in _quads(grey, dictionary)
    ]
    return tuple(sorted(found, key=lambda marker: (marker.id, *marker.corners_px[0])))


def _quads(grey: NDArray[np.uint8], dictionary: str) -> list[tuple[int, NDArray[Any]]]:
    """Return ids and corners of the patterns that are there, each once."""
    aruco = load_cv2().aruco
    quads: list[tuple[int, NDArray[Any]]] = []
    for distance, accuracy in SEARCHES:
        parameters = aruco.DetectorParameters()
        # Stones are many quadrangles: a pattern with a wrong square is no marker here.
        parameters.errorCorrectionRate = 0.0
        parameters.minMarkerPerimeterRate = min(0.03, 4 * 20.0 / max(grey.shape))
        parameters.minMarkerDistanceRate = distance
        parameters.polygonalApproxAccuracyRate = accuracy
        detector = aruco.ArucoDetector(opencv_dictionary(dictionary), parameters)
        corners, ids, _ = detector.detectMarkers(grey)
        for one, quad in zip([] if ids is None else np.ravel(ids), corners, strict=True):
            placed = int(one), quad.reshape(4, 2)
            if not any(_same(placed, other) for other in quads):
                quads.append(placed)
    return quads


def _same(one: tuple[int, NDArray[Any]], other: tuple[int, NDArray[Any]]) -> bool:
    """Whether two finds are one marker: the same id, one lies over the other."""
    if one[0] != other[0]:
        return False
    apart = np.hypot(*(one[1].mean(axis=0) - other[1].mean(axis=0)))
    return bool(apart < 0.5 * np.hypot(*(other[1][0] - other[1][2])))


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
