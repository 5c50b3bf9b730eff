"""The families of markers, and OpenCV, which knows their patterns."""

from importlib import import_module
from typing import Any

import numpy as np
from numpy.typing import NDArray

from drystone.errors import UsageError

DICTIONARIES = {"aruco": "DICT_4X4_50", "apriltag": "DICT_APRILTAG_36h11"}
"""Name of a family that is printed, here and in OpenCV."""

OTHERS = {
    "aruco5x5": "DICT_5X5_1000",
    "aruco6x6": "DICT_6X6_1000",
    "aruco7x7": "DICT_7X7_1000",
    "original": "DICT_ARUCO_ORIGINAL",
    "mip36h12": "DICT_ARUCO_MIP_36h12",
    "apriltag25h9": "DICT_APRILTAG_25h9",
    "apriltag36h10": "DICT_APRILTAG_36h10",
    "aruco4x4": "DICT_4X4_1000",
    "apriltag16h5": "DICT_APRILTAG_16h5",
}
"""Families that are read where there is none of the printed ones; the smaller dictionaries of
OpenCV are the first ids of these."""

FAMILIES = {
    "aruco": "ArUco 4x4_50",
    "apriltag": "AprilTag 36h11",
    "aruco5x5": "ArUco 5x5",
    "aruco6x6": "ArUco 6x6",
    "aruco7x7": "ArUco 7x7",
    "original": "ArUco Original",
    "mip36h12": "ArUco MIP 36h12",
    "apriltag25h9": "AprilTag 25h9",
    "apriltag36h10": "AprilTag 36h10",
    "aruco4x4": "ArUco 4x4",
    "apriltag16h5": "AprilTag 16h5",
}
"""Name of a family for people."""


def load_cv2() -> Any:
    """Return OpenCV; it is an extra, so it is loaded only when it is needed (E305 without it)."""
    try:
        return import_module("cv2")
    except ImportError as error:
        raise UsageError(
            "E305",
            "OpenCV (cv2) is not installed, and it knows the markers and turns pictures.",
            where="photo",
            cure="Install it with `pip install drystone[photo]`.",
        ) from error


def opencv_dictionary(name: str) -> Any:
    """Return OpenCV's dictionary of a family; E174 for a name that is none."""
    known = DICTIONARIES | OTHERS
    if name not in known:
        what, cure = f"{name!r} is not a family of markers.", f"Known: {', '.join(DICTIONARIES)}."
        raise UsageError("E174", what, where="--dictionary", cure=cure)
    aruco = load_cv2().aruco
    return aruco.getPredefinedDictionary(getattr(aruco, known[name]))


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
    across = int(dictionary.markerSize) + 2
    picture = load_cv2().aruco.generateImageMarker(dictionary, marker_id, across)
    black: NDArray[np.bool_] = np.asarray(picture) < 128
    return black
