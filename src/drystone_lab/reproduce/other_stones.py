"""Walls of other stones: rounded ones (§5.3), 91 irregular ones, and bricks (B.2)."""

from collections.abc import Iterator, Mapping, Sequence
from functools import partial
from itertools import pairwise, product
from statistics import median
from typing import NamedTuple

from scipy.stats import mannwhitneyu

from drystone.model.wall import Wall
from drystone_lab.cells import LEVEL, figures_of, metric_cells, placed_of
from drystone_lab.pictures import plot_two_figures, sheet_of, wall_panel
from drystone_lab.reproduce.item import Claimed, Context, ItemFigure, PaperItem, StudyWalls, Trials
from drystone_lab.runs.spec import Changes, generated, published
from drystone_lab.table import Rows
from drystone_lab.walls import TWO_SIDED, Target

WALL_PX, COUNT, SCALE = 420, 100, 0.5
"""Width and height of every wall in px of the stones, stones of a set, and working resolution: the
paper's 210 px are working px."""

SHAPES = {"round": 0.0, "elliptic": 0.2}
RADII_PX = {"30": (30.0, 30.0), "10 to 50": (10.0, 50.0)}


def _kind(shape: str, radius: str) -> Target:
    smallest, largest = RADII_PX[radius]
    made = generated(
        "fourier", 1, count=COUNT, D2=SHAPES[shape], smallest_radius_px=smallest,
        largest_radius_px=largest,
    )  # fmt: skip
    name, size = f"{shape}, radius {radius} px", (WALL_PX, WALL_PX, SCALE)
    if (shape, radius) != ("round", "30"):
        return Target(name, made, *size)
    instead = partial(Target, name, made, *size, stand_in=True)
    return Target(name, published("fourier/D2_0"), *size, instead=instead)


KINDS = tuple(_kind(*kind) for kind in product(SHAPES, RADII_PX))
"""The paper's four sets, each fixed size before the varied one of its shape."""


def rounded_findings(found: StudyWalls) -> Iterator[Claimed]:
    """Compare fixed with varied sizes, for each shape."""
    for name, shape in product(("F_SF", "F_AV"), SHAPES):
        fixed, varied = (
            figures_of(one.outcomes, name) for one in found if one.wall.name.startswith(shape)
        )
        words = (
            f"median {name} {median(fixed):.3g} for a fixed size and {median(varied):.3g} for "
            f"varied ones, {len(fixed)} and {len(varied)} walls"
        )
        if min(len(fixed), len(varied)) < 4:
            yield Claimed(name, None, shape=shape, words=f"{words}: too few for a test.")
            continue
        p = float(mannwhitneyu(varied, fixed, alternative="greater", method="asymptotic").pvalue)
        words = f"{words} (rank-sum test, one-sided: p {p:.2g})."
        yield Claimed(name, p < LEVEL, shape=shape, words=words)


def _rounded_pictures(found: StudyWalls) -> Iterator[ItemFigure]:
    walls = []
    for one in found:
        filling, interlocking, *_ = metric_cells(one.outcomes[one.middle].figures)
        title = f"{one.wall.name}\nF_SF {filling}, F_AV {interlocking} %"
        title += f", seed {one.specs[one.middle].seed}"
        walls.append(one.drawn(title, one.middle))
    yield ItemFigure("fig26", sheet_of(walls, 2))
    groups = {one.wall.name: (one.values("F_SF"), one.values("F_AV")) for one in found}
    ax = plot_two_figures(groups, across="F_SF", up="F_AV, %")
    ax.legend(fontsize=7, frameon=False, loc="lower center", bbox_to_anchor=(0.5, 1.0), ncols=2)
    yield ItemFigure("fig27", ax.figure)


ROUNDED = PaperItem(claims=rounded_findings, pictures=_rounded_pictures)

# Rubble as irregular as ours can be, of sizes that differ by a factor.  It has about as many
# pixels a stone as the paper's PR has, and as much wall as its best walls fill.
_IRREGULAR = generated(
    "rubble", 2024, count=91, width_px=480.0, height_px=200.0, area_ratio=0.75, courses=8,
    spread=0.6, roughness=0.3, pentagons=0.5, rounding=0.2, tilt_deg=45.0,
)  # fmt: skip

RUBBLE = Target(
    "91 irregular stones", published("rubble/rubble.png", mask=True, min_area_px=20), 0, 0, 0.5,
    instead=partial(
        Target, "91 generated stones", _IRREGULAR, 480, 200, 1.0, stand_in=True
    ),
)  # fmt: skip
"""The paper does not tell the size of the wall: it is that of the picture of the stones, which
also shows an opening and wide joints."""


def _irregular(found: StudyWalls) -> Rows:
    for one in found:
        outcome = one.outcomes[0]
        yield (
            found.name, one.wall.said, one.wall.scale, one.way, *placed_of(outcome),
            len({*outcome.clusters.values()}), *metric_cells(outcome.figures),
            outcome.figures["wedges"],
        )  # fmt: skip
    # In the left and in the right wall of the paper.
    for number, placed in enumerate((90, 91), 1):
        yield "the paper's", "published", None, f"wall {number}", placed, 91, *[None] * 6


IRREGULAR = PaperItem(tables={"walls": _irregular})

