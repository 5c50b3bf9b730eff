"""What the style of an SVG hides and fills; where it would move or shape, it is refused."""

import re
from collections.abc import Iterator, Mapping
from xml.etree import ElementTree as ET

SEEN = frozenset(
    {"display", "visibility", "opacity", "fill", "fill-rule", "stroke", "clip-path", "mask"}
)
"""Properties that say whether a shape is seen, and what of it is filled."""
_ASIDE = frozenset({"clip-rule"})
"""Those that say so only together with others; a rule of another kind is passed over."""

_MOVING = {
    "transform", "translate", "rotate", "scale", "offset", "offset-path", "zoom",
    "x", "y", "cx", "cy", "r", "rx", "ry", "d",
}  # fmt: skip
_SIZES = {"width", "height"}
NOTHING = {"", "none", "initial", "unset", "revert", "auto"}
"""Values that say nothing."""
_COMMENT = re.compile(r"/\*.*?(?:\*/|$)", re.DOTALL)
_RULE = re.compile(r"([^{}]*+)\{([^{}]*+)\}")
_SIMPLE = re.compile(r"(\*|[\w-]*+)([.#][\w-]++)?+")
_PLAIN = "Save it as plain SVG, with attributes instead of styles."


class Styles:
    """Properties of elements by simple rules of style sheets, by `style`, and by attributes.

    ValueError where a rule that may hide, fill, move or shape has a selector that is more than a
    tag, a class or an id, or stands under a condition.
    """

    def __init__(self, root: ET.Element) -> None:
        # Of every selector: each property, how much its rule weighs, and its value.
        self._said: dict[str, dict[str, tuple[tuple[int, int], str]]] = {}
        place = 0
        for element in root.iter():
            if tag(element) != "style":
                continue
            media = element.get("media", "all").strip().lower()
            condition = "" if media in {"all", "screen"} else f"media {media}"
            for selector, said in _rules("".join(element.itertext()), condition):
                place += 1
                of_tag = selector[0] not in "*.#"
                weight = (4 * selector.count("#") + 2 * selector.count(".") + of_tag, place)
                known = self._said.setdefault(selector, {})
                known.update({name: (weight, value) for name, value in said.items()})

    def of(self, element: ET.Element) -> dict[str, str]:
        """Return the properties of an element; ValueError where its style moves or shapes it."""
        kind = tag(element)
        names = [f".{name}" for name in element.get("class", "").split()]
        names += [f"#{element.get('id')}"] if element.get("id") else []
        keys = ["*", kind, *names, *(f"{kind}{name}" for name in names)]
        best: dict[str, tuple[tuple[int, int], str]] = {}
        for key in keys:
            for name, said in self._said.get(key, {}).items():
                best[name] = max(said, best.get(name, said))
        properties = {
            name: element.get(name, "").strip() for name in SEEN | _ASIDE if element.get(name)
        }
        properties |= {name: value for name, (_, value) in best.items()}
        properties |= declared(element.get("style", ""))
        # The size of the page by its style is how a window shows it.
        shaping = _MOVING if kind in {"svg", "g"} else _MOVING | _SIZES
        for name in sorted(shaping & properties.keys()):
            if properties[name] not in NOTHING or element.get(name):
                raise ValueError(f"its style says {name}, which is read as an attribute only")
        return {k: v for k, v in properties.items() if v not in {"inherit", "unset"}}


def declared(body: str) -> dict[str, str]:
    """Return the properties of a declaration block."""
    pairs = (part.partition(":") for part in _COMMENT.sub("", body).split(";"))
    return {
        name.strip().lower().removeprefix("-webkit-"): value.partition("!")[0].strip()
        for name, _, value in pairs
        if value
    }


def _rules(text: str, condition: str) -> Iterator[tuple[str, Mapping[str, str]]]:
    """Yield the simple selectors of a sheet with what they say of shapes."""
    text = _COMMENT.sub("", text)
    at_rule = re.search(r"@(?!font-face|charset|namespace)[\w-]+", text)
    condition = condition or (at_rule[0] if at_rule else "")
    for prelude, body in _RULE.findall(text):
        said = {k: v for k, v in declared(body).items() if k in SEEN | _ASIDE | _MOVING | _SIZES}
        selectors = [one.strip() for one in prelude.rpartition(";")[2].split(",")]
        if not said or selectors == ["@font-face"]:
            continue
        for selector in selectors:
            if condition or not selector or not _SIMPLE.fullmatch(selector):
                what = (condition or selector)[:30]
                if not said.keys() - _ASIDE:
                    continue
                first = min(said.keys() - _ASIDE)
                raise ValueError(f"its style sheet says {first} for {what!r}. {_PLAIN}")
            yield selector.removeprefix("*") if selector[1:] else selector, said


def tag(element: ET.Element) -> str:
    """Return the name of an element without its namespace."""
    return str(element.tag).rpartition("}")[2]
