"""Figs. 26 and 27: walls of Fourier stones, round or elliptic, of one or of many sizes (§5.3)."""

from collections.abc import Iterable, Iterator
from functools import partial
from itertools import product
from statistics import median

from matplotlib.figure import Figure
from scipy.stats import mannwhitneyu

from drystone_lab.pictures.charts import TWO_IN, plot_two_figures
from drystone_lab.pictures.walls import plot_walls
from drystone_lab.reproduce.cells import LEVEL, METRICS, ClaimCheck, figures_of, metric_cells
from drystone_lab.reproduce.item import ItemPicture, PaperItem, paper
from drystone_lab.reproduce.study import Study, StudyWalls, Trials, walls_table, ways_table
from drystone_lab.runs.spec import StoneSource, generated, published
from drystone_lab.walls import TWO_SIDED, Target, coarser

WALL_PX, COUNT, SCALE = 420, 100, 0.5
"""Width and height of every wall in px of the stones, stones of a set, and working resolution: the
paper's 210 px are working px."""

SHAPES = {"round": 0.0, "elliptic": 0.2}
RADII_PX = {"30": (30.0, 30.0), "10 to 50": (10.0, 50.0)}


def _source(D2: float, smallest: float, largest: float, seed: int = 1) -> StoneSource:  # noqa: N803
    return generated(
        "fourier", seed, count=COUNT, D2=D2, smallest_radius_px=smallest, largest_radius_px=largest
    )


def _wall(shape: str, radius: str) -> Target:
    name = f"{shape}, radius {radius} px"
    made = Target(name, _source(SHAPES[shape], *RADII_PX[radius]), WALL_PX, WALL_PX, SCALE)
    if (shape, radius) != ("round", "30"):
        return made
    source = published("fourier/D2_0")
    return Target(
        name, source, WALL_PX, WALL_PX, SCALE, instead=partial(Target, name, made.source, WALL_PX,
                                                               WALL_PX, SCALE, stand_in=True),
    )  # fmt: skip


KINDS = tuple(_wall(*kind) for kind in product(SHAPES, RADII_PX))
"""The paper's four sets, each fixed size before the varied one of its shape."""


def rounded_findings(found: Iterable[Trials]) -> Iterator[ClaimCheck]:
    """Compare fixed with varied sizes, for each shape."""
    all_of = tuple(found)
    claims = {
        "F_SF": "Walls of stones of a fixed size are poorly filled",
        "F_AV": "Variety of sizes enhances interlocking",
    }
    for (name, claim), shape in product(claims.items(), SHAPES):
        fixed, varied = (
            figures_of(one.outcomes, name) for one in all_of if one.wall.name.startswith(shape)
        )
        words = (
            f"median {name} {median(fixed):.3g} for a fixed size and {median(varied):.3g} for "
            f"varied ones, {len(fixed)} and {len(varied)} walls"
        )
        if min(len(fixed), len(varied)) < 4:
            yield ClaimCheck(f"{claim} ({shape}).", f"{words}: too few for a test.", None)
            continue
        p = float(mannwhitneyu(varied, fixed, alternative="greater", method="asymptotic").pvalue)
        words = f"{words} (rank-sum test, one-sided: p {p:.2g})."
        yield ClaimCheck(f"{claim} ({shape}).", words, p < LEVEL)


def _kind(one: Trials) -> tuple[str, str]:
    return one.wall.name, one.wall.said


def _pictures(found: StudyWalls) -> Iterator[ItemPicture]:
    walls = []
    for one in found:
        filling, interlocking, *_ = metric_cells(one.outcomes[one.middle])
        title = f"{one.wall.name}\nF_SF {filling}, F_AV {interlocking} %"
        title += f", seed {one.specs[one.middle].seed}"
        walls.append(found.drawn(one, title, one.middle))
    yield ItemPicture(
        "fig26", plot_walls(walls, 2),
        "A wall of each kind, the one in the middle by filling. Numbers are the order of "
        "placement, colours the clusters, wedges are dark red.",
    )  # fmt: skip
    groups = {
        one.wall.name: list(zip(one.values("F_SF"), one.values("F_AV"), strict=True))
        for one in found
    }
    figure = Figure(figsize=TWO_IN)
    ax = plot_two_figures(groups, figure.add_subplot(), across="F_SF", up="F_AV, %")
    ax.legend(fontsize=7, frameon=False, loc="lower center", bbox_to_anchor=(0.5, 1.0), ncols=2)
    yield ItemPicture(
        "fig27", figure,
        "Interlocking over filling of all walls by kind of stones; large marks are medians.",
    )  # fmt: skip


ROUNDED = PaperItem(
    **paper("fig26-27"),
    study=Study(
        walls=KINDS,
        ways={"two sides": TWO_SIDED},
        quick_seeds=1,
        quick_walls=tuple(coarser(wall, 0.1) for wall in KINDS),
    ),
    claims=rounded_findings,
    tables={
        "kinds": ways_table(
            "Walls of Fourier stones: medians and ranges, from two sides",
            ("kind", "stones are"),
            _kind,
        ),
        "walls": walls_table(
            "Walls of Fourier stones",
            ("kind", "stones are", "seed", "placed", "of", *METRICS),
            lambda one, spec, outcome: (
                *_kind(one), spec.seed, outcome.figures["placed"], outcome.figures["stones"],
                *metric_cells(outcome),
            ),
        ),
    },
    pictures=lambda found: tuple(_pictures(found)),
)  # fmt: skip
