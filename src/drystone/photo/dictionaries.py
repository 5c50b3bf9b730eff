"""The two families of markers, and OpenCV, which knows their patterns."""

from importlib import import_module
from typing import Any

import numpy as np
from numpy.typing import NDArray

from drystone.errors import UsageError

DICTIONARIES = {"aruco": "DICT_4X4_50", "apriltag": "DICT_APRILTAG_36h11"}
"""Name of a family here and in OpenCV."""

FAMILIES = {"aruco": "ArUco 4x4_50", "apriltag": "AprilTag 36h11"}
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
    if name not in DICTIONARIES:
        what, cure = f"{name!r} is no family of markers.", f"Known: {', '.join(DICTIONARIES)}."
        raise UsageError("E174", what, where="--dictionary", cure=cure)
    aruco = load_cv2().aruco
    return aruco.getPredefinedDictionary(getattr(aruco, DICTIONARIES[name]))


def id_count(name: str) -> int:
    """Return how many markers a family has: their ids are 0 to one less."""
    return len(opencv_dictionary(name).bytesList)


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
