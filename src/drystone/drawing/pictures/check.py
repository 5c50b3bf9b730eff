"""The picture of what `drystone check` found to fail."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from drystone.drawing.files import save
from drystone.drawing.outlines import Loop
from drystone.drawing.pictures.failures import FailureView, plot_failures
from drystone.drawing.pictures.mechanism import motion_of
from drystone.drawing.words.checked import PICTURE, Checked
from drystone.errors import PlanError
from drystone.model.steps import piece_id
from drystone.statics.limit import lateral_resistance
from drystone.verify.outlines import common_areas
from drystone.verify.replay import Stage, replay_plan
from drystone.verify.report import Problem
from drystone.verify.stability import wall_model

MISPLACED = ("E220", "E221", "E222", "E223", "E224", "E240")
"""Problems of a stone or wedge where it lies."""

OVERLAPS, FALLS, OTHER_PIXELS, NOT_STURDY = "E221", "E230", "E236", "E237"

NOTABLE = 0.02
"""Blocks that move by this share of the largest movement belong to a mechanism."""


@dataclass(frozen=True)
class Drawn:
    """A picture that was written, or not.

    Parameters
    ----------
    path : str or None
        Where it is; None when it could not be written.
    words : str
        The same, with what there is to know.
    """

    path: str | None
    words: str


def draw_asked(checked: Checked, path: Path) -> Drawn | None:
    """Draw what fails or, when nothing does, the wall; None for a plan without stones."""
    views = views_of(checked) or _whole_wall(checked)
    if not views:
        return None
    save(plot_failures(views), path)
    return Drawn(str(path), str(path))


def draw_failures(checked: Checked, folder: Path) -> Drawn | None:
    """Draw what fails beside the plan; None when nothing of it can be seen."""
    views, path = views_of(checked), folder / PICTURE
    if not views:
        return None
    replaced = " (in place of that of an earlier check)" if path.exists() else ""
    try:
        save(plot_failures(views), path)
    except PlanError as error:
        # The check is done, and plans may lie where nothing can be written.
        return Drawn(None, f"not written: {path}: {error.what} Give a place with --picture.")
    return Drawn(str(path), f"{path}{replaced}")


def views_of(checked: Checked) -> list[FailureView]:
    """Return what is to be drawn: nothing when nothing that can be seen fails."""
    planned = _planned(checked)
    if not planned:
        return []
    views = []
    problems = checked.report.problems
    misplaced = [problem for problem in problems if problem.code in MISPLACED]
    # What lies elsewhere has other pixels too; that alone means another image.
    pixels = [p for p in problems if p.code == OTHER_PIXELS and p.step is not None]
    if misplaced or pixels:
        views.append(_misplaced(checked, planned, misplaced or pixels))
    falling = next((p for p in problems if p.code in (FALLS, NOT_STURDY)), None)
    if falling is not None:
        views.append(_unstable(checked, planned, falling))
    if checked.falls:
        views += _whole_wall(checked)
    return views


def _whole_wall(checked: Checked) -> list[FailureView]:
    """Return the wall where the engine left it, or as it was planned."""
    planned, physics = _planned(checked), checked.physics
    if not planned:
        return []
    if physics is None:
        return [FailureView(f"The plan {checked.verdict}", planned, size=_size(checked))]
    name, outcome = physics.rows()[0]
    title = f"{name[0].upper()}{name[1:]}: {outcome}"
    built = physics.built
    return [FailureView(title, planned, built.fallen, built.outlines, size=_size(checked))]


def _misplaced(
    checked: Checked, planned: Mapping[int, Loop], problems: Sequence[Problem]
) -> FailureView:
    """Return the whole wall with the stones that lie wrong."""
    overlapping = {problem.step for problem in problems if problem.code == OVERLAPS}
    title = _short(str(problems[0]))
    if len(problems) > 1:
        title += f" ... and {len(problems) - 1} more"
    return FailureView(
        title,
        planned,
        _ids(checked, {problem.step for problem in problems}, planned),
        common=common_areas(planned, _ids(checked, overlapping, planned)),
        size=_size(checked),
    )


def _unstable(checked: Checked, planned: Mapping[int, Loop], problem: Problem) -> FailureView:
    """Return the first wall on the way that does not stand, and how it begins to fall."""
    replay = replay_plan(checked.plan, checked.stones)
    stage = next(stage for stage in replay.stages if stage.last.step == problem.step)
    standing = {block: loop for block, loop in planned.items() if block in _there(stage)}
    title = _short(str(problem))
    # With all its friction a wall that is not sturdy does not begin to fall.
    model = wall_model(stage.after, replay.settings) if problem.code == FALLS else None
    mechanism = None if model is None else lateral_resistance(model, mechanism=True).left.mechanism
    if mechanism is None:
        last = _ids(checked, {stage.stone.step}, planned)
        return FailureView(title, standing, last, size=_size(checked))
    motion = motion_of(standing, mechanism)
    blocks = list(zip(motion.regions, motion.at(1.0), motion.share.tolist(), strict=True))
    return FailureView(
        f"{title} How it begins to fall, enlarged",
        standing,
        [region.id for region, _, share in blocks if share > NOTABLE],
        {region.id: loops[0] for region, loops, _ in blocks},
        size=_size(checked),
    )


def _there(stage: Stage) -> set[int]:
    """Return the ids of all stones and wedges of a wall on the way."""
    groups = stage.after.groups
    stones = {group.placement.stone_id for group in groups}
    return stones | {wedge.id for group in groups for wedge in group.wedges}


def _planned(checked: Checked) -> dict[int, Loop]:
    return {block: corners for group in checked.groups for block, corners in group}


def _ids(checked: Checked, steps: set[int | None], planned: Mapping[int, Loop]) -> list[int]:
    """Return the ids that some steps place, as far as they can be drawn."""
    ids = [piece_id(step) for step in checked.plan.steps if step.step in steps]
    return [block for block in dict.fromkeys(ids) if block in planned]


def _size(checked: Checked) -> tuple[float, float]:
    """Return width and height of the wall that is to be built, source px."""
    source_px = checked.plan.px_per_m or 1.0
    return checked.plan.width * source_px, checked.plan.height * source_px


def _short(text: str, most: int = 100) -> str:
    return text if len(text) <= most else f"{text[:most].rstrip()} ..."
