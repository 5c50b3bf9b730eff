"""Style of SVG: what style sheets and style attributes say of being shown, and of moving."""

from collections import defaultdict
from collections.abc import Iterator, Sequence
from typing import NamedTuple
from xml.etree import ElementTree as ET

from drystone.errors import Notice
from drystone.io.listed import listed
from drystone.io.outlines_in.model import damaged
from drystone.io.outlines_in.svg_sheet import Rule, Sheets, Step, Weight, declared

_MOST_STEPS = 300_000
"""Comparisons of an element with a step of a selector: each takes some microseconds."""


class _Said(NamedTuple):
    """What is said of a property; the greatest counts."""

    important: bool
    weight: Weight
    place: int
    value: str


class Styles:
    """Properties of elements by the style sheets in a drawing and by their attribute style.

    Parameters
    ----------
    root : Element
        The drawing.
    where : str
        Its name, for messages.
    """

    def __init__(self, root: ET.Element, where: str) -> None:
        self.where = where
        self.parents = {child: parent for parent in root.iter() for child in parent}
        self.sheets = Sheets()
        for element in root.iter():
            if tag(element) == "style":
                media = element.get("media", "all").strip().lower()
                self.sheets.read("".join(element.itertext()), media)
        self._by_name: dict[str, list[Rule]] = defaultdict(list)
        for rule in self.sheets.rules:
            self._by_name[_name_of(rule.steps[-1])].append(rule)
        self._classes: dict[ET.Element, frozenset[str]] = {}
        self._left = _MOST_STEPS

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

        Raises
        ------
        InputError
            E114 when there are too many elements for so many selectors.
        """
        best: dict[str, _Said] = {}
        own = Rule((), (1 << 30, 0, 0), len(self.sheets.rules), declared(element.get("style", "")))
        for rule in (*self._fitting(element, top), own):
            for name, (value, important) in rule.declared.items():
                said = _Said(important, rule.weight, rule.place, value)
                best[name] = max(said, best.get(name, said))
        return {name: said.value for name, said in best.items()}

    def notices(self) -> list[Notice]:
        """Say which rules were not read (W119)."""
        unread = self.sheets.unread
        if not unread:
            return []
        what = "rules of style sheets that may hide or move something were not read"
        text = f"{what}: {listed(unread)}."
        return [Notice("W119", text, "Say it by attributes of the elements, or delete the rules.")]

    def _fitting(self, element: ET.Element, top: ET.Element | None) -> Iterator[Rule]:
        """Yield the rules for an element; most are told by the name of their last step."""
        names = ("*", tag(element), f"#{element.get('id')}", *map(".{}".format, self._own(element)))
        rules = [rule for name in names for rule in self._by_name.get(name, ())]
        if not rules:
            return
        whole = [*self._around(element, top)][::-1]
        for rule in rules:
            path = whole if len(rule.steps) > 1 else [element]
            self._left -= len(rule.steps) * len(path)
            if self._left < 0:
                what = "it has too many elements for so many and such long selectors of styles"
                raise damaged(self.where, what)
            if self._fits(path, rule.steps):
                yield rule

    def _fits(self, path: Sequence[ET.Element], steps: tuple[Step, ...]) -> bool:
        """Say whether a selector is of the last element of a path, by one walk along it."""
        here = above = [False] * len(steps)
        for element in path:
            # The steps before one must fit the element before, or any before it.
            led = zip(steps, [True, *here[:-1]], [True, *above[:-1]], strict=True)
            here = [
                (next_to if step.child else anywhere) and self._is(element, step)
                for step, next_to, anywhere in led
            ]
            above = [one or other for one, other in zip(above, here, strict=True)]
        return here[-1]

    def _is(self, element: ET.Element, step: Step) -> bool:
        return (
            step.tag in {"", "*", tag(element)}
            and self._own(element).issuperset(step.classes)
            and all(name == element.get("id") for name in step.id_names)
        )

    def _own(self, element: ET.Element) -> frozenset[str]:
        """Return the classes of an element."""
        if element not in self._classes:
            self._classes[element] = frozenset(element.get("class", "").split())
        return self._classes[element]

    def _around(self, element: ET.Element, top: ET.Element | None) -> Iterator[ET.Element]:
        """Yield an element and all around it, up to the top."""
        yield element
        while element is not top and (parent := self.parents.get(element)) is not None:
            yield parent
            element = parent


def _name_of(step: Step) -> str:
    """Return the name that only elements of a step can have."""
    if step.id_names:
        return f"#{step.id_names[0]}"
    return f".{step.classes[0]}" if step.classes else step.tag


def tag(element: ET.Element) -> str:
    """Return the name of an element without its namespace."""
    return element.tag.rpartition("}")[2]
