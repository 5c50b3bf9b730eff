"""Pictures of what `drystone check` found to fail, and of the risk that `rehearse` found."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from drystone.drawing.canvas import MARGIN_IN, WIDTH_IN, draw, save
from drystone.drawing.drawing import Drawable, Drawing, Lines, Surface, Words, ground, step_by_id
from drystone.drawing.outlines import Bounds, Loop, rectangle, regions_box, wall_regions
from drystone.drawing.palette import GREY, OUTLINE_COLOUR, PALE, rgb
from drystone.drawing.pictures.mechanism import motion_of
from drystone.drawing.words.checked import PICTURE, Checked, Rehearsed
from drystone.errors import PlanError
from drystone.model.plan import Point
from drystone.model.steps import Problem, piece_id
from drystone.statics.limit import lateral_resistance
from drystone.verify.claims import wall_model
from drystone.verify.outlines import common_areas
from drystone.verify.replay import replay_plan

MISPLACED = ("E220", "E221", "E222", "E223", "E224", "E240")
"""Problems of a stone or wedge where it lies."""

OVERLAPS, FALLS, OTHER_PIXELS, NOT_STURDY = "E221", "E230", "E236", "E237"

NOTABLE = 0.02  # blocks that move by this share of the largest movement belong to a mechanism
CONCERNED = "#f0a030"
PLANNED = "#0050a0"
PLANNED_PALE = "#90b0d8"
COMMON = "#c00020"
DASHES, DOTS = (4.0, 2.0), (1.0, 1.65)

NOTICEABLE = 4e-3
"""Blocks that have moved by this share of the wall's height are shown where they were planned."""

LEGEND_IN, TITLE_IN = 0.3, 0.3
HEIGHT_IN = 5.0  # largest height of one view


@dataclass(frozen=True, eq=False)
class FailureView:
    """A wall and what fails in it; lengths in source px, wall frame.

    `concerned` are the blocks that fail, `ended` where blocks ended that moved, `common` areas that
    two blocks claim, `size` that of the wall that was to be built.
    """

    title: str
    planned: Mapping[int, Loop]
    size: Point
    concerned: Sequence[int] = ()
    ended: Mapping[int, Loop] = field(default_factory=dict)
    common: Sequence[Loop] = ()

    @property
    def box(self) -> Bounds:
        """What is to be seen."""
        frame = np.array([(0.0, 0.0), self.size])
        x0, y0, x1, y1 = regions_box([[*self.planned.values(), *self.ended.values(), frame]])
        pad = 0.03 * max(y1 - y0, 0.2 * (x1 - x0))
        return x0 - pad, min(y0, 0.0) - 2 * pad, x1 + pad, y1 + pad


def draw_check(checked: Checked, asked: Path | None, folder: Path) -> tuple[str | None, str] | None:
    """Draw what fails beside the plan, or whatever there is where it is asked for.

    Return the path, None when it could not be written, and the same in words; None when there is
    nothing to be seen.
    """
    views, path = views_of(checked), asked or folder / PICTURE
    if asked is not None:
        views = views or _whole_wall(checked)
    if not views:
        return None
    replaced = " (in place of that of an earlier check)" if path.exists() and not asked else ""
    try:
        save(plot_failures(views), path)
    except PlanError as error:
        if asked is not None:
            raise
        # The check is done, and plans may lie where nothing can be written.
        return None, f"not written: {path}: {error.what} Give a place with --picture."
    return str(path), f"{path}{replaced}"


