"""Fig. B.34: walls of bricks of one size, of aspect 2 and of aspect 3 (B.2)."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from drystone.model.wall import Wall
from drystone_lab.pictures.wall_grid import plot_walls
from drystone_lab.reproduce.base import TWO_SIDED
from drystone_lab.reproduce.courses import OVERLAP, Courses, bricks_of, courses_of
from drystone_lab.reproduce.item import Context, Item, Output, Picture
from drystone_lab.reproduce.summary import METRICS, metric_cells
from drystone_lab.runs.outcome import Outcome
from drystone_lab.runs.source import Scalar, generated
from drystone_lab.runs.spec import RunSpec
from drystone_lab.table import Cell, Table

ASPECTS = (2.0, 3.0)

SIDES: Mapping[str, tuple[tuple[str, Scalar], ...]] = {"one side": (), "two sides": (TWO_SIDED,)}
"""Changes of the paper's method."""

HEIGHT_PX = 12

HALF = 0.5
"""Bricks by which the wall is longer than a whole number: so that a bond can be flush in every
other course, as there are no halves."""

PAPER = (
    "Fig. B.34 (B.2): 'Walls constructed with bricks of the same size. The wall on the left is "
    "constructed with bricks of an aspect ratio of 2 and the wall on the right is constructed with "
    "bricks of an aspect ratio of 3.' There are no numbers; sizes of the walls are not given.",
)


@dataclass(frozen=True)
class Size:
    """Of a wall of bricks.

    Parameters
    ----------
    length : int
        Bricks in a course; the wall is :data:`HALF` a brick longer.
    courses : int
        As many times the brick's height is the wall.
    """

    length: int
    courses: int

    def run(self, aspect: float, side: str, seed: int) -> RunSpec:
        """Return a run from one of :data:`SIDES`; bricks are enough for all courses."""
        source = generated(
            "brick", 1, count=self.length * self.courses, height_px=HEIGHT_PX, aspect=aspect
        )
        return RunSpec(
            source=source,
            width=(self.length + HALF) * round(HEIGHT_PX * aspect),
            height=self.courses * HEIGHT_PX,
            changes=SIDES[side],
            seed=seed,
        )


FULL, QUICK = Size(8, 8), Size(4, 4)


@dataclass(frozen=True, eq=False)
class Built:
    """A wall of bricks.

    Parameters
    ----------
    aspect : float
        Of the bricks.
    side : str
        Of :data:`SIDES`.
    spec, outcome : RunSpec, Outcome
        The run and what came out.
    wall : Wall
        With its bricks.
    courses : Courses
        What they are like.
    """

    aspect: float
    side: str
    spec: RunSpec
    outcome: Outcome
    wall: Wall
    courses: Courses


def make(context: Context, size: Size | None = None) -> Output:
    """Build walls of bricks of both aspects.

    Parameters
    ----------
    context : Context
        Does and keeps the runs.
    size : Size, optional
        Of the walls.
    """
    size = size or (QUICK if context.quick else FULL)
    asked = [(aspect, side) for side in SIDES for aspect in ASPECTS]
    specs = [size.run(aspect, side, context.seed) for aspect, side in asked]
    built = []
    for (aspect, side), spec, outcome in zip(asked, specs, context.run(specs), strict=True):
        wall = outcome.wall(spec, context.data)
        courses = courses_of(bricks_of(wall), HEIGHT_PX, round(HEIGHT_PX * aspect))
        built.append(Built(aspect, side, spec, outcome, wall, courses))
    return Output(
        paper=PAPER,
        ours=(*(_found(one) for one in built), _why(built)),
        tables=(("walls", _table(built)),),
        pictures=(_picture(built),),
        runs=tuple(specs),
    )


def _found(built: Built) -> str:
    courses, figures = built.courses, built.outcome.figures
    level = "All courses are level" if courses.in_course == courses.bricks else "Not all is level"
    return (
        f"Aspect {built.aspect:g} from {built.side}: {figures['placed']} of {figures['stones']} "
        f"bricks in {courses.courses} courses, F_SF {figures['F_SF']:.3f}. {level}: "
        f"{courses.in_course} of {courses.bricks} bricks lie at a whole number of brick heights. "
        f"{courses.crossed} of {courses.joints} head joints are crossed: {OVERLAP:g} of a brick or "
        "more from those of the courses beside them."
    )


def _why(built: Sequence[Built]) -> str:
    clusters = max(len({*one.outcome.clusters.values()}) for one in built)
    number = "one cluster" if clusters == 1 else f"{clusters} clusters at most"
    crossed = sum(one.courses.crossed for one in built)
    joints = sum(one.courses.joints for one in built)
    words = (
        f"The bricks of a wall are in {number}, so that variant sampling has next to nothing to "
        "choose from: Eq. 12 alone says where the next one lies, and the indices that reward a "
        f"bond compare stones, not places. In all, {crossed} of {joints} head joints are crossed."
    )
    if 2 * crossed >= joints:
        return words
    return (
        f"{words} §5.3 says the like of stones of little variety: easy to stack and to fill with, "
        "'but it often results in walls with inferior interlocking'."
    )


def _table(built: Sequence[Built]) -> Table:
    rows: list[tuple[Cell, ...]] = [
        (
            one.aspect, one.side, f"{one.spec.width:g} x {one.spec.height:g}",
            one.outcome.figures["placed"], one.outcome.figures["stones"],
            *metric_cells(one.outcome), one.courses.lying, one.courses.in_course,
            one.courses.courses, one.courses.joints, one.courses.crossed,
        )
        for one in built
    ]  # fmt: skip
    return Table(
        "Walls of bricks of one size",
        ("aspect", "built from", "wall, px", "placed", "of", *METRICS, "lying", "in courses",
         "courses", "head joints", "crossed"),
        tuple(rows),
        (
            f"Crossed: {OVERLAP:g} of the brick's length or more from every head joint of the "
            "courses above and below.",
        ),
    )  # fmt: skip


def _picture(built: Sequence[Built]) -> Picture:
    walls = []
    for one in built:
        # Bricks are one cluster: a colour each tells them apart, as in the paper.
        colours = {brick: number for number, brick in enumerate(sorted(one.outcome.clusters), 1)}
        title = f"aspect {one.aspect:g}, from {one.side}: F_SF {one.outcome.figures['F_SF']:.2f}"
        walls.append((title, one.wall, colours))
    return Picture(
        "figB34", plot_walls(walls, len(ASPECTS)),
        "Walls of bricks of aspect 2 and 3, coloured for differentiation and numbered in order of "
        "placement.",
    )  # fmt: skip


ITEM = Item("bricks of aspect 2 and 3", "B.2", make)
