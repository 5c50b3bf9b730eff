"""Style of SVG: what style sheets and style attributes say of being shown, and of moving."""

import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import NamedTuple
from xml.etree import ElementTree as ET

from drystone.errors import Notice
from drystone.io.outlines_in.svg_geometry import GEOMETRY
from drystone.io.outlines_in.svg_transform import MOVES

_CONCERN = frozenset({"display", "visibility", "opacity", "fill-rule"}) | MOVES | GEOMETRY
_SAID = re.compile(rf"(?<![\w.#-])(?:-webkit-)?(?:{'|'.join(sorted(_CONCERN))})\s*:", re.IGNORECASE)
_COMMENT = re.compile(r"/\*.*?(?:\*/|$)|<!--|-->", re.DOTALL)
_COMPOUND = re.compile(r"(>?)([\w-]+|\*)?((?:[#.][\w-]+)*)")
_NEVER = re.compile(
    r"::|:(?:hover|active|focus|focus-within|focus-visible|visited|target|before|after)\b"
)
"""What a drawing at rest never is."""
_SHOWN = 8

_Weight = tuple[int, int, int]


class _Step(NamedTuple):
    """One element of a selector."""

    child: bool
    """Of the element before it, not of any around it."""
    tag: str
    id_names: tuple[str, ...]
    classes: tuple[str, ...]


class _Said(NamedTuple):
    """What is said of a property; the greatest counts."""

    important: bool
    weight: _Weight
    place: int
    value: str


@dataclass(frozen=True, eq=False)
class _Rule:
    """A rule of a style sheet, for one selector."""

    steps: tuple[_Step, ...]
    weight: _Weight
    declared: Mapping[str, tuple[str, bool]]


class Styles:
    """Properties of elements by the style sheets in a drawing and by their attribute style.

    Selectors are tags, classes and ids, also in each other.  What else there is, and says
    whether or where something is shown, is in `unread`.
    """

    def __init__(self, root: ET.Element) -> None:
        self.parents = {child: parent for parent in root.iter() for child in parent}
        self.rules: list[_Rule] = []
        self.unread: list[str] = []
        for element in root.iter():
            if tag(element) == "style":
                self._read(element)

    def of(self, element: ET.Element, top: ET.Element | None = None) -> dict[str, str]:
        """Return the properties of an element that decide whether and where it is shown.

        Parameters
        ----------
        element : Element
            Any one of the drawing.
        top : Element, optional
            What a ``use`` shows, when the element is shown by that.  Selectors see nothing
            around it, neither where it stands nor where it is shown (SVG 2, 5.6: the tree that
            is shown is a shadow tree with its own copies of the style sheets).
        """
        best: dict[str, _Said] = {}
        own = _Rule((), (1 << 30, 0, 0), _declared(element.get("style", "")))
        fitting = [rule for rule in self.rules if self._fits(element, rule.steps, top)]
        for place, rule in enumerate([*fitting, own]):
            for name, (value, important) in rule.declared.items():
                said = _Said(important, rule.weight, place, value)
                best[name] = max(said, best.get(name, said))
        return {name: said.value for name, said in best.items()}

    def notices(self) -> list[Notice]:
        """Say which rules were not read (W119)."""
        if not self.unread:
            return []
        shown = ", ".join(self.unread[:_SHOWN]) + (" …" if len(self.unread) > _SHOWN else "")
        text = f"rules of style sheets that may hide or move something were not read: {shown}."
        return [Notice("W119", text, "Say it by attributes of the elements, or delete the rules.")]

    def _read(self, sheet: ET.Element) -> None:
        text = _COMMENT.sub(" ", "".join(sheet.itertext()))
        media = sheet.get("media", "all").strip().lower()
        if media not in {"", "all", "screen"}:
            self._leave(f"media {media}", text)
            return
        for prelude, body in _blocks(text):
            if prelude.startswith("@"):
                # What is imported is not here, so there is no knowing what it says.
                self._leave(prelude, "display:" if prelude.startswith("@import") else body)
                continue
            declared = _declared(body)
            for selector in _selectors(prelude) if declared else ():
                # What is in parentheses may be about what is not (:not), or one of several (:is).
                if not _NEVER.search(_outside(selector)):
                    self._rule(selector, declared, body)

    def _rule(self, selector: str, declared: Mapping[str, tuple[str, bool]], body: str) -> None:
        steps = _steps(selector)
        if not steps:
            self._leave(selector, body)
            return
        weight = (
            sum(len(step.id_names) for step in steps),
            sum(len(step.classes) for step in steps),
            sum(step.tag not in {"", "*"} for step in steps),
        )
        self.rules.append(_Rule(steps, weight, declared))

    def _leave(self, what: str, body: str) -> None:
        if _SAID.search(body):
            self.unread.append(" ".join(what.split())[:60])

    def _fits(self, element: ET.Element, steps: tuple[_Step, ...], top: ET.Element | None) -> bool:
        *before, step = steps
        classes = element.get("class", "").split()
        if step.tag not in {"", "*", tag(element)} or not set(step.classes) <= set(classes):
            return False
        if any(name != element.get("id") for name in step.id_names):
            return False
        around = list(self._around(element, top)) if before else []
        return not before or any(
            self._fits(one, tuple(before), top) for one in (around[:1] if step.child else around)
        )

    def _around(self, element: ET.Element, top: ET.Element | None) -> Iterator[ET.Element]:
        while element is not top and (parent := self.parents.get(element)) is not None:
            yield parent
            element = parent