def views_of(checked: Checked) -> list[FailureView]:
    """Return what is to be drawn: nothing when nothing that can be seen fails."""
    planned, problems = checked.planned, checked.report.problems
    if not planned:
        return []
    views = []
    misplaced = [problem for problem in problems if problem.code in MISPLACED]
    # What lies elsewhere has other pixels too; that alone means another image.
    lying = misplaced or [p for p in problems if p.code == OTHER_PIXELS and p.step is not None]
    if lying:
        more = f" ... and {len(lying) - 1} more" if len(lying) > 1 else ""
        ids = _ids(checked, {problem.step for problem in lying})
        common = common_areas(planned, _ids(checked, {p.step for p in lying if p.code == OVERLAPS}))
        title = f"{_short(lying[0])}{more}"
        views.append(FailureView(title, planned, checked.size, ids, common=common))
    falling = next((p for p in problems if p.code in (FALLS, NOT_STURDY)), None)
    if falling is not None:
        views.append(_unstable(checked, falling))
    return [*views, *_whole_wall(checked)] if checked.falls else views


def _whole_wall(checked: Checked) -> list[FailureView]:
    """Return the wall where the engine left it, or as it was planned."""
    planned, physics = checked.planned, checked.physics
    if not planned:
        return []
    if physics is None:
        return [FailureView(f"The plan {checked.verdict}", planned, checked.size)]
    name, outcome = physics.rows()[0]
    title = f"{name[0].upper()}{name[1:]}: {outcome}"
    built = physics.built
    return [FailureView(title, planned, checked.size, built.fallen, built.outlines)]


def _unstable(checked: Checked, problem: Problem) -> FailureView:
    """Return the first wall on the way that does not stand, and how it begins to fall."""
    replay = replay_plan(checked.plan, checked.stones)
    stage = next(stage for stage in replay.stages if stage.last.step == problem.step)
    there, title = step_by_id(stage.after), _short(problem)
    planned = {block: loop for block, loop in checked.planned.items() if block in there}
    # With all its friction a wall that is not sturdy does not begin to fall.
    model = wall_model(stage.after, replay.settings) if problem.code == FALLS else None
    mechanism = None if model is None else lateral_resistance(model, mechanism=True).left.mechanism
    if mechanism is None:
        return FailureView(title, planned, checked.size, _ids(checked, {stage.stone.step}))
    motion = motion_of(planned, mechanism)
    regions = motion.at(1.0)
    shares = zip(regions, motion.share.tolist(), strict=True)
    moving = [region.id for region, share in shares if share > NOTABLE]
    ended = {region.id: region.loops[0] for region in regions}
    title = f"{title} How it begins to fall, enlarged"
    return FailureView(title, planned, checked.size, moving, ended)


def _ids(checked: Checked, steps: set[int | None]) -> list[int]:
    """Return the ids that some steps place, as far as they can be drawn."""
    chosen, planned = (s for s in checked.plan.steps if s.step in steps), checked.planned
    return [block for block in dict.fromkeys(map(piece_id, chosen)) if block in planned]


def _short(problem: Problem) -> str:
    text = str(problem)
    return text if len(text) <= 100 else f"{text[:100].rstrip()} ..."


def plot_failures(views: Sequence[FailureView]) -> Figure:
    """Draw one or more views under each other."""
    boxes = [view.box for view in views]
    heights = [min(WIDTH_IN * (y1 - y0) / (x1 - x0), HEIGHT_IN) for x0, y0, x1, y1 in boxes]
    gap = TITLE_IN + LEGEND_IN
    width, height = WIDTH_IN + 2 * MARGIN_IN, sum(heights) + gap * len(views)
    figure = Figure(figsize=(width, height))
    bottom = height
    for view, tall in zip(views, heights, strict=True):
        bottom -= gap + tall
        left = (MARGIN_IN / width, (bottom + LEGEND_IN) / height)
        plot_failure(view, figure.add_axes((*left, WIDTH_IN / width, tall / height)))
    return figure


