"""Items that take no time, under names of the paper's."""

from dataclasses import replace

from matplotlib.figure import Figure

from drystone.errors import InputError
from drystone_lab.reproduce.item import ItemFigure, PaperItem
from drystone_lab.runs.spec import RunSpec, generated

BRICKS = generated("brick", 1, count=4, height_px=10, aspect=2)


def walls(context):
    """Runs of two walls of bricks, one in the quick version, and what came out of them."""
    seeds = range(context.seed, context.seed + (1 if context.quick else 2))
    runs = [RunSpec(source=BRICKS, width=40, height=20, seed=seed) for seed in seeds]
    return list(zip(runs, context.run(runs), strict=True))


def _picture(found):
    figure = Figure(figsize=(2, 1))
    filled = [outcome.figures["F_SF"] for _, outcome in found]
    figure.add_subplot().plot([run.seed for run, _ in found], filled, marker="o")
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
                      "notes": ["Of {0[0][0].source.kind}s."]},
        },
        "times": {"walls": {"title": "Seconds", "columns": ["seed", "s"]}},
        "captions": {"fill": "Of others.", "filling": "Filling over {0[0][0].seed}."},
    },
    study=walls,
    tables={"walls": lambda found: [(run.seed, o.figures["F_SF"], None) for run, o in found]},
    times={"walls": lambda found: [(run.seed, o.times["wall"]) for run, o in found]},
    pictures=lambda found: [_picture(found)],
)  # fmt: skip
WORDS = PaperItem(
    words={"title": "words", "section": "5.1", "paper": ["Words."], "notes": ["Only words."]},
    study=lambda context: context,
)


def _said(item, study, **words):
    return replace(item, study=study, words={**item.words, **words})


NEEDY = _said(WORDS, WORDS.study, title="published stones", section="§5.1",
              needs=["almeida/PR.png", "ferris/x.json"])  # fmt: skip
ITEMS = {
    "fig5": FILLING, "fig13": NEEDY, "beta": WORDS,
    "fig17": _said(FILLING, interrupted, title="interrupted", section="§5.2"),
    "figB33": _said(FILLING, broken, title="no stones", section="B.1"),
}  # fmt: skip


def lay_needed(data):
    """Lay empty files in a folder in the place of the published stones."""
    for name in NEEDY.words["needs"]:
        (data / name).parent.mkdir(parents=True)
        (data / name).touch()
