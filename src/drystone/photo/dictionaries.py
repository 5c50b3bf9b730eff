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
    """Return OpenCV; it is an extra, so it is loaded only when it is needed.

    Raises
    ------
    UsageError
        E305 when it is not installed.
    """
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
    """Return OpenCV's dictionary of a family; E174 for a name that is none.

    Parameters
    ----------
    name : str
        A key of `DICTIONARIES`.
    """
    if name not in DICTIONARIES:
        raise UsageError(
            "E174",
            f"{name!r} is no family of markers.",
            where="--dictionary",
            cure=f"Known: {', '.join(DICTIONARIES)}.",
        )
    aruco = load_cv2().aruco
    return aruco.getPredefinedDictionary(getattr(aruco, DICTIONARIES[name]))


def id_count(name: str) -> int:
    """Return how many markers a family has: their ids are 0 to one less."""
    return len(opencv_dictionary(name).bytesList)


def modules_across(name: str) -> int:
    """Return how many squares a marker of this family is wide, with its black border."""
    return int(opencv_dictionary(name).markerSize) + 2


def marker_modules(name: str, marker_id: int) -> NDArray[np.bool_]:
    """Return the squares of a marker, row 0 at its top.

    Parameters
    ----------
    name : str
        A key of `DICTIONARIES`.
    marker_id : int
        From 0 to ``id_count(name) - 1``.

    Returns
    -------
    black : (n, n) bool array
        True where a square is black; the outermost ones all are.

    Raises
    ------
    UsageError
        E174 an id that the family does not have.

    Examples
    --------
    >>> marker_modules("aruco", 0).shape
    (6, 6)
    """
    dictionary = opencv_dictionary(name)
    if not 0 <= marker_id < len(dictionary.bytesList):
        raise UsageError(
            "E174",
            f"the family {name!r} has no marker {marker_id}.",
            where="--ids",
            cure=f"Its ids are 0 to {len(dictionary.bytesList) - 1}.",
        )
    across = int(dictionary.markerSize) + 2
    picture = load_cv2().aruco.generateImageMarker(dictionary, marker_id, across)
    black: NDArray[np.bool_] = np.asarray(picture) < 128
    return black
