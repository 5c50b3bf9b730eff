"""A table or figure of the paper that can be made again."""

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from types import MappingProxyType
from typing import Any, NamedTuple

from matplotlib.figure import Figure, SubFigure

from drystone.model.wall import Wall
from drystone.selection.policies.table1 import MARKS
from drystone_lab import timed_walls
from drystone_lab.reproduce.cells import COLUMNS, METRICS, WINS
from drystone_lab.runs.outcome import Runner, RunOutcome
from drystone_lab.runs.spec import RunSpec
from drystone_lab.table import Rows, Table, worded

COLUMN_SETS: Mapping[str, tuple[str, ...]] = MappingProxyType(
    {
        "<metrics>": METRICS, "<summary>": COLUMNS, "<wins>": WINS, "<policies>": tuple(MARKS),
        "<parts>": timed_walls.COLUMNS,
    }
)  # fmt: skip
"""Columns that several tables have, by their name in ``paper.toml``."""

VERDICTS = MappingProxyType({True: "Agrees", False: "Differs", None: "Cannot be told"})


@dataclass(frozen=True, eq=False)
class Context:
    """What an item is made with."""

    runner: Runner  # Does and keeps runs; `runner.data` is the folder of the published data or None
    # A smaller version: the same kind of walls, fewer or smaller ones, a minute of one core at most
    quick: bool = False
    seed: int = 1  # Of all random choices, or the first of several
    asked: list[RunSpec] = field(default_factory=list)  # Runs so far: what the item is made of

    @property
    def data(self) -> Path | None:
        """Folder of the published data."""
        return self.runner.data

    def run(self, specs: Sequence[RunSpec]) -> tuple[RunOutcome, ...]:
        """Return the outcomes of runs, in their order."""
        self.asked.extend(specs)
        return self.runner.run(specs)

    def wall(self, spec: RunSpec) -> Wall:
        """Return the finished wall of a run."""
        (outcome,) = self.run((spec,))
        return outcome.wall(spec, self.data)


class ItemFigure(NamedTuple):
    """A picture; written as NAME.png and NAME.svg."""

    name: str
    figure: Figure | SubFigure
    # What its caption is formatted with, that of the longest key with which its name begins; None
    # for what the study found.  Of a finished item the caption itself
    about: Any = None


@dataclass(frozen=True, eq=False)
class Output:
    """What an item came to."""

    # What we found, in sentences whose numbers are computed, and why it differs; a paragraph each
    ours: tuple[str, ...]
    # Name of the CSV file without ending, and the table.  Equal seeds give equal tables on every
    # machine: no times are in them
    tables: tuple[tuple[str, Table], ...]
    # Tables of measured times, which differ from machine to machine and run to run
    times: tuple[tuple[str, Table], ...]
    pictures: tuple[ItemFigure, ...]
    runs: tuple[RunSpec, ...]  # That the item is made of, for its JSON


class Claimed(NamedTuple):
    """A claim of the paper, and what our walls say of it."""

    key: str  # In ``paper.toml``, where claim and finding are written
    holds: bool | None  # Whether they agree; None where that cannot be told
    values: Mapping[str, object]  # What both are formatted with


@dataclass(frozen=True, kw_only=True)
class PaperItem:
    """A table or figure of the paper: data, and what is read off it."""

    # Does what the item is about: builds walls (:class:`~drystone_lab.reproduce.study.Study`) or
    # times them.  All others take what it returns
    study: Callable[[Context], Any]
    # Compares what was found with claims of the paper; they are a table too
    claims: Callable[[Any], Iterable[Claimed]] = lambda _: ()
    # tables, times: By the name of the CSV file; times differ from machine to machine
    tables: Mapping[str, Callable[[Any], Rows]] = field(default_factory=dict)
    times: Mapping[str, Callable[[Any], Rows]] = field(default_factory=dict)
    pictures: Callable[[Any], Iterable[ItemFigure]] = lambda _: ()  # Draws
    words: Mapping[str, Any] = field(default_factory=dict)  # Of ``paper.toml``

    @property
    def needs(self) -> tuple[str, ...]:
        """Published stones without which it cannot be made, as paths in their folder."""
        return tuple(self.words.get("needs", ()))

    def make(self, context: Context) -> Output:
        """Do the study, and read everything off it."""
        context = replace(context, asked=[])
        found = self.study(context)
        tables, times = (
            [
                (name, worded(self.words[kind][name], rows(found), found, columns=COLUMN_SETS))
                for name, rows in of.items()
            ]
            for kind, of in (("tables", self.tables), ("times", self.times))
        )
        texts = self.words.get("claims", {})
        checked = [
            (*(text.format(**one.values) for text in texts[one.key]), one.holds)
            for one in self.claims(found)
        ]
        said: Sequence[str] = ()
        # Where times are what is claimed, the table of claims is one of times, and no paragraph.
        if "claims" in self.words.get("times", {}):
            title = self.words["times"]["claims"]["title"]
            times.insert(0, ("claims", Table(title, CLAIMS, tuple(checked))))
        elif checked:
            tables.append(("claims", Table("The paper's claims", CLAIMS, tuple(checked))))
            said = sentences(checked)
        pictures = []
        for one in self.pictures(found):
            captions = self.words["captions"]
            key = max((k for k in captions if one.name.startswith(k)), key=len)
            about = captions[key].format(found if one.about is None else one.about)
            pictures.append(one._replace(about=about))
        return Output(
            ours=(*self.words.get("notes", ()), *said),
            tables=tuple(tables),
            times=tuple(times),
            pictures=tuple(pictures),
            runs=tuple(dict.fromkeys(context.asked)),
        )


CLAIMS = ("the paper", "here", "agrees")


def sentences(checked: Sequence[tuple[str, str, bool | None]]) -> tuple[str, ...]:
    """Return of how many claims the walls agree with the paper, and a paragraph each.

    >>> sentences([("Walls are low.", "2 px.", True)])[0]
    'Of 1 claims of the paper that can be told, 1 agree.'
    """
    told = [holds for *_, holds in checked if holds is not None]
    count = f"Of {len(told)} claims of the paper that can be told, {sum(told)} agree."
    return (count, *(f"{VERDICTS[holds]}: {claim} Here: {here}" for claim, here, holds in checked))
