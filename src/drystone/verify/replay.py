"""Build a planned wall again from the input stones and the poses alone (DESIGN 2)."""

from collections.abc import Sequence
from dataclasses import dataclass

from drystone.errors import PlanError
from drystone.model.placement import Placement, Wedge
from drystone.model.plan import Plan, StoneStep, WedgeStep
from drystone.model.site import Site
from drystone.model.steps import Step, grouped, id_fault
from drystone.model.stone import StoneSet
from drystone.model.wall import Group, Labels, Wall
from drystone.planner.settings import PlannerSettings
from drystone.verify.canvas import ExactCanvas, PlanPiece, RasterCanvas
from drystone.verify.lengths import plan_settings, plan_site
from drystone.verify.report import Problem


@dataclass(frozen=True, eq=False)
class Stage:
    """The wall before and after one stone and its wedges."""

    stone: StoneStep
    last: StoneStep | WedgeStep  # the last step of the group, which claims the load multipliers
    before: Wall  # the wall without and with the group
    after: Wall

    @property
    def group(self) -> Group:
        """The stone and its wedges."""
        return self.after.groups[-1]


@dataclass(frozen=True, eq=False)
class Replay:
    """A plan played again."""

    settings: PlannerSettings
    site: Site
    pieces: tuple[PlanPiece, ...]  # everything that could be derived, in order
    labels: Labels
    """(h, w): all of it drawn, row 0 at the top; where pixels of two pieces overlap the first one
    is seen, where outlines do the one that covers most."""
    stages: tuple[Stage, ...]  # the wall as it grows, up to the first group that cannot be built
    broken_at: int | None  # first step of that group; None when the whole wall was built
    problems: tuple[Problem, ...]
    """E212, E213: ids; E214: order of steps; E217: settings; E220: outside the site; E221: overlap;
    E222: a wedge whose polygon is none."""

    @property
    def exact(self) -> bool:
        """True when stones are their outlines."""
        return self.settings.geometry == "exact"

    @property
    def wall(self) -> Wall:
        """The wall as far as it could be built."""
        return self.stages[-1].after if self.stages else Wall.empty(self.site, exact=self.exact)


def rebuild_wall(plan: Plan, stones: StoneSet) -> Wall:
    """Return the wall of a plan, derived from the input stones and the poses alone.

    On the raster each stone is turned, reduced and rasterised from its source pixels, with its
    centroid where the plan puts it (to the nearest 1/64 working px); on exact geometry its outline
    is.  Wedges come from their polygons.  The first problem of :class:`Replay` is a PlanError, as
    is a wall that is too large or too small to be an image (E215).
    """
    replay = replay_plan(plan, stones)
    if replay.problems:
        first = replay.problems[0]
        raise PlanError(
            first.code,
            first.message,
            where="settings" if first.step is None else f"step {first.step}",
            cure="Give the stones that the plan was made from; `drystone check` lists everything.",
        )
    return replay.wall


def replay_plan(plan: Plan, stones: StoneSet) -> Replay:
    """Play a plan again and collect what stands in the way; PlanError (E215) as above."""
    settings, problems = plan_settings(plan)
    site = plan_site(plan)
    groups, disorder = grouped(plan.steps)
    problems += disorder
    exact = settings.geometry == "exact"
    canvas = ExactCanvas(site, stones, settings.settle) if exact else RasterCanvas(site, stones)
    wall, broken_at = Wall.empty(site, exact=exact), None
    pieces: list[PlanPiece] = []
    stages: list[Stage] = []
    used: set[int] = set()
    for steps in groups:
        derived, found = _derive(steps, canvas, stones, used)
        pieces += derived
        problems += found
        if found and broken_at is None:
            broken_at = steps[0].step
        if broken_at is None:
            before = wall
            placement, *wedges = (piece.item for piece in derived)
            assert isinstance(placement, Placement)  # noqa: S101 - a group starts with a stone
            assert isinstance(steps[0], StoneStep)  # noqa: S101
            wall = wall.add(placement, tuple(w for w in wedges if isinstance(w, Wedge)))
            stages.append(Stage(steps[0], steps[-1], before, wall))
    return Replay(
        settings, site, tuple(pieces), canvas.labels, tuple(stages), broken_at, tuple(problems)
    )


def _derive(
    steps: Sequence[Step], canvas: ExactCanvas | RasterCanvas, stones: StoneSet, used: set[int]
) -> tuple[list[PlanPiece], list[Problem]]:
    """Turn the steps of a group into what they place; note their ids as used."""
    pieces: list[PlanPiece] = []
    problems = []
    largest = max((stone.id for stone in stones), default=0)
    for step in steps:
        try:
            piece, found = canvas.put(step)
        except PlanError as error:
            code = "E212" if error.code == "E201" else error.code
            problems.append(Problem(code, step.step, error.what))
        else:
            pieces.append(piece)
            repeated = id_fault(step, used, largest)
            problems += found if repeated is None else [repeated, *found]
    return pieces, problems
