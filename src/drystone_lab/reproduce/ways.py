"""Items that compare settings: beta, Fig. 16, Fig. 20, Fig. 21, Figs. B.30 to B.32."""

from collections import Counter
from collections.abc import Iterator, Mapping, Sequence

from drystone_lab import walls
from drystone_lab.pictures.charts import group_panels, plot_two_figures
from drystone_lab.reproduce.cells import METRICS
from drystone_lab.reproduce.item import Claimed, Context, ItemFigure, PaperItem, StudyWalls, built
from drystone_lab.runs.spec import Changes
from drystone_lab.walls import IR, PR, TWO_SIDED, R, Target


def _beta_picture(found: StudyWalls) -> ItemFigure:
    panels = {
        f"{group.name}, {figure}": {one.way: one.values(figure) for one in group}
        for group in found.by_wall
        for figure in METRICS
    }
    title = "Walls by the threshold beta of GDS; lines are medians"
    return ItemFigure("beta", group_panels(panels, title=title))


BETA = PaperItem(pictures=lambda found: [_beta_picture(found)])


def _sampling_claims(found: StudyWalls) -> Iterator[Claimed]:
    counts = {one.way: one.median("candidates") or 0.0 for one in found}
    ratios = (f"{way} {count / counts['variant']:.2f}" for way, count in counts.items())
    # The paper counts sub-iterations: whether that agrees cannot be told.
    yield Claimed("twice", None, {"ratios": ", ".join(ratios)})
    whole = ", ".join(f"{one.way} {one.whole}" for one in found)
    ends = Counter(outcome.plan["stopped"] for one in found for outcome in one.outcomes)
    stopped = ", ".join(f"'{reason}' {count} times" for reason, count in ends.most_common())
    values = {"whole": whole, "seeds": len(found.seeds), "stopped": stopped}
    yield Claimed("filled", None, values)
    (full,) = found.of("full")
    plans = [outcome.plan["steps"] for outcome in full.outcomes]
    kinds = sum(plan not in plans[:place] for place, plan in enumerate(plans))
    yield Claimed("chance", kinds == 1, {"kinds": kinds})


SAMPLING = PaperItem(claims=_sampling_claims)


def _stabilised_claims(found: StudyWalls) -> Iterator[Claimed]:
    for group in found.by_wall:
        filled = {one.way: one.median("F_SF") or 0.0 for one in group}
        best = max(filled, key=lambda way: filled[way])
        yield Claimed("together", best == "both", {"name": group.name, "best": best})


def _wedges_picture(group: StudyWalls, number: int) -> ItemFigure:
    points = {
        one.way: tuple(zip(one.values("wedge_share"), one.values("F_SF"), strict=True))
        for one in group
    }
    # The set is named in the picture itself, as one of them stands in for the paper's.
    across = f"{group.name}: area of wedges, % of the wall"
    ax = plot_two_figures(points, across=across, up="F_SF")
    return ItemFigure(f"fig20_{number}", ax.figure, group)


STABILISATION = PaperItem(
    claims=_stabilised_claims,
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
    "full batch": (("sampling", "full"),),
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
        varied, count = [(wall, NAMED) for wall in walls.COARSE], 2
    seeds = range(context.seed, context.seed + count)
    each = (built(context, (wall,), {"paper": (), **ways}, seeds) for wall, ways in varied)
    return StudyWalls(context, tuple(one for found in each for one in found))


VARIANTS = PaperItem(
    study=named_variants,
    pictures=lambda found: [
        group.strips(f"variants_{number}", ("placed", "F_SF", "F_LR"), "{0.way}")
        for number, group in enumerate(found.by_wall, 1)
        if len(group.all) > 1
    ],
)


def _methods_picture(group: StudyWalls) -> ItemFigure:
    number = {"R": "B.30", "PR": "B.31", "IR": "B.32"}.get(group.name, "B.1")
    drawn = group.sheet(f"fig{number.replace('.', '')}", 2, "{0.way}")
    return drawn._replace(about=(number, group.name))


ALL_METHODS = PaperItem(pictures=lambda found: [_methods_picture(group) for group in found.by_wall])
