"""Items that take no time, under names of the paper's."""

from collections.abc import Mapping
from dataclasses import dataclass, replace

from matplotlib.figure import Figure

from drystone.errors import InputError
from drystone_lab.reproduce.item import Context, ItemPicture, PaperItem
from drystone_lab.runs.outcome import RunOutcome
from drystone_lab.runs.spec import RunSpec, generated
from drystone_lab.table import Table

BRICKS = generated("brick", 1, count=4, height_px=10, aspect=2)


@dataclass(frozen=True)
class Walls:
    """Runs and what came out of them."""

    runs: tuple[RunSpec, ...]
    outcomes: tuple[RunOutcome, ...]


def walls(context: Context) -> Walls:
    """Two walls of bricks; one in the quick version."""
    seeds = range(context.seed, context.seed + (1 if context.quick else 2))
    runs = tuple(RunSpec(source=BRICKS, width=40, height=20, seed=seed) for seed in seeds)
    outcomes = context.run(runs)
    return Walls(runs, outcomes)


def _table(found: Walls) -> Table:
    pairs = zip(found.runs, found.outcomes, strict=True)
    rows = tuple((run.seed, outcome.figures["F_SF"], None) for run, outcome in pairs)
    return Table("Filling", ("seed", "F_SF", "F_AV"), rows, ("Of bricks.",))


def _times(found: Walls) -> Table:
    pairs = zip(found.runs, found.outcomes, strict=True)
    rows = tuple((run.seed, outcome.times["wall"]) for run, outcome in pairs)
    return Table("Seconds", ("seed", "s"), rows)


def _picture(found: Walls) -> ItemPicture:
    figure = Figure(figsize=(2, 1))
    filled = [outcome.figures["F_SF"] for outcome in found.outcomes]
    figure.add_subplot().plot([run.seed for run in found.runs], filled, marker="o")
    return ItemPicture("filling", figure, "Filling over the seed.")


def broken(context: Context) -> Walls:
    """An error with a code, after a wall was planned."""
    walls(context)
    raise InputError("E104", "there are no stones.", where="broken", cure="Look for some.")


def interrupted(context: Context) -> Walls:
    """Ctrl-C after a wall was planned."""
    walls(context)
    raise KeyboardInterrupt


FILLING = PaperItem(
    title="filling of bricks",
    section="§3.4",
    paper=("Walls & <joints>.",),
    study=walls,
    notes=("Walls of bricks.",),
    tables={"walls": _table},
    times={"walls": _times},
    pictures=lambda found: (_picture(found),),
)
WORDS = PaperItem(
    title="words",
    section="5.1",
    paper=("Words.",),
    study=lambda context: context,
    notes=("Only words.",),
)
NEEDY = replace(WORDS, title="published stones", section="§5.1",
                needs=("almeida/PR.png", "ferris/x.json"))  # fmt: skip
BROKEN = replace(FILLING, title="no stones", section="B.1", study=broken)
INTERRUPTED = replace(FILLING, title="interrupted", section="§5.2", study=interrupted)

ITEMS: Mapping[str, PaperItem] = {
    "fig5": FILLING, "fig13": NEEDY, "beta": WORDS, "fig17": INTERRUPTED, "figB33": BROKEN,
}  # fmt: skip


def counted(item: PaperItem) -> tuple[PaperItem, list[Context]]:
    """An item, and the contexts that it is made with."""
    contexts: list[Context] = []

    def noted(context: Context) -> object:
        contexts.append(context)
        return item.study(context)

    return replace(item, study=noted), contexts
