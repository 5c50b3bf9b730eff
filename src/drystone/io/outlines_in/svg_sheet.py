"""Style sheets of SVG to rules; what takes long to read is not read twice."""

import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from itertools import chain
from typing import NamedTuple

from drystone.io.outlines_in.svg_geometry import GEOMETRY
from drystone.io.outlines_in.svg_transform import MOVES

_CONCERN = frozenset({"display", "visibility", "opacity", "fill-rule"}) | MOVES | GEOMETRY
_SAID = re.compile(rf"(?<![\w.#-])(?:-webkit-)?(?:{'|'.join(sorted(_CONCERN))})\s*:", re.IGNORECASE)
_COMMENT = re.compile(r"/\*.*?(?:\*/|$)|<!--|-->", re.DOTALL)
_COMPOUND = re.compile(r"([\w-]+|\*)?((?:[#.][\w-]+)*)")
_NEVER = re.compile(
    r"::|:(?:hover|active|focus|focus-within|focus-visible|visited|target|before|after)\b"
)
"""What a drawing at rest never is."""

Weight = tuple[int, int, int]


class Step(NamedTuple):
    """One element of a selector."""

    child: bool
    """Of the element before it, not of any around it."""
    tag: str
    id_names: tuple[str, ...]
    classes: tuple[str, ...]


@dataclass(frozen=True, eq=False)
class Rule:
    """A rule of a style sheet, for one selector."""

    steps: tuple[Step, ...]
    weight: Weight
    place: int
    declared: Mapping[str, tuple[str, bool]]


class Sheets:
    """Rules of all style sheets of a drawing.

    Selectors are tags, classes and ids, also in each other.  What else there is, and says
    whether or where something is shown, is in `unread`.
    """

    def __init__(self) -> None:
        self.rules: list[Rule] = []
        self.unread: list[str] = []

    def read(self, text: str, media: str) -> None:
        """Add the rules of one sheet."""
        text = _COMMENT.sub(" ", text)
        if media not in {"", "all", "screen"}:
            self._leave(f"media {media}", text)
            return
        for prelude, body in _blocks(text):
            if prelude.startswith("@"):
                # What is imported is not here, so there is no knowing what it says.
                self._leave(prelude, "display:" if prelude.startswith("@import") else body)
                continue
            said = declared(body)
            for selector in _selectors(prelude) if said else ():
                # What is in parentheses may be about what is not (:not), or one of several (:is).
                if not _NEVER.search(_outside(selector)):
                    self._rule(selector, said, body)

    def _rule(self, selector: str, said: Mapping[str, tuple[str, bool]], body: str) -> None:
        steps = _steps(selector)
        if not steps:
            self._leave(selector, body)
            return
        weight = (
            sum(len(step.id_names) for step in steps),
            sum(len(step.classes) for step in steps),
            sum(step.tag not in {"", "*"} for step in steps),
        )
        self.rules.append(Rule(steps, weight, len(self.rules), said))

    def _leave(self, what: str, body: str) -> None:
        if _SAID.search(body):
            self.unread.append(" ".join(what.split())[:60])


def declared(body: str) -> dict[str, tuple[str, bool]]:
    """Return values of the properties that concern us, and whether they are important."""
    said: dict[str, tuple[str, bool]] = {}
    for part in _COMMENT.sub(" ", body).split(";"):
        name, _, value = part.partition(":")
        name = name.strip().lower().removeprefix("-webkit-")
        value, mark, _ = value.partition("!")
        is_more = bool(mark) or not said.get(name, ("", False))[1]
        if name in _CONCERN and value.strip() and is_more:
            # Of path data capital letters are other commands.
            value = value.strip() if name == "d" else value.strip().lower()
            said[name] = (value, bool(mark))
    return said


def _blocks(text: str) -> Iterator[tuple[str, str]]:
    """Yield what stands before and in the outermost braces; statements without have none."""
    depth, start, prelude = 0, 0, ""
    for found in re.finditer(r"[{};]", text):
        mark = found[0]
        if mark == ";" and depth == 0:
            yield text[start : found.start()].strip(), ""
            start = found.end()
        elif mark == "{":
            depth += 1
            if depth == 1:
                prelude, start = text[start : found.start()].strip(), found.end()
        elif mark == "}":
            depth = max(0, depth - 1)
            if depth == 0:
                yield prelude, text[start : found.start()]
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
    within: list[list[str]] = [[]]
    for part in re.split(r"([()])", selector):
        if part == "(":
            within.append([part])
        elif part == ")" and len(within) > 1:
            within.pop()
        else:
            within[-1].append(part)
    return "".join(chain.from_iterable(within))


def _steps(selector: str) -> tuple[Step, ...]:
    """Return the elements of a selector; none when it is not read."""
    steps: list[Step] = []
    child = False
    for word in selector.replace(">", " > ").split():
        if word == ">" and steps and not child:
            child = True
            continue
        found = _COMPOUND.fullmatch(word)
        if found is None:
            return ()
        names = re.findall(r"([#.])([\w-]+)", found[2])
        ids = tuple(name for mark, name in names if mark == "#")
        classes = tuple(name for mark, name in names if mark == ".")
        steps.append(Step(child, found[1] or "", ids, classes))
        child = False
    return () if child else tuple(steps)
