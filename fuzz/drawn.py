"""Changes of drawings by their elements (SVG) and groups (DXF)."""

import copy
from collections.abc import Sequence
from random import Random
from xml.etree import ElementTree as ET

from fuzz.raw import GENTLE, NUMBERS, ODD, STRANGE, words

_SVG = "{http://www.w3.org/2000/svg}"
_TAGS = ("g", "path", "rect", "use", "svg", "defs", "symbol", "style", "circle", "polygon", "image")
_ATTRIBUTES = {
    "transform": ("scale(0)", "matrix(1 0 0 0 0 0)", "rotate(1e300)", "scale(1e9)", "skewX(90)"),
    "viewBox": ("0 0 0 0", "0 0 1e-9 1", "0 0 1e9 1e9", "1 2 3"), "points": ("1,2", "0 0 9 9 9 0"),
    "width": ("100%", "1e9mm", "-1", "calc(1px)", "5em", "9" * 9000),
    "d": ("M0 0h9v9z" * 400, "M0 0a1 1 0 0 0 1e9 1z", "M0 0c", "M1e308 0l-1e308 9 9 9z", "z", "m"),
    "style": ("display:none", "a:b;" * 900, "fill-rule:evenodd", ";;:", "transform:scale(2)"),
    "href": ("#stone_7", "#a", "a.svg#b", "#"), "id": ("stone_7", "stones", "a", ""),
    "class": ("a", "a " * 900), "visibility": ("hidden",), "fill-rule": ("evenodd",),
}  # fmt: skip
_STYLES = (
    "* * * * * * * * a{fill:red}", "g>g>g g g>g g path{display:none}", ".a.a.a#b[c]{d:e}" * 50,
    "@media x{", "a,b,c{}" * 999, "/*", "{}", "g path,g>path{visibility:hidden}",
)  # fmt: skip


def change_svg(data: bytes, rng: Random, pool: Sequence[bytes]) -> bytes:
    """Change an element of a drawing, an attribute, or what it lies in."""
    root = ET.fromstring(data)  # noqa: S314 - our own
    parents = [(parent, i) for parent in root.iter() for i in range(len(parent))]
    parent, i = rng.choice(parents)
    element = parent[i]
    draw = rng.randrange(10)
    if draw == 0:
        del parent[i]
    elif draw == 1:
        for _ in range(rng.choice((1, 2, 300))):
            parent.insert(i, element)
    elif draw == 2:
        new = ET.Element(_SVG + rng.choice(_TAGS))
        new.text = rng.choice((*_STYLES, None))
        parent.insert(i, new)
    elif draw == 3:
        inner = copy.copy(element)
        for _ in range(rng.choice((1, 2, 70, 900))):
            outer = ET.Element(_SVG + rng.choice(_TAGS[:5]))
            outer.append(inner)
            inner = outer
        parent[i] = inner
    elif draw == 4:
        element.tag = _SVG + rng.choice(_TAGS)
    elif draw == 5 and element.text:
        element.text = rng.choice(_STYLES)
    elif draw < 8 or not element.attrib:
        name = rng.choice([*_ATTRIBUTES])
        element.set(name, rng.choice(_ATTRIBUTES[name]))
    else:
        name = rng.choice([*element.attrib])
        change = rng.choice((*GENTLE[:3], words))
        element.set(name, change(element.get(name, "").encode(), rng, pool).decode("latin-1"))
    return ET.tostring(root)


def change_dxf(data: bytes, rng: Random, pool: Sequence[bytes]) -> bytes:
    """Change some groups of a drawing in text: their codes, values, or where they stand."""
    rows = data.splitlines()
    groups = list(zip(rows[::2], rows[1::2], strict=False))
    for _ in range(rng.choice((1, 1, 3))):
        i = rng.randrange(len(groups))
        code, value = groups[i]
        draw = rng.randrange(10)
        size = rng.choice((1, 1, 4, 20))
        if draw == 0:
            del groups[i : i + size]
        elif draw == 1:
            groups[i:i] = groups[i : i + size] * rng.choice((1, 2, 100))
        elif draw == 2:
            j = rng.randrange(len(groups))
            groups[i:i] = groups[j : j + size]
        elif draw == 3:
            groups[i] = rng.choice(groups)[0], value
        elif draw < 7:
            groups[i] = code, rng.choice((*NUMBERS, *STRANGE, *ODD)).encode("utf-8", "replace")
        else:
            groups[i] = code, rng.choice(GENTLE[:3])(value, rng, pool)
    return b"".join(code + b"\n" + value + b"\n" for code, value in groups)
