"""What `plan` and `demo` share: plan, write everything, print the summary."""

import argparse
import math
from contextlib import nullcontext
from dataclasses import replace
from pathlib import Path
from typing import Any

from drystone.cli import choice, keeping
from drystone.cli.numbers import picture_size_px, refuse_outside, scale_notice
from drystone.cli.output import note, print_json, print_table, working_in
from drystone.cli.progress import step_bar
from drystone.cli.settings import PlanRequest
from drystone.drawing.export.formats import FORMATS, ExportSettings
from drystone.drawing.words.planned import ending, profile_rows, profile_summary, rows, summary
from drystone.errors import DrystoneError, ExitCode, Notice, UsageError, counted
from drystone.io.checkpoint import CHECKPOINT
from drystone.io.folder_lock import LOCK, locked
from drystone.io.photo_beside import check_place, photo_beside, place_photo
from drystone.io.photo_file import read_photo_picture
from drystone.io.plan_folder import write_plan_folder
from drystone.model.site import Site
from drystone.model.stone import StoneSet
from drystone.model.stone_size import median_sides, sides_px
from drystone.planner.events import UNFINISHED
from drystone.planner.workshop import fitting_stones
from drystone.search.interrupts import held
from drystone.search.plan_result import PlanResult
from drystone.search.plan_wall import plan_wall
from drystone.verify.replay import rebuild_wall

FILM_STONES = 100
"""Walls of more stones get a film by `drystone export` alone: a frame a stone takes its time."""

_EXIT = {
    "complete": ExitCode.DONE,
    "incomplete": ExitCode.INCOMPLETE,
    "interrupted": ExitCode.INTERRUPTED,
}


def add_writing(command: argparse.ArgumentParser) -> None:
    """Add the options of what is written and printed."""
    # fmt: off
    option = command.add_argument_group("output").add_argument
    option("--overwrite", action="store_true", help="write into a folder that has files")
    option("--json", action="store_true", help="print the summary as JSON")
    for name in ("--pareto", "--quiet", "--profile"):
        option(name, action="store_true")


def plan_and_write(request: PlanRequest, *, prepared: bool = False) -> ExitCode:
    """Plan a wall, write all files, print the summary; `prepared` when the folder is locked."""
    stones, folder, photo = request.stones, request.folder, request.photo
    earlier = keeping.earlier_run(request)
    if earlier.plan is not None and earlier.plan.stopped not in UNFINISHED:
        # A run that was killed at its very end has left its lock, which goes with this one.
        left = (folder / LOCK).exists() and not prepared
        with locked(folder, choice.PLACES) if left else nullcontext():
            return _EXIT[keeping.tell_finished(earlier.plan, request)]
    earlier.tell()
    # What cannot be meant is refused before a folder is made: E138 of a ruler, E144, E126.
    refuse_outside(request.px_per_m, picture_size_px(stones.source))
    site = Site.from_source(*request.wall, request.scale, request.px_per_m)
    begin, begin_wall = keeping.plan_to_begin_with(request, site)
    begun = earlier.plan or begin
    if not fitting_stones(stones, site, request.settings):
        what = (
            f"none of the {len(stones)} stones can be built with: each is banned, or fits into "
            "the wall in no orientation."
        )
        cure = "Build a larger wall, or ban fewer stones."
        raise UsageError("E126", what, where=stones.source.path, cure=cure)
    # What would stop the report after the search is refused before it: E129, E189.
    check_place(photo, folder)
    if photo is not None:
        read_photo_picture(photo, (stones.source.width_px, stones.source.height_px))
    if request.options.pareto:
        choice.prepare_choice(folder)
    overwrite = request.options.overwrite or earlier.begun
    ready = working_in(
        folder, (*keeping.WRITTEN, CHECKPOINT), overwrite=overwrite, within=choice.PLACES
    )
    with nullcontext() if prepared else ready:
        keeper = keeping.Keeper(folder, keeping.made_of(request), photo)
        keeper.begin(earlier.state)
        _announce(request)
        seconds = request.options.time
        bar = step_bar(len(stones), request.settings, seconds, quiet=request.quiet)
        with bar as callbacks:
            result = plan_wall(
                stones,
                *request.wall,
                seed=request.options.seed,
                method=request.method,
                settings=request.settings,
                scale=request.scale,
                px_per_m=request.px_per_m,
                budget=request.settings.search.budget,
                seconds=math.inf if request.seconds is None else request.seconds,
                first_whole=seconds is None,  # where time is but a guard, it is built to its end
                n_jobs=request.options.jobs,
                callbacks=callbacks,
                built=None if earlier.plan is None else rebuild_wall(earlier.plan, stones),
                course_heights_px=None if begun is None else begun.course_heights_px,
                begin=begin_wall,
                choice=request.options.pareto,
                keep=keeper,
                state=earlier.state,
            )
        # What it has come to is not lost by a second interrupt.
        with held():
            return _written_and_told(result, request, keeper)


