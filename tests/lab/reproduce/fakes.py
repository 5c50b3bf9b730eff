"""Items that take no time, under names of the paper's."""

from collections.abc import Callable, Mapping

from matplotlib.figure import Figure

from drystone.errors import InputError
from drystone_lab.reproduce.item import Context, Item, Output, Picture
from drystone_lab.runs.source import generated
from drystone_lab.runs.spec import RunSpec
from drystone_lab.table import Table

BRICKS = generated("brick", 1, count=4, height_px=10, aspect=2)


def walls(context: Context) -> Output:
    """Two walls of bricks; one in the quick version."""
    seeds = range(context.seed, context.seed + (1 if context.quick else 2))
    runs = tuple(RunSpec(source=BRICKS, width=40, height=20, seed=seed) for seed in seeds)
    outcomes = context.run(runs)
    rows = tuple(
        (run.seed, out.figures["F_SF"], None) for run, out in zip(runs, outcomes, strict=True)
    )
    times = tuple((run.seed, out.times["wall"]) for run, out in zip(runs, outcomes, strict=True))
    figure = Figure(figsize=(2, 1))
    figure.add_subplot().plot([run.seed for run in runs], [row[1] for row in rows], marker="o")
    return Output(
        paper=("Walls & <joints>.",),
        ours=(f"We have {len(runs)} walls.",),
        tables=(("walls", Table("Filling", ("seed", "F_SF", "F_AV"), rows, ("Of bricks.",))),),
        times=(("walls", Table("Seconds", ("seed", "s"), times)),),
        pictures=(Picture("filling", figure, "Filling over the seed."),),
        runs=runs,
    )


def words(context: Context) -> Output:
    """A sentence with the seed."""
    return Output(paper=("Words.",), ours=(f"Seed {context.seed}, image {context.image}.",))


def broken(context: Context) -> Output:
    """An error with a code, after a wall was planned."""
    walls(context)
    raise InputError("E104", "there are no stones.", where="broken", cure="Look for some.")


def interrupted(context: Context) -> Output:
    """Ctrl-C after a wall was planned."""
    walls(context)
    raise KeyboardInterrupt


FILLING = Item("filling of bricks", "§3.4", walls)
WORDS = Item("words", "5.1", words)
NEEDY = Item("published stones", "§5.1", words, needs=("almeida/PR.png", "ferris/x.json"))
BROKEN = Item("no stones", "B.1", broken)
INTERRUPTED = Item("interrupted", "§5.2", interrupted)

ITEMS: Mapping[str, Item] = {
    "fig5": FILLING, "fig13": NEEDY, "beta": WORDS, "fig17": INTERRUPTED, "figB33": BROKEN,
}  # fmt: skip


def counted(item: Item) -> tuple[Item, list[Context]]:
    """An item, and the contexts that it is made with."""
    contexts: list[Context] = []
    make: Callable[[Context], Output] = item.make

    def noted(context: Context) -> Output:
        contexts.append(context)
        return make(context)

    return Item(item.title, item.section, noted, item.needs), contexts
