"""Geometry of SVG by CSS: the properties that say where a shape is, and how large."""

import re
from collections.abc import Mapping

from drystone.io.outlines_in.svg_shapes import UNITS_M, css_length, length

_BOX = ("x", "y", "width", "height")
_OF = {
    "circle": ("cx", "cy", "r"),
    "ellipse": ("cx", "cy", "rx", "ry"),
    "path": ("d",),
    "rect": (*_BOX, "rx", "ry"),
    "use": ("x", "y"),
}
"""What counts for an element; elsewhere these properties do nothing."""
_OF_VIEWPORT = {"svg": _BOX, "symbol": _BOX, "use": ("width", "height")}
GEOMETRY = frozenset(name for names in _OF.values() for name in names)
"""Properties that say where a shape is, and how large."""

_RESET = frozenset({"initial", "unset", "revert"})
_WITH_AUTO = frozenset({"width", "height", "rx", "ry"})
_SIZES = _WITH_AUTO | {"r"}
_PATH = re.compile(r"path\(\s*(?:\"([^\"\\]*)\"|'([^'\\]*)')\s*\)", re.IGNORECASE)


def with_geometry(
    kind: str, style: Mapping[str, str], attributes: Mapping[str, str]
) -> Mapping[str, str]:
    """Return the attributes of an element with what its style says instead of them.

    Parameters
    ----------
    kind : str
        Its name, which decides what properties count.
    style : mapping
        Its properties by style sheets and its attribute ``style``; ValueError for what is
        neither a length nor a path.
    attributes : mapping
        Its own.

    Examples
    --------
    >>> with_geometry("circle", {"r": "60px", "x": "5px"}, {"r": "10", "cx": "80"})
    {'r': '60px', 'cx': '80'}
    """
    return _merged(_OF.get(kind, ()), style, attributes)


def root_geometry(style: Mapping[str, str], attributes: Mapping[str, str]) -> Mapping[str, str]:
    """Return the attributes of the root with the width and height of its style.

    A share of a window (``100%``, ``auto``) is how a web page shows the drawing, and says nothing
    against its attribute; px where the attribute has mm do, which is a ValueError.
    """
    merged = dict(_merged(("width", "height"), style, attributes))
    for name in ("width", "height"):
        own, shown = _known(attributes.get(name)), _known(merged.get(name))
        if own and not shown:
            merged[name] = attributes[name]
        elif shown < own:
            raise ValueError(f"its {name} is {attributes[name]}, and {style[name]} by its style")
    return merged


def check_viewport(kind: str, style: Mapping[str, str], attributes: Mapping[str, str]) -> None:
    """Refuse a viewport of which the style says another size or place (ValueError).

    By SVG 2 the style counts, in browsers the attributes.
    """
    names = tuple(name for name in _OF_VIEWPORT.get(kind, ()) if name in style)
    merged = _merged(names, style, attributes)
    for name in names:
        before, after = (_told(kind, name, one.get(name)) for one in (attributes, merged))
        if before != after:
            raise ValueError(f"the CSS property {name} is not read here, only the attribute")


def _merged(
    names: tuple[str, ...], style: Mapping[str, str], attributes: Mapping[str, str]
) -> Mapping[str, str]:
    said = {name: style[name] for name in names if name in style}
    if not said:
        return attributes
    merged = dict(attributes)
    for name, value in said.items():
        text = _attribute(name, value)
        if text is None:
            merged.pop(name, None)
        else:
            merged[name] = text
    return merged


def _attribute(name: str, value: str) -> str | None:
    """Return the attribute that says what a property says; None when it is as without one."""
    if value.lower() in _RESET or (name in _WITH_AUTO and value == "auto"):
        return None
    if name == "d":
        found = _PATH.fullmatch(value)
        if found is None and value.lower() != "none":
            raise ValueError(f"the CSS property d is read as path('...') only, not {value[:30]!r}")
        return (found[1] or found[2] or "") if found else "none"
    try:
        number, _ = css_length(value)
    except ValueError as error:
        raise ValueError(f"the CSS property {name}: {error}") from error
    if number < 0.0 and name in _SIZES:
        # Browsers take the next best rule, or the attribute; that was hardly meant.
        raise ValueError(f"the CSS property {name} is below 0")
    return value


def _known(text: str | None) -> int:
    """Tell how much a length says: 2 for one on paper, 1 for px, 0 for a share of a window."""
    unit = length(text or "100%")[1]
    return 2 if unit in UNITS_M else int(unit != "%")


def _told(kind: str, name: str, text: str | None) -> tuple[float, str] | None:
    """Return number and unit of what an attribute says, or what it is without one."""
    if text is None or text == "auto":
        if kind == "use":
            return None
        text = "100%" if name in _WITH_AUTO else "0"
    value, unit = length(text)
    return value, unit if value and unit != "px" else ""