def plot_failure(view: FailureView, ax: Axes | None = None) -> Axes:
    """Draw a wall and what fails in it, in source px.

    Blocks are drawn where they ended; those that fail are coloured and numbered, dashed lines
    show where they, and others that have moved, were planned.
    """
    items: list[Drawable] = [*ground(view.box)]
    legend: dict[str, Surface | Lines] = {}
    if view.concerned:
        legend["fails"] = Surface("", (), CONCERNED)
    ended = wall_regions({**view.planned, **view.ended})
    for region in ended:
        # Blocks that fail lie over those that they have got into, and over their numbers.
        fails = region.id in view.concerned
        fill = CONCERNED if fails else PALE
        area = Surface(
            f"block-{region.id}", region.loops, fill, OUTLINE_COLOUR if fails else GREY,
            width_pt=0.8 if fails else 0.5, z=2.0 if fails else 1.0,
        )  # fmt: skip
        number = Words(
            f"number-{region.id}", str(region.id), region.centroid, area.room, fill,
            colour="" if fails else GREY, z=5.0 if fails else 1.5,
        )  # fmt: skip
        items += [area, number]
    moved = _moved(view)
    if moved:
        legend["where it was planned"] = Lines("", [], PLANNED, 1.0, DASHES)
    common = [
        Surface(f"common-{number}", (loop,), COMMON, COMMON, width_pt=0.8, z=4.0)
        for number, loop in enumerate(view.common)
    ]
    if common:
        legend["claimed by two"] = common[0]
    items += [*moved, *common]
    site = rectangle(0.0, 0.0, *view.size)
    items.append(Surface("site", (site,), line=GREY, width_pt=1.0, dashes=DOTS))
    legend["wall that was to be built"] = Lines("", [], GREY, 1.5, DOTS)
    return draw(Drawing(tuple(items), view.box, title=view.title, legend=legend), ax)


def _moved(view: FailureView) -> list[Surface]:
    _, y0, _, y1 = regions_box([loop] for loop in view.planned.values())
    drawn = []
    for block, loop in view.planned.items():
        way = np.hypot(*(view.ended[block] - loop).T).max() if block in view.ended else 0.0
        if way > NOTICEABLE * (y1 - y0):
            fails = block in view.concerned
            drawn.append(
                Surface(f"planned-{block}", (loop,), line=PLANNED if fails else PLANNED_PALE,
                     width_pt=1.0 if fails else 0.5, dashes=DASHES, z=3.0)
            )  # fmt: skip
    return drawn


SURE, UNSURE, ALWAYS = "#d5e8d4", "#f0c050", "#b03030"
"""Stones that never fall, fall in half of the runs, and in all."""


def plot_risk(card: Rehearsed) -> Axes:
    """Draw a plan, in source px; numbers are in how many of 100 runs a stone falls."""
    regions = wall_regions({block: corners for group in card.groups for block, corners in group})
    x0, y0, x1, y1 = regions_box([region.loops for region in regions])
    pad = 0.03 * (y1 - y0)
    box = x0 - pad, min(y0, 0.0) - 2 * pad, x1 + pad, y1 + pad
    items: list[Drawable] = [*ground(box)]
    for region in regions:
        risk, fill = card.risk.get(region.id), PALE
        if risk is not None:
            ends = (SURE, UNSURE) if risk < 0.5 else (UNSURE, ALWAYS)
            share = 2 * risk - (risk >= 0.5)
            mixed = (a + share * (b - a) for a, b in zip(*map(rgb, ends), strict=True))
            fill = "#" + "".join(f"{round(255 * part):02x}" for part in mixed)
        area = Surface(f"block-{region.id}", region.loops, fill)
        items.append(area)
        if risk:
            text = f"{100 * risk:.0f}"
            items.append(Words(f"risk-{region.id}", text, region.centroid, area.room, fill))
    legend = {
        "never falls": Surface("", (), SURE),
        "in half of the runs": Surface("", (), UNSURE),
        "always": Surface("", (), ALWAYS),
    }
    title = f"Stones that fall, of 100 rehearsals; {card.verdict}"
    return draw(Drawing(tuple(items), box, title=title, legend=legend))
