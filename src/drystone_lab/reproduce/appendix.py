"""Fig. B.33: 91 irregular stones; Fig. B.34: bricks of aspect 2 and 3 (B.2)."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from itertools import pairwise

from drystone.model.wall import Wall
from drystone_lab.pictures.walls import plot_walls
from drystone_lab.reproduce.cells import METRICS, metric_cells
from drystone_lab.reproduce.item import Context, ItemPicture, PaperItem, paper
from drystone_lab.reproduce.study import StudyWalls, Trials, built
from drystone_lab.runs.spec import Changes, generated, published
from drystone_lab.table import Cell, Table
from drystone_lab.walls import TWO_SIDED, Target, coarser

OVERLAP = 0.25
"""Of the brick's length, by which head joints of neighbouring courses are apart at least: the
usual rule of a bond."""


@dataclass(frozen=True)
class Brick:
    """The box of a placed brick, px; full when it fills it, so that it is not turned."""

    left: int
    right: int
    bottom: int
    top: int
    full: bool


@dataclass(frozen=True)
class BrickCourses:
    """What the courses of a wall are like."""

    bricks: int
    lying: int  # With their long side level
    in_course: int  # Lying, with their foot at a whole number of brick heights
    courses: int
    joints: int  # Head joints within courses that have a course next to them
    # Those that are apart from all head joints of the courses beside them by :data:`OVERLAP`
    crossed: int


def bricks_of(wall: Wall) -> tuple[Brick, ...]:
    """Return the boxes of the stones of a wall of pixels."""
    bricks = []
    for placement in wall.placements:
        rows, cols = placement.window
        height = wall.site.height_px
        bricks.append(
            Brick(cols.start, cols.stop, height - rows.stop, height - rows.start,
                  bool(placement.posed.mask.all()))
        )  # fmt: skip
    return tuple(bricks)


def courses_of(bricks: Sequence[Brick], height_px: int, width_px: int) -> BrickCourses:
    """Look at the courses of equal bricks, of the size of one that lies.

    >>> low = [Brick(0, 20, 0, 10, True), Brick(20, 40, 0, 10, True)]
    >>> courses_of([*low, Brick(10, 30, 10, 20, True), Brick(30, 50, 10, 20, True)], 10, 20)
    BrickCourses(bricks=4, lying=4, in_course=4, courses=2, joints=2, crossed=2)
    """
    lying = [b for b in bricks if b.full and b.right - b.left == width_px]
    level = [b for b in lying if b.bottom % height_px == 0]
    by_course: dict[int, list[Brick]] = {}
    for brick in level:
        by_course.setdefault(brick.bottom // height_px, []).append(brick)
    joints = {course: head_joints(found) for course, found in by_course.items()}
    count = crossed = 0
    for course, places in joints.items():
        if not {course - 1, course + 1} & set(joints):
            continue
        beside = joints.get(course - 1, []) + joints.get(course + 1, [])
        count += len(places)
        crossed += sum(
            all(abs(place - other) >= OVERLAP * width_px for other in beside) for place in places
        )
    return BrickCourses(len(bricks), len(lying), len(level), len(by_course), count, crossed)


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


SIDES: Mapping[str, Changes] = {"one side": (), "two sides": TWO_SIDED}

PAPER_PLACED = (90, 91)
"""Of 91, in the left and in the right wall."""


def _irregular(count: int, width_px: int, height_px: int, courses: int) -> Target:
    """Return rubble as irregular as ours can be, of sizes that differ by a factor.

    It has about as many pixels a stone as the paper's PR has, and as much wall as its best walls
    fill.
    """
    source = generated(
        "rubble", 2024, count=count, width_px=float(width_px), height_px=float(height_px),
        area_ratio=0.75, courses=courses, spread=0.6, roughness=0.3, pentagons=0.5, rounding=0.2,
        tilt_deg=45.0,
    )  # fmt: skip
    name = f"{count} generated stones"
    return Target(name, source, width_px, height_px, 1.0, stand_in=True)


RUBBLE = Target(
    "91 irregular stones", published("rubble/rubble.png", mask=True, min_area_px=20), 0, 0, 0.5,
    instead=partial(_irregular, 91, 480, 200, 8),
)  # fmt: skip
"""The paper does not tell the size of the wall: it is that of the picture of the stones, which
also shows an opening and wide joints."""


def irregular_walls(context: Context) -> StudyWalls:
    """Build walls from one end and from both; in the full version at two working resolutions."""
    wall = RUBBLE.here(context.data)
    walls = (coarser(wall, 0.25), *(() if context.quick else (wall,)))
    return built(context, walls, SIDES, (context.seed,))


def _irregular_table(found: StudyWalls) -> Table:
    rows: list[tuple[Cell, ...]] = []
    for one in found:
        outcome = one.outcomes[0]
        clusters = len({*outcome.clusters.values()})
        figures = outcome.figures
        rows.append(
            (found.name, one.wall.said, one.wall.scale, one.way, figures["placed"],
             figures["stones"], clusters, *metric_cells(outcome), figures["wedges"])
        )  # fmt: skip
    rows += [("the paper's", "published", None, f"wall {n}", placed, 91, *[None] * 6)
             for n, placed in enumerate(PAPER_PLACED, 1)]  # fmt: skip
    columns = (
        "stones", "stones are", "scale", "built from", "placed", "of", "clusters", *METRICS,
        "wedges",
    )  # fmt: skip
    return Table("Walls of many irregular stones", columns, tuple(rows))


def _irregular_picture(found: StudyWalls) -> ItemPicture:
    walls = [
        found.titled(one, f"{found.name} at {one.wall.scale:g}, from {one.way}") for one in found
    ]
    return ItemPicture(
        "figB33", plot_walls(walls, 2),
        f"Walls of {found.name}, built from one end and from both; stones of one cluster have "
        "one colour, numbers are the order of placement, wedges are dark red.",
    )  # fmt: skip


IRREGULAR = PaperItem(
    **paper("figB33"),
    study=irregular_walls,
    tables={"walls": _irregular_table},
    pictures=lambda found: (_irregular_picture(found),),
)

ASPECTS = (2.0, 3.0)
HEIGHT_PX = 12

FULL_SIZE, QUICK_SIZE = (216, 17), (72, 4)
"""Width of the wall in px, which is a whole number of either brick, and courses."""


Bricks = Sequence[tuple[float, Trials, Wall]]
"""Aspect, run and wall; all aspects from one side, then from both."""


def brick_walls(context: Context, size: tuple[int, int] | None = None) -> Bricks:
    """Build walls of bricks of both aspects; bricks are enough for all courses."""
    width, courses = size or (QUICK_SIZE if context.quick else FULL_SIZE)
    walls = [_brick_wall(aspect, width, courses).here(context.data) for aspect in ASPECTS]
    found = built(context, walls, SIDES, (context.seed,))
    return [
        (aspect, one, found.wall(one))
        for side in SIDES
        for aspect, one in zip(ASPECTS, found.of(side), strict=True)
    ]


def _brick_wall(aspect: float, width: int, courses: int) -> Target:
    long = round(HEIGHT_PX * aspect)
    count, size = courses * width // long, (width, courses * HEIGHT_PX, 1.0)
    made = generated("brick", 1, count=count, height_px=HEIGHT_PX, aspect=aspect)
    source = published(f"bricks/brick_{long}_{HEIGHT_PX}.png", copies=count)
    name = f"aspect {aspect:g}"
    return Target(name, source, *size, instead=partial(Target, name, made, *size, stand_in=True))


def _bricks_table(found: Bricks) -> Table:
    rows: list[tuple[Cell, ...]] = []
    for aspect, one, wall in found:
        outcome, spec = one.outcomes[0], one.specs[0]
        courses = courses_of(bricks_of(wall), HEIGHT_PX, round(HEIGHT_PX * aspect))
        rows.append(
            (
                aspect, one.wall.said, one.way, f"{spec.width:g} x {spec.height:g}",
                outcome.figures["placed"],
                outcome.figures["stones"], *metric_cells(outcome), courses.lying,
                courses.in_course, courses.courses, courses.joints, courses.crossed,
            )
        )  # fmt: skip
    return Table(
        "Walls of bricks of one size",
        ("aspect", "bricks are", "built from", "wall, px", "placed", "of", *METRICS, "lying",
         "in courses", "courses", "head joints", "crossed"),
        tuple(rows),
        (
            f"Crossed: {OVERLAP:g} of the brick's length or more from every head joint of the "
            "courses above and below.",
        ),
    )  # fmt: skip


def _bricks_picture(found: Bricks) -> ItemPicture:
    walls = []
    for aspect, one, wall in found:
        outcome = one.outcomes[0]
        # Bricks are one cluster: a colour each tells them apart, as in the paper.
        colours = {brick: number for number, brick in enumerate(sorted(outcome.clusters), 1)}
        title = f"aspect {aspect:g}, from {one.way}: F_SF {outcome.figures['F_SF']:.2f}"
        walls.append((title, wall, colours))
    return ItemPicture(
        "figB34", plot_walls(walls, len(ASPECTS)),
        "Walls of bricks of aspect 2 and 3, coloured for differentiation and numbered in order of "
        "placement.",
    )  # fmt: skip


BRICKS = PaperItem(
    **paper("figB34"),
    study=brick_walls,
    tables={"walls": _bricks_table},
    pictures=lambda found: (_bricks_picture(found),),
)