def _announce(request: PlanRequest) -> None:
    """Say what is planned with, and when its scale or its method is odd."""
    stones, px_per_m = request.stones, request.px_per_m
    if not request.quiet:
        walls, seconds, more = request.settings.search.budget, None, ""
        if walls > 1:
            seconds = request.options.time
            more = f"{'' if seconds is not None else f', {walls} walls'} (--time, --budget)"
        note(f"{read_line(stones, request.wall, px_per_m, seconds)}{more}")
    if request.method != request.options.method:
        note(
            f"{request.options.settings} has every setting, so that nothing of --method "
            f"{request.options.method} is left; the plan names the method custom"
        )
    median_px, _ = median_sides(sides_px(stone.mask) for stone in stones)
    note(scale_notice(median_px, px_per_m))


def read_line(
    stones: StoneSet, wall: tuple[float, float], px_per_m: float | None, seconds: float | None
) -> str:
    """Say how many stones were read, how large they and the wall (source px) are, and how long.

    `seconds` is how long better walls are looked for; None when that is not known.

    Examples
    --------
    >>> import numpy as np
    >>> from drystone.model.stone import Stone
    >>> stones = StoneSet((Stone(1, np.ones((12, 31), bool)),))
    >>> read_line(stones, (280, 80), 200.0, 3.6)
    'Read 1 stone (largest 15.5 x 6.0 cm, median 15.5 x 6.0 cm), wall 1.40 x 0.40 m, estimate 4 s'
    """
    said = f"Read {counted(len(stones), 'stone')}"
    if len(stones):
        biggest = sides_px(max(stones, key=lambda stone: stone.area_px).mask)
        median = median_sides(sides_px(stone.mask) for stone in stones)
        said += f" (largest {_size(*biggest, px_per_m)}, median {_size(*median, px_per_m)})"
    said += f", wall {_size(*wall, px_per_m)}"
    return said if seconds is None else f"{said}, estimate {max(seconds, 1.0):.0f} s"


def _size(width: float, height: float, px_per_m: float | None) -> str:
    if px_per_m is None:
        return f"{round(width, 1):g} x {round(height, 1):g} px"
    width, height = width / px_per_m, height / px_per_m
    if max(width, height) < 1.0:
        return f"{100 * width:.1f} x {100 * height:.1f} cm"
    return f"{width:.2f} x {height:.2f} m"


def _written_and_told(result: PlanResult, request: PlanRequest, keeper: keeping.Keeper) -> ExitCode:
    """Write all files and print the summary; also that of a wall that cannot be written."""
    folder = request.folder
    note(*result.notices)
    failed: Exception | None = None
    try:
        result = _write(result, request)
        keeper.end(result)
    except (DrystoneError, OSError) as error:
        failed = error
    more: dict[str, Any] = {}
    if request.options.pareto:
        more["pareto"] = choice.choice_summary(result, folder)
    if request.options.profile:
        more["profile"] = profile_summary(result, request.options.jobs)
    if request.options.json:
        print_json(summary(result, folder) | more)
    else:
        print_table(ending(result), rows(result, folder))
        if "pareto" in more:
            choice.print_choice(more["pareto"])
        if "profile" in more:
            title = "\nwhere the time went, and microseconds a candidate"
            print_table(title, profile_rows(more["profile"]))
    if failed is not None:
        raise failed
    if not request.quiet:
        written = (name for name in keeping.WRITTEN if (folder / name).exists())
        note(f"wrote to {folder}: {' '.join(written)}")
    return _EXIT[result.status]


def _write(result: PlanResult, request: PlanRequest) -> PlanResult:
    """Write the plan and its pictures; return it as it was written, with its photo."""
    folder = request.folder
    photo, record = place_photo(request.photo, folder)
    found = photo_beside(folder)
    if found != photo:
        note(
            f"{found} was not put there by a plan and stays; `drystone export` would "
            "take it for the photograph of these stones"
        )
    result = replace(result, plan=replace(result.plan, source={**result.plan.source, **record}))
    write_plan_folder(result, folder)
    # Drawing loads matplotlib, which takes as long as a small plan.
    from drystone.drawing import view_of_result, write_pictures, write_report  # noqa: PLC0415

    write_pictures(folder, result.wall, result.clusters, resistance=result.resistance)
    notices = (*request.stones.notices, *result.notices)
    view = view_of_result(result, photo=photo, notices=notices)
    write_report(folder / "report.html", view, pictures=folder)
    write_film(result, folder)
    if request.options.pareto:
        choice.write_choice(result, folder)
    else:
        choice.clear_choice(folder)
    names = (name for one in FORMATS.values() for name in one.writes if name not in keeping.WRITTEN)
    earlier = [name for name in names if (folder / name).exists()]
    if earlier:
        what = f"of an earlier plan: {', '.join(earlier)}, in {folder}."
        note(Notice("W181", what, "Make them again: drystone export --overwrite."))
    return result


def write_film(result: PlanResult, folder: Path) -> None:
    """Write build.gif, unless there are no steps, or many; one of an earlier run is removed."""
    if not 0 < len(result.plan.stone_steps) <= FILM_STONES:
        (folder / "build.gif").unlink(missing_ok=True)
        return
    # What draws is loaded when it draws.
    from drystone.drawing.assembly import read_assembly  # noqa: PLC0415

    FORMATS["gif"].write(read_assembly(folder), folder, ExportSettings())
