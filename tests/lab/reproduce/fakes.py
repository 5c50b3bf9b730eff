"""Items that take no time, under names of the paper's."""

from dataclasses import dataclass, replace

from matplotlib.figure import Figure

from drystone.errors import InputError
from drystone_lab.reproduce.item import ItemFigure, PaperItem
from drystone_lab.runs.outcome import RunOutcome
from drystone_lab.runs.spec import RunSpec, generated

BRICKS = generated("brick", 1, count=4, height_px=10, aspect=2)


@dataclass(frozen=True)
class Walls:
    """Runs and what came out of them."""

    runs: tuple[RunSpec, ...]
    outcomes: tuple[RunOutcome, ...]


def walls(context):
    """Two walls of bricks; one in the quick version."""
    seeds = range(context.seed, context.seed + (1 if context.quick else 2))
    runs = tuple(RunSpec(source=BRICKS, width=40, height=20, seed=seed) for seed in seeds)
    outcomes = context.run(runs)
    return Walls(runs, outcomes)


def _rows(found):
    for run, outcome in zip(found.runs, found.outcomes, strict=True):
        yield run.seed, outcome.figures["F_SF"], None


def _times(found):
    for run, outcome in zip(found.runs, found.outcomes, strict=True):
        yield run.seed, outcome.times["wall"]


def _picture(found):
    figure = Figure(figsize=(2, 1))
    filled = [outcome.figures["F_SF"] for outcome in found.outcomes]
    figure.add_subplot().plot([run.seed for run in found.runs], filled, marker="o")
    return ItemFigure("filling", figure)


def broken(context):
    """An error with a code, after a wall was planned."""
    walls(context)
    raise InputError("E104", "there are no stones.", where="broken", cure="Look for some.")


def interrupted(context):
    """Ctrl-C after a wall was planned."""
    walls(context)
    raise KeyboardInterrupt


FILLING = PaperItem(
    words={
        "title": "filling of bricks", "section": "§3.4", "paper": ["Walls & <joints>."],
        "notes": ["Walls of bricks."],
        "tables": {
            "walls": {"title": "Filling", "columns": ["seed", "F_SF", "F_AV"],
                      "notes": ["Of {0.runs[0].source.kind}s."]},
        },
        "times": {"walls": {"title": "Seconds", "columns": ["seed", "s"]}},
        "captions": {"fill": "Of others.", "filling": "Filling over {0.runs[0].seed}."},
    },
    study=walls,
    tables={"walls": _rows},
    times={"walls": _times},
    pictures=lambda found: [_picture(found)],
)  # fmt: skip
WORDS = PaperItem(
    words={"title": "words", "section": "5.1", "paper": ["Words."], "notes": ["Only words."]},
    study=lambda context: context,
)


def _said(item, **words):
    return replace(item, words={**item.words, **words})


NEEDY = _said(WORDS, title="published stones", section="§5.1",
              needs=["almeida/PR.png", "ferris/x.json"])  # fmt: skip
BROKEN = replace(_said(FILLING, title="no stones", section="B.1"), study=broken)
INTERRUPTED = replace(_said(FILLING, title="interrupted", section="§5.2"), study=interrupted)

ITEMS = {
    "fig5": FILLING, "fig13": NEEDY, "beta": WORDS, "fig17": INTERRUPTED, "figB33": BROKEN,
}  # fmt: skip


def lay_needed(data):
    """Lay empty files in a folder in the place of the published stones."""
    for name in NEEDY.needs:
        (data / name).parent.mkdir(parents=True)
        (data / name).touch()


def counted(item):
    """An item, and the contexts that it is made with."""
    contexts = []

    def noted(context):
        contexts.append(context)
        return item.study(context)

    return replace(item, study=noted), contexts