def tag(element: ET.Element) -> str:
    """Return the name of an element without its namespace."""
    return element.tag.rpartition("}")[2]


def _blocks(text: str) -> Iterator[tuple[str, str]]:
    """Yield what stands before and in the outermost braces; statements without have none."""
    depth, start, prelude = 0, 0, ""
    for found in re.finditer(r"[{};]", text):
        mark, here = found[0], text[start : found.start()]
        if mark == ";" and depth == 0:
            yield here.strip(), ""
            start = found.end()
        elif mark == "{":
            depth += 1
            if depth == 1:
                prelude, start = here.strip(), found.end()
        elif mark == "}":
            depth = max(0, depth - 1)
            if depth == 0:
                yield prelude, here
                start = found.end()
    if depth:
        yield prelude, text[start:]


def _selectors(prelude: str) -> Iterator[str]:
    """Yield the selectors of a rule, which have commas between them, and may have some within."""
    depth, start = 0, 0
    for found in re.finditer(r"[(),]", prelude):
        if found[0] == "," and depth == 0:
            yield prelude[start : found.start()].strip()
            start = found.end()
        elif found[0] != ",":
            depth += 1 if found[0] == "(" else -1
    yield prelude[start:].strip()


def _outside(selector: str) -> str:
    """Return a selector without all that is in parentheses."""
    count = 1
    while count:
        selector, count = re.subn(r"\([^()]*\)", "", selector)
    return selector


def _steps(selector: str) -> tuple[_Step, ...]:
    """Return the elements of a selector; none when it is not read."""
    steps: list[_Step] = []
    for word in re.sub(r"\s*>\s*", " >", selector).split():
        found = _COMPOUND.fullmatch(word)
        if found is None or not (found[2] or found[3]) or (found[1] and not steps):
            return ()
        names = re.findall(r"([#.])([\w-]+)", found[3])
        ids = tuple(name for mark, name in names if mark == "#")
        classes = tuple(name for mark, name in names if mark == ".")
        steps.append(_Step(bool(found[1]), found[2] or "", ids, classes))
    return tuple(steps)


def _declared(body: str) -> dict[str, tuple[str, bool]]:
    """Return values of the properties that concern us, and whether they are important."""
    declared: dict[str, tuple[str, bool]] = {}
    for part in _COMMENT.sub(" ", body).split(";"):
        name, _, value = part.partition(":")
        name = name.strip().lower().removeprefix("-webkit-")
        value, mark, _ = value.partition("!")
        is_more = bool(mark) or not declared.get(name, ("", False))[1]
        if name in _CONCERN and value.strip() and is_more:
            # Of path data capital letters are other commands.
            value = value.strip() if name == "d" else value.strip().lower()
            declared[name] = (value, bool(mark))
    return declared
