"""Items that compare settings: beta, Fig. 16, Fig. 20, Fig. 21, Figs. B.30 to B.32."""

from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from statistics import median

from drystone_lab.pictures.charts import group_panels, plot_two_figures
from drystone_lab.reproduce import cells
from drystone_lab.reproduce.cells import METRICS, ClaimCheck, rounded
from drystone_lab.reproduce.item import Context, ItemPicture, PaperItem, paper
from drystone_lab.reproduce.study import (
    Study,
    StudyWalls,
    Trials,
    built,
    pairs_table,
    sheet,
    strips,
    walls_table,
    ways_table,
)
from drystone_lab.runs.spec import Changes
from drystone_lab.walls import (
    FRAMED,
    IR,
    LIU_5,
    MASONS,
    PR,
    PR_FREE_596,
    TWO_SIDED,
    R,
    Target,
    coarser,
)

MASONS_STONES = tuple(wall.source.name for wall in MASONS)

COARSE = (coarser(R, 0.1), coarser(PR, 0.25))
"""For quick versions: the many stones of IR take longest."""

BETAS = ("0", "0.5", "0.7", "0.9")
PAPERS = "0.7"
"""The threshold that the paper found best."""


def _beta_picture(found: StudyWalls) -> ItemPicture:
    panels = {
        f"{group.name}, {figure}": {one.way: one.values(figure) for one in group}
        for group in found.by_wall
        for figure in METRICS
    }
    title = "Walls by the threshold beta of GDS; lines are medians"
    caption = (
        "A point a wall, a row a set of stones. F_AH is better when lower, the others when higher; "
        "F_AV and F_AH in percent."
    )
    return ItemPicture("beta", group_panels(panels, title=title), caption)


BETA = PaperItem(
    **paper("beta"),
    study=Study(
        walls=MASONS,
        ways={beta: (("placement.beta", float(beta)),) for beta in BETAS},
        quick_walls=COARSE,
    ),
    tables={
        "beta": ways_table(
            "Walls by the threshold of GDS",
            ("wall", "beta"),
            lambda one: (one.wall.name, one.way),
            notes=("One-sided, variant sampling.",),
        ),
        "beta_pairs": pairs_table(
            f"Walls with beta = {PAPERS} against those with others, pairs of one seed",
            PAPERS,
            [beta for beta in BETAS if beta != PAPERS],
            "other beta",
        ),
    },
    pictures=lambda found: (_beta_picture(found),),
    needs=MASONS_STONES,
)

SAMPLINGS = ("variant", "uniform", "twofold", "full")
SAMPLED: dict[str, Changes] = {name: (("sampling", name),) for name in SAMPLINGS}


def _sampling_claims(found: StudyWalls) -> Iterator[ClaimCheck]:
    counts = {one.way: one.median("candidates") or 0.0 for one in found}
    times = {way: count / counts["variant"] for way, count in counts.items()}
    yield ClaimCheck(
        "Two-fold sampling is twice as expensive as variant sampling.",
        "candidates of a wall over those of variant sampling, medians: "
        f"{', '.join(f'{way} {ratio:.2f}' for way, ratio in times.items())}.",
        None,  # the paper counts sub-iterations
    )
    whole = {one.way: _whole(one) for one in found}
    ends = Counter(outcome.plan["stopped"] for one in found for outcome in one.outcomes)
    stopped = ", ".join(f"'{reason}' {count} times" for reason, count in ends.most_common())
    yield ClaimCheck(
        "All methods stack stones to fill the wall.",
        f"all stones are placed by {', '.join(f'{way} {n}' for way, n in whole.items())} of "
        f"{len(found.seeds)} walls each; construction ended with {stopped}.",
        None,
    )
    (full,) = found.of("full")
    plans = [outcome.plan["steps"] for outcome in full.outcomes]
    kinds = sum(plan not in plans[:place] for place, plan in enumerate(plans))
    yield ClaimCheck(
        "Full batch has nothing to choose at random.",
        f"its seeds give {kinds} different walls.",
        kinds == 1,
    )


def _whole(trials: Trials) -> int:
    return sum(o.figures["placed"] == o.figures["stones"] for o in trials.outcomes)


SAMPLING = PaperItem(
    **paper("fig16"),
    study=Study(walls=(PR,), ways=SAMPLED),
    claims=_sampling_claims,
    tables={
        "fig16": ways_table(
            "{wall} by the sampling of candidates, one-sided",
            ("sampling",),
            lambda one: (one.way,),
            ("candidates median",),
            lambda one: (rounded(one.median("candidates")),),
        )
    },
    pictures=lambda found: (
        sheet(found, "fig16", 2, lambda one: one.way, f"Walls of seed {found.seeds[0]}."),
        strips(found, "fig16_seeds", (*METRICS, "placed", "candidates"), lambda one: one.way),
    ),
    needs=(PR.source.name,),
)

STABILISED = ("both", "rotation", "wedge", "none")


def _wedge_share(trials: Trials) -> tuple[float | None, ...]:
    """Return the area of the wedges in percent of the wall."""
    whole = trials.wall.width * trials.wall.height
    return tuple(
        None if area is None else 100 * area / whole for area in trials.values("wedge_area")
    )


