"""A table or figure of the paper that can be made again."""

import tomllib
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

from matplotlib.figure import Figure

from drystone.model.wall import Wall
from drystone_lab.reproduce.cells import ClaimCheck, findings_table, sentences
from drystone_lab.runs.outcome import RunOutcome
from drystone_lab.runs.runner import Runner
from drystone_lab.runs.spec import RunSpec
from drystone_lab.table import Table


def paper(name: str) -> dict[str, Any]:
    """Return the words of an item of the paper: its title, section, paper and notes."""
    words = tomllib.loads(Path(__file__).with_name("paper.toml").read_text("utf-8"))[name]
    return {key: value if isinstance(value, str) else tuple(value) for key, value in words.items()}


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


@dataclass(frozen=True, eq=False)
class ItemPicture:
    """A figure of an item; written as NAME.png and NAME.svg."""

    name: str
    figure: Figure
    caption: str  # What is seen, in a sentence or two


@dataclass(frozen=True, eq=False)
class Output:
    """What an item came to."""

    # What the paper shows and reports there, its numbers among it; a paragraph each
    paper: tuple[str, ...]
    # What we found, in sentences whose numbers are computed, and why it differs; a paragraph each
    ours: tuple[str, ...]
    # Name of the CSV file without ending, and the table.  Equal seeds give equal tables on every
    # machine: no times are in them
    tables: tuple[tuple[str, Table], ...] = ()
    # Tables of measured times, which differ from machine to machine and run to run
    times: tuple[tuple[str, Table], ...] = ()
    pictures: tuple[ItemPicture, ...] = ()
    runs: tuple[RunSpec, ...] = ()  # That the item is made of, for its JSON


@dataclass(frozen=True, kw_only=True)
class PaperItem:
    """A table or figure of the paper: data, and what is read off it."""

    title: str
    section: str
    # What the paper shows and reports there, its numbers among it; a paragraph each
    paper: tuple[str, ...]
    # Does what the item is about: builds walls (:class:`~drystone_lab.reproduce.study.Study`) or
    # times them.  All others take what it returns
    study: Callable[[Context], Any]
    notes: tuple[str, ...] = ()  # What a reader of the results must know; a paragraph each
    # Compares what was found with claims of the paper; they are a table too
    claims: Callable[[Any], Iterable[ClaimCheck]] = lambda _: ()
    # tables, times: By the name of the CSV file; times differ from machine to machine
    tables: Mapping[str, Callable[[Any], Table]] = field(default_factory=dict)
    times: Mapping[str, Callable[[Any], Table]] = field(default_factory=dict)
    pictures: Callable[[Any], Sequence[ItemPicture]] = lambda _: ()  # Draws
    # Published stones without which it cannot be made, as paths in their folder
    needs: tuple[str, ...] = ()

    def make(self, context: Context) -> Output:
        """Do the study, and read everything off it."""
        context = replace(context, asked=[])
        found = self.study(context)
        claims = tuple(self.claims(found))
        tables = [(name, table(found)) for name, table in self.tables.items()]
        if claims:
            tables.append(("claims", findings_table("The paper's claims", claims)))
        return Output(
            paper=self.paper,
            ours=(*self.notes, *(sentences(claims) if claims else ())),
            tables=tuple(tables),
            times=tuple((name, table(found)) for name, table in self.times.items()),
            pictures=tuple(self.pictures(found)),
            runs=tuple(dict.fromkeys(context.asked)),
        )
