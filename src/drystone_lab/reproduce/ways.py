"""Items that compare settings: beta, Fig. 16, Fig. 20, Fig. 21, Figs. B.30 to B.32."""

from collections import Counter
from collections.abc import Iterator, Mapping, Sequence

from drystone_lab import walls
from drystone_lab.paired import median_of
from drystone_lab.pictures.charts import group_panels, plot_two_figures
from drystone_lab.reproduce import study
from drystone_lab.reproduce.cells import METRICS, rounded
from drystone_lab.reproduce.item import Claimed, Context, ItemFigure, PaperItem
from drystone_lab.reproduce.study import Study, StudyWalls, Trials, medians
from drystone_lab.runs.spec import Changes
from drystone_lab.walls import IR, LIU_5, MASONS, PR, TWO_SIDED, R, Target, coarser

COARSE = (coarser(R, 0.1), coarser(PR, 0.25))
"""For quick versions: the many stones of IR take longest."""

BETAS = ("0", "0.5", "0.7", "0.9")
PAPERS = "0.7"
"""The threshold that the paper found best."""


def _beta_picture(found: StudyWalls) -> ItemFigure:
    panels = {
        f"{group.name}, {figure}": {one.way: one.values(figure) for one in group}
        for group in found.by_wall
        for figure in METRICS
    }
    title = "Walls by the threshold beta of GDS; lines are medians"
    return ItemFigure("beta", group_panels(panels, title=title))


BETA = PaperItem(
    study=Study(
        walls=MASONS,
        ways={beta: (("placement.beta", float(beta)),) for beta in BETAS},
        quick_walls=COARSE,
    ),
    tables={
        "beta": medians("name", "way"),
        "beta_pairs": study.pairs(PAPERS, [beta for beta in BETAS if beta != PAPERS]),
    },
    pictures=lambda found: [_beta_picture(found)],
)

SAMPLINGS = ("variant", "uniform", "twofold", "full")
SAMPLED: dict[str, Changes] = {name: (("sampling", name),) for name in SAMPLINGS}


def _sampling_claims(found: StudyWalls) -> Iterator[Claimed]:
    counts = {one.way: one.median("candidates") or 0.0 for one in found}
    ratios = (f"{way} {count / counts['variant']:.2f}" for way, count in counts.items())
    # The paper counts sub-iterations: whether that agrees cannot be told.
    yield Claimed("twice", None, {"ratios": ", ".join(ratios)})
    whole = ", ".join(f"{one.way} {_whole(one)}" for one in found)
    ends = Counter(outcome.plan["stopped"] for one in found for outcome in one.outcomes)
    stopped = ", ".join(f"'{reason}' {count} times" for reason, count in ends.most_common())
    values = {"whole": whole, "seeds": len(found.seeds), "stopped": stopped}
    yield Claimed("filled", None, values)
    (full,) = found.of("full")
    plans = [outcome.plan["steps"] for outcome in full.outcomes]
    kinds = sum(plan not in plans[:place] for place, plan in enumerate(plans))
    yield Claimed("chance", kinds == 1, {"kinds": kinds})


def _whole(trials: Trials) -> int:
    return sum(o.figures["placed"] == o.figures["stones"] for o in trials.outcomes)


SAMPLING = PaperItem(
    study=Study(walls=(PR,), ways=SAMPLED),
    claims=_sampling_claims,
    tables={
        "fig16": medians("way", extra=lambda one: (rounded(one.median("candidates")),)),
    },
    pictures=lambda found: (
        study.sheet(found, "fig16", 2, lambda one: one.way),
        study.strips(found, "fig16_seeds", (*METRICS, "placed", "candidates"), lambda one: one.way),
    ),
)

STABILISED = ("both", "rotation", "wedge", "none")


def _wedge_share(trials: Trials) -> tuple[float | None, ...]:
    whole = trials.wall.width * trials.wall.height
    return tuple(
        None if area is None else 100 * area / whole for area in trials.values("wedge_area")
    )


def _stabilised_claims(found: StudyWalls) -> Iterator[Claimed]:
    for group in found.by_wall:
        filled = {one.way: one.median("F_SF") or 0.0 for one in group}
        best = max(filled, key=lambda way: filled[way])
        yield Claimed("together", best == "both", {"name": group.name, "best": best})


def _wedges_picture(group: StudyWalls, number: int) -> ItemFigure:
    points = {
        one.way: tuple(zip(_wedge_share(one), one.values("F_SF"), strict=True)) for one in group
    }
    # The set is named in the picture itself, as one of them stands in for the paper's.
    across = f"{group.name}: area of wedges, % of the wall"
    ax = plot_two_figures(points, across=across, up="F_SF")
    return ItemFigure(f"fig20_{number}", ax.figure, group)