OVERLAP = 0.25
"""Of the brick's length, by which head joints of neighbouring courses are apart at least: the
usual rule of a bond."""


class Brick(NamedTuple):
    """The box of a placed brick, px; full when it fills it, so that it is not turned."""

    left: int
    right: int
    bottom: int
    top: int
    full: bool


class BrickCourses(NamedTuple):
    """What the courses of a wall are like."""

    lying: int  # With their long side level
    in_course: int  # Lying, with their foot at a whole number of brick heights
    courses: int
    joints: int  # Head joints within courses that have a course next to them
    # Those that are apart from all head joints of the courses beside them by :data:`OVERLAP`
    crossed: int


def bricks_of(wall: Wall) -> tuple[Brick, ...]:
    """Return the boxes of the stones of a wall of pixels."""
    bricks, height = [], wall.site.height_px
    for placement in wall.placements:
        rows, cols = placement.window
        ends = cols.start, cols.stop, height - rows.stop, height - rows.start
        bricks.append(Brick(*ends, bool(placement.posed.mask.all())))
    return tuple(bricks)


def courses_of(bricks: Sequence[Brick], height_px: int, width_px: int) -> BrickCourses:
    """Look at the courses of equal bricks, of the size of one that lies.

    >>> low = [Brick(0, 20, 0, 10, True), Brick(20, 40, 0, 10, True)]
    >>> courses_of([*low, Brick(10, 30, 10, 20, True), Brick(30, 50, 10, 20, True)], 10, 20)
    BrickCourses(lying=4, in_course=4, courses=2, joints=2, crossed=2)
    """
    lying = [b for b in bricks if b.full and b.right - b.left == width_px]
    level = [b for b in lying if b.bottom % height_px == 0]
    joints = {
        course: head_joints([b for b in level if b.bottom == course * height_px])
        for course in {b.bottom // height_px for b in level}
    }
    count = crossed = 0
    for course, places in joints.items():
        beside = [place for other in (course - 1, course + 1) for place in joints.get(other, ())]
        if {course - 1, course + 1} & joints.keys():
            count += len(places)
            crossed += sum(
                all(abs(place - other) >= OVERLAP * width_px for other in beside)
                for place in places
            )
    return BrickCourses(len(lying), len(level), len(joints), count, crossed)


def head_joints(course: Sequence[Brick]) -> list[float]:
    """Return the middles of the joints between the bricks of a course that are next to each other.

    A joint may be open, by less than the length of a brick: a wider one is a hole.
    """
    row = sorted(course, key=lambda brick: brick.left)
    return [
        (one.right + other.left) / 2
        for one, other in pairwise(row)
        if other.left - one.right < one.right - one.left
    ]


ASPECTS = (2.0, 3.0)
HEIGHT_PX = 12

Bricks = Sequence[tuple[float, Trials, Wall]]
"""Aspect, run and wall; all aspects from one side, then from both."""


def brick_walls(context: Context, size: tuple[int, int] | None = None) -> Bricks:
    """Build walls of bricks of both aspects; bricks are enough for all courses."""
    # The width in px is a whole number of either brick.
    width, courses = size or ((72, 4) if context.quick else (216, 17))
    walls = [_brick_wall(aspect, width, courses).here(context.data) for aspect in ASPECTS]
    sides: Mapping[str, Changes] = {"one side": (), "two sides": TWO_SIDED}
    found = StudyWalls.built(context, walls, sides, (context.seed,))
    return [
        (aspect, one, one.built())
        for side in sides
        for aspect, one in zip(ASPECTS, found.of(side), strict=True)
    ]


def _brick_wall(aspect: float, width: int, courses: int) -> Target:
    long = round(HEIGHT_PX * aspect)
    count, size = courses * width // long, (width, courses * HEIGHT_PX, 1.0)
    made = generated("brick", 1, count=count, height_px=HEIGHT_PX, aspect=aspect)
    source = published(f"bricks/brick_{long}_{HEIGHT_PX}.png", copies=count)
    name = f"aspect {aspect:g}"
    return Target(name, source, *size, instead=partial(Target, name, made, *size, stand_in=True))


def _bricks(found: Bricks) -> Rows:
    for aspect, one, wall in found:
        outcome, spec = one.outcomes[0], one.specs[0]
        courses = courses_of(bricks_of(wall), HEIGHT_PX, round(HEIGHT_PX * aspect))
        yield (
            aspect, one.wall.said, one.way, f"{spec.width:g} x {spec.height:g}",
            *placed_of(outcome), *metric_cells(outcome.figures), *courses,
        )  # fmt: skip


def _bricks_picture(found: Bricks) -> ItemFigure:
    walls = []
    for aspect, one, wall in found:
        outcome = one.outcomes[0]
        # Bricks are one cluster: a colour each tells them apart, as in the paper.
        colours = {brick: number for number, brick in enumerate(sorted(outcome.clusters), 1)}
        title = f"aspect {aspect:g}, from {one.way}: F_SF {outcome.figures['F_SF']:.2f}"
        walls.append(wall_panel(title, wall, colours))
    return ItemFigure("figB34", sheet_of(walls, len(ASPECTS)))


BRICKS = PaperItem(
    study=brick_walls,
    tables={"walls": _bricks},
    pictures=lambda found: [_bricks_picture(found)],
)
