"""How an element of SVG is moved: the transform of CSS, which has units, and its origin."""

import math
import re
from collections.abc import Mapping

import numpy as np

from drystone.io.outlines_in.svg_path import bounded
from drystone.io.outlines_in.svg_shapes import (
    TRANSFORM,
    Matrix,
    css_length,
    length,
    matrix_of,
    transform,
    user_units,
)

MOVES = frozenset(
    {"transform", "transform-origin", "transform-box", "translate", "rotate", "scale",
     "offset-path"}
)  # fmt: skip
"""Properties that move an element."""

_UNREAD = ("translate", "rotate", "scale", "offset-path")
_RESET = frozenset({"", "none", "initial", "unset", "revert"})
_DEGREES = {"deg": 1.0, "grad": 0.9, "rad": 180.0 / math.pi, "turn": 360.0}
_COUNTS = {"translate": (1, 2), "scale": (1, 2), "skew": (1, 2), "rotate": (1,), "matrix": (6,)}
"""Of the values of each function that is read."""
_X = {"left": "0%", "center": "50%", "right": "100%"}
_Y = {"top": "0%", "center": "50%", "bottom": "100%"}


def moves(
    style: Mapping[str, str], attributes: Mapping[str, str], view: tuple[float, float] | None
) -> Matrix:
    """Return the transform of an element; ValueError when it cannot be used.

    Parameters
    ----------
    style : mapping
        Its properties by style sheets and its attribute ``style``.
    attributes : mapping
        Its attributes, of which the properties come first.
    view : (float, float), optional
        Width and height that per cents are of, user units.
    """
    for name in _UNREAD:
        if style.get(name, "") not in _RESET:
            raise ValueError(f"the CSS property {name} is not read, only transform")
    said = style.get("transform")
    if said is None:
        matrix = transform(attributes.get("transform", ""))
    else:
        matrix = np.eye(3) if said in _RESET else css_transform(said, view)
    if (matrix == np.eye(3)).all():
        return matrix
    if (style.get("transform-box") or attributes.get("transform-box", "view-box")) != "view-box":
        raise ValueError("its transform-box is not read, only view-box")
    if "transform-origin" in style:
        shift = _origin(style["transform-origin"], view, bare=False)
    else:
        shift = _origin(attributes.get("transform-origin", ""), view, bare=True)
    back = shift.copy()
    back[:2, 2] *= -1.0
    return np.asarray(shift @ matrix @ back)


def css_transform(text: str, view: tuple[float, float] | None = None) -> Matrix:
    """Return the (3, 3) matrix of the CSS property ``transform``.

    Lengths and angles need a unit, as in CSS (see `css_length`).

    Examples
    --------
    >>> css_transform("translate(1in, 5px) scale(2)").tolist()
    [[2.0, 0.0, 96.0], [0.0, 2.0, 5.0], [0.0, 0.0, 1.0]]
    """
    matrix, place, text = np.eye(3), 0, text.rstrip()
    while place < len(text):
        found = TRANSFORM.match(text, place)
        if found is None:
            raise ValueError(f"{text[place:][:30]!r} is no transform")
        words = [word for word in re.split(r"[\s,]+", found[2].strip()) if word]
        matrix = matrix @ _function(found[1].lower(), words, view)
        place = found.end()
    return matrix


def _function(name: str, words: list[str], view: tuple[float, float] | None) -> Matrix:
    """Return the matrix of one function; those along one axis are those along both."""
    axis = name[-1] if name[:-1] in _COUNTS and name[-1] in "xy" else ""
    kind = name[:-1] if axis else name
    if len(words) not in ((1,) if axis else _COUNTS.get(kind, ())):
        raise ValueError(f"the transform {name} of {len(words)} values is not read")
    values = [
        _length(word, axis or "xy"[i], view)
        if kind == "translate"
        else (_angle if kind in {"rotate", "skew"} else _factor)(word)
        for i, word in enumerate(words)
    ]
    if axis:
        still = 1.0 if kind == "scale" else 0.0
        values = [values[0], still] if axis == "x" else [still, values[0]]
    if kind == "skew":
        x, y = (math.tan(math.radians(angle)) for angle in (*values, 0.0)[:2])
        return matrix_of("matrix", [1.0, y, x, 1.0, 0.0, 0.0])
    return matrix_of(kind, values)


def _origin(text: str, view: tuple[float, float] | None, *, bare: bool) -> Matrix:
    """Return the shift to a transform-origin."""
    shift = np.eye(3)
    words = text.lower().split()
    if not words or text in _RESET:
        return shift
    if len(words) == 1:
        words = ["center", *words] if words[0] in {"top", "bottom"} else [*words, "center"]
    if words[0] in {"top", "bottom"} or words[1] in {"left", "right"}:
        words[:2] = words[1::-1]
    shift[0, 2] = _length(_X.get(words[0], words[0]), "x", view, bare=bare)
    shift[1, 2] = _length(_Y.get(words[1], words[1]), "y", view, bare=bare)
    return shift


def _length(text: str, axis: str, view: tuple[float, float] | None, *, bare: bool = False) -> float:
    if not bare:
        css_length(text)
    return user_units({axis: text}, axis, view)


def _factor(text: str) -> float:
    return bounded(text[:-1]) / 100.0 if text.endswith("%") else bounded(text)


def _angle(text: str) -> float:
    """Return degrees."""
    value, unit = length(text)
    if unit not in _DEGREES and (unit or value):
        raise ValueError(f"{text} is no angle of CSS (deg, grad, rad, turn)")
    return value * _DEGREES.get(unit, 1.0)