STABILISATION = PaperItem(
    study=Study(
        walls=(LIU_5, IR),
        ways={method: (("stabilise.method", method),) for method in STABILISED},
        quick_seeds=2,
        quick_walls=(coarser(LIU_5, 0.15), coarser(IR, 0.15)),
    ),
    claims=_stabilised_claims,
    tables={
        "fig20": medians(
            "name",
            "way",
            extra=lambda one: (one.median("wedges"), rounded(median_of(_wedge_share(one)))),
        )
    },
    pictures=lambda found: [
        _wedges_picture(group, number) for number, group in enumerate(found.by_wall, 1)
    ],
)

NAMED: dict[str, Changes] = {
    "sf: one pose a stone": (("orientations", "sf"),),
    "shrinking sets": (("sampling", "shrinking"),),
    "NHR at most 1": (("selection.clip_nhr", True),),
    "turns of up to 45 degrees": (("stabilise.max_turn_deg", 45.0), ("stabilise.max_pivots", 10)),
}
"""What else the paper's method could be."""

RELEASED: dict[str, Changes] = {"two-fold, two-sided": (("sampling", "twofold"), *TWO_SIDED)}
"""What the released code comes with."""

CAUSES: dict[str, Changes] = {
    "full batch": SAMPLED["full"],
    "six places a stone": (("placement.tries", 6),),
    "reach from above": (("placement.reach", "above"),),
    "wedges of up to two stones": (("stabilise.max_wedge_height", 2.0),),
    "rule lowest": (("placement.rule", "lowest"),),
    "rule lowest, two-fold, two-sided": (
        ("placement.rule", "lowest"), *RELEASED["two-fold, two-sided"],
    ),
}  # fmt: skip
"""What might keep PR from its 32 stones; the last are the released code's rule and its own way."""

VARIED: tuple[tuple[Target, Mapping[str, Changes]], ...] = (
    (R, NAMED | RELEASED),
    (PR, NAMED | RELEASED | CAUSES),
    (walls.PR_FREE_596, RELEASED | CAUSES),
    (IR, RELEASED),
    *((wall, {}) for wall in walls.FRAMED),
)
"""Walls, and by what else they are built; 596 px is the width of the authors' released times."""


def named_variants(
    context: Context,
    varied: Sequence[tuple[Target, Mapping[str, Changes]]] = VARIED,
    count: int = 20,
) -> StudyWalls:
    """Build walls by variants of the paper's method."""
    if context.quick:
        varied, count = [(wall, NAMED) for wall in COARSE], 2
    seeds = range(context.seed, context.seed + count)
    each = (study.built(context, (wall,), {"paper": (), **ways}, seeds) for wall, ways in varied)
    return StudyWalls(context, tuple(one for found in each for one in found))


VARIANTS = PaperItem(
    study=named_variants,
    tables={
        "variants": medians("name", "way", "working_px", extra=lambda one: (_whole(one),)),
    },
    pictures=lambda found: [
        study.strips(group, f"variants_{number}", ("placed", "F_SF", "F_LR"), lambda one: one.way)
        for number, group in enumerate(found.by_wall, 1)
        if len(group.all) > 1
    ],
)

ONE, TWO = "one-sided", "two-sided"
SIDES: dict[str, Changes] = {ONE: (), TWO: TWO_SIDED}

BOTH_ENDS = PaperItem(
    study=Study(walls=MASONS, ways=SIDES, quick_walls=COARSE),
    tables={
        "fig21": medians("name", "way", extra=lambda one: (rounded(one.median("E_FLUSH")),)),
        "fig21_pairs": study.pairs(TWO, (ONE,)),
    },
    pictures=lambda found: (
        study.sheet(found, "fig21", 2, lambda one: f"{one.wall.name}, {one.way}"),
        study.strips(
            found,
            "fig21_seeds",
            (*METRICS, "E_FLUSH"),
            lambda one: f"{one.wall.name} {one.way[:3]}",
        ),
    ),
)

NUMBERS = {"R": "B.30", "PR": "B.31", "IR": "B.32"}


def _methods_picture(group: StudyWalls) -> ItemFigure:
    number = NUMBERS.get(group.name, "B.1")
    drawn = study.sheet(group, f"fig{number.replace('.', '')}", len(SIDES), lambda one: one.way)
    return drawn._replace(about=(number, group.name))


ALL_METHODS = PaperItem(
    study=Study(
        walls=MASONS,
        ways={
            f"{sampling}, {side}": (*SAMPLED[sampling], *changes)
            for sampling in SAMPLINGS
            for side, changes in SIDES.items()
        },
        seeds=1,
        quick_seeds=1,
        quick_walls=COARSE,
    ),
    tables={
        "figB30_32": study.each_wall(
            "name", "way", "placed", "stones",
            extra=lambda outcome: (outcome.figures["wedges"], outcome.figures["candidates"]),
        )
    },
    pictures=lambda found: [_methods_picture(group) for group in found.by_wall],
)  # fmt: skip