def _stabilised_claims(found: StudyWalls) -> Iterator[ClaimCheck]:
    for group in found.by_wall:
        medians = {one.way: one.median("F_SF") or 0.0 for one in group}
        best = max(medians, key=lambda way: medians[way])
        yield ClaimCheck(
            f"Rotation and wedging together fill a wall best ({group.name}).",
            f"the median filling is largest with {best}.",
            best == "both",
        )


def _wedges_picture(group: StudyWalls, number: int) -> ItemPicture:
    points = {
        one.way: tuple(zip(_wedge_share(one), one.values("F_SF"), strict=True)) for one in group
    }
    # The set is named in the picture itself, as one of them stands in for the paper's.
    across = f"{group.name}: area of wedges, % of the wall"
    figure = plot_two_figures(points, across=across, up="F_SF").get_figure(root=True)
    assert figure is not None  # noqa: S101 - it was made for the axes
    return ItemPicture(f"fig20_{number}", figure, f"{group.name}: a point a wall, medians large.")


def _wedge_cells(one: Trials) -> tuple[float | None, ...]:
    shares = [share for share in _wedge_share(one) if share is not None]
    return one.median("wedges"), rounded(median(shares))


STABILISATION = PaperItem(
    **paper("fig20"),
    study=Study(
        walls=(LIU_5, IR),
        ways={method: (("stabilise.method", method),) for method in STABILISED},
        quick_seeds=2,
        quick_walls=(coarser(LIU_5, 0.15), coarser(IR, 0.15)),
    ),
    claims=_stabilised_claims,
    tables={
        "fig20": ways_table(
            "Walls by the way to stabilise",
            ("wall", "stabilise"),
            lambda one: (one.wall.name, one.way),
            ("wedges median", "wedges % of wall median"),
            _wedge_cells,
            ("Variant sampling, one-sided. F_SF is without wedges.",),
        ),
    },
    pictures=lambda found: [
        _wedges_picture(group, number) for number, group in enumerate(found.by_wall, 1)
    ],
    needs=(IR.source.name,),
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
    (PR_FREE_596, RELEASED | CAUSES),
    (IR, RELEASED),
    *((wall, {}) for wall in FRAMED),
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
    walls = [built(context, (wall,), {"paper": (), **ways}, seeds) for wall, ways in varied]
    return StudyWalls(context, tuple(one for found in walls for one in found))


VARIANTS = PaperItem(
    **paper("variants"),
    study=named_variants,
    tables={
        "variants": ways_table(
            "Walls by the variant of the paper's method",
            ("wall", "variant", "working px"),
            lambda one: (
                one.wall.name, one.way,
                f"{one.specs[0].width * one.wall.scale:.0f} x "
                f"{one.specs[0].height * one.wall.scale:.0f}",
            ),
            ("all stones placed in",),
            lambda one: (_whole(one),),
        ),
    },
    pictures=lambda found: [
        strips(group, f"variants_{number}", ("placed", "F_SF", "F_LR"), lambda one: one.way)
        for number, group in enumerate(found.by_wall, 1)
        if len(group.all) > 1
    ],
    needs=MASONS_STONES,
)  # fmt: skip

ONE, TWO = "one-sided", "two-sided"
SIDES: dict[str, Changes] = {ONE: (), TWO: TWO_SIDED}
FLUSH = (*METRICS, "E_FLUSH")


BOTH_ENDS = PaperItem(**paper("fig21"),
    study=Study(walls=MASONS, ways=SIDES, quick_walls=COARSE),
    tables={
        "fig21": ways_table(
            "Walls built from one end and from both",
            ("wall", "built"),
            lambda one: (one.wall.name, one.way),
            ("E_FLUSH median",),
            lambda one: (rounded(one.median("E_FLUSH")),),
            (
                "E_FLUSH: mean gap of the ends to the wall's end lines over the mean width of a "
                "stone; our measure of the paper's alignment with both ends.",
            ),
        ),
        "fig21_pairs": pairs_table(
            "Two-sided against one-sided, pairs of one set and seed", TWO, (ONE,), "other"
        ),
    },
    pictures=lambda found: (
        sheet(
            found, "fig21", 2, lambda one: f"{one.wall.name}, {one.way}",
            f"Walls of seed {found.seeds[0]}, left from one end, right from both.",
        ),
        strips(found, "fig21_seeds", FLUSH, lambda one: f"{one.wall.name} {one.way[:3]}"),
    ),
    needs=MASONS_STONES,
)  # fmt: skip

NUMBERS = {"R": "B.30", "PR": "B.31", "IR": "B.32"}


def _methods_picture(group: StudyWalls) -> ItemPicture:
    number = NUMBERS.get(group.name, "B.1")
    caption = f"Fig. {number}, stones {group.name}: left from one end, right from both."
    return sheet(group, f"fig{number.replace('.', '')}", len(SIDES), lambda one: one.way, caption)


ALL_METHODS = PaperItem(**paper("figB30-32"),
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
        "figB30_32": walls_table(
            "Walls of one seed by all methods of construction",
            ("wall", "method", "placed", "stones", *METRICS, "wedges", "candidates"),
            lambda one, _, outcome: (
                one.wall.name, one.way, outcome.figures["placed"], outcome.figures["stones"],
                *cells.metric_cells(outcome), outcome.figures["wedges"],
                outcome.figures["candidates"],
            ),
        )
    },
    pictures=lambda found: [_methods_picture(group) for group in found.by_wall],
    needs=MASONS_STONES,
)  # fmt: skip
