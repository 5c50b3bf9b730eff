"""What `plan` and `demo` share: plan, write everything, print the summary."""

import argparse
import math
import sys
from contextlib import nullcontext
from dataclasses import replace

from drystone.cli.announce import (
    WRITTEN,
    exports_notice,
    read_line,
    say_written,
    write_film,
)
from drystone.cli.beginning import plan_to_begin_with
from drystone.cli.choice import (
    PLACES,
    choice_summary,
    clear_choice,
    prepare_choice,
    print_choice,
    write_choice,
)
from drystone.cli.keeping import Keeper
from drystone.cli.output import print_json, print_table, working_in
from drystone.cli.progress import step_bar
from drystone.cli.request import PlanOutput, PlanRequest
from drystone.cli.resuming import earlier_run, made_of, tell_finished
from drystone.cli.scale import picture_size_px, refuse_outside, scale_notice
from drystone.drawing.words.planned import ending, profile_rows, profile_summary, rows, summary
from drystone.errors import DrystoneError, ExitCode, UsageError
from drystone.io.checkpoint import CHECKPOINT
from drystone.io.photo_beside import check_place, photo_beside, place_photo
from drystone.io.photo_file import read_photo_picture
from drystone.io.plan_folder import write_plan_folder
from drystone.model.site import Site
from drystone.model.stone import StoneSet
from drystone.model.stone_size import median_sides, sides_px
from drystone.planner.workshop import fitting_stones
from drystone.search.interrupts import held
from drystone.search.plan_result import PlanResult
from drystone.search.plan_wall import plan_wall
from drystone.verify.replay import rebuild_wall

_EXIT = {
    "complete": ExitCode.DONE,
    "incomplete": ExitCode.INCOMPLETE,
    "interrupted": ExitCode.INTERRUPTED,
}


def add_writing(command: argparse.ArgumentParser) -> None:
    """Add the options of what is written and printed."""
    group = command.add_argument_group("output")
    group.add_argument(
        "--overwrite", action="store_true", help="write into a folder that has files"
    )
    group.add_argument(
        "--pareto", action="store_true",
        help="write the walls too that no wall of the search beats in every figure: pareto/01, ...",
    )  # fmt: skip
    group.add_argument("--json", action="store_true", help="print the summary as JSON")
    group.add_argument("--quiet", action="store_true", help="no progress")
    group.add_argument("--profile", action="store_true", help="say where the time went")


def plan_and_write(request: PlanRequest, output: PlanOutput, *, prepared: bool = False) -> ExitCode:
    """Plan a wall, write all files, print the summary.

    Parameters
    ----------
    request, output : PlanRequest, PlanOutput
        What is planned, and where it goes.
    prepared : bool
        Whether the folder is ready and locked.
    """
    stones, folder, photo = request.stones, output.folder, output.photo
    earlier = earlier_run(request, folder)
    if earlier.plan is not None and earlier.finished:
        return _EXIT[tell_finished(earlier.plan, request, output)]
    earlier.tell()
    begin = plan_to_begin_with(request)
    begun = earlier.plan or begin
    _check_stones(request)
    # What would stop the report after the search is refused before it: E129, E189.
    check_place(photo, folder)
    if photo is not None:
        read_photo_picture(photo, (stones.source.width_px, stones.source.height_px))
    if output.pareto:
        prepare_choice(folder)
    overwrite = output.overwrite or earlier.begun
    names = (*WRITTEN, CHECKPOINT)
    ready = working_in(folder, names, overwrite=overwrite, within=PLACES)
    with nullcontext() if prepared else ready:
        keeper = Keeper(folder, made_of(request), photo)
        keeper.begin(earlier.standing)
        _announce(request, output)
        bar = step_bar(len(stones), request.settings, request.seconds, quiet=output.quiet)
        with bar as callbacks:
            result = plan_wall(
                stones,
                *request.wall,
                seed=request.seed,
                method=request.method,
                settings=request.settings,
                scale=request.scale,
                px_per_m=request.px_per_m,
                seconds=math.inf if request.seconds is None else request.seconds,
                first_whole=request.first_whole,
                n_jobs=request.jobs,
                callbacks=callbacks,
                built=None if earlier.plan is None else rebuild_wall(earlier.plan, stones),
                course_heights_px=None if begun is None else begun.course_heights_px,
                begin=None if begin is None else rebuild_wall(begin, stones),
                choice=output.pareto,
                keep=keeper,
                standing=earlier.standing,
            )
        # What it has come to is not lost by a second interrupt.
        with held():
            return _written_and_told(result, request, output, keeper)


def _written_and_told(
    result: PlanResult, request: PlanRequest, output: PlanOutput, keeper: Keeper
) -> ExitCode:
    """Write all files and print the summary; also that of a wall that cannot be written."""
    folder = output.folder
    for notice in result.notices:
        print(f"drystone: {notice}", file=sys.stderr)
    failed: Exception | None = None
    try:
        result = _write(result, request.stones, output)
        keeper.end(result)
    except (DrystoneError, OSError) as error:
        failed = error
    profile = profile_summary(result, request.jobs) if output.profile else None
    if output.json:
        told = summary(result, folder)
        if output.pareto:
            told["pareto"] = choice_summary(result, folder)
        print_json(told | ({} if profile is None else {"profile": profile}))
    else:
        print_table(ending(result), rows(result, folder))
        if output.pareto:
            print_choice(result)
        if profile is not None:
            title = "\nwhere the time went, and microseconds a candidate"
            print_table(title, profile_rows(profile))
    if failed is not None:
        raise failed
    if not output.quiet:
        say_written(folder)
    return _EXIT[result.status]


def _write(result: PlanResult, stones: StoneSet, output: PlanOutput) -> PlanResult:
    """Write the plan and its pictures; return it as it was written, with its photo."""
    folder = output.folder
    photo, record = place_photo(output.photo, folder)
    found = photo_beside(folder)
    if found != photo:
        print(
            f"drystone: {found} was not put there by a plan and stays; `drystone export` would "
            "take it for the photograph of these stones",
            file=sys.stderr,
        )
    result = replace(result, plan=replace(result.plan, source={**result.plan.source, **record}))
    write_plan_folder(result, folder)
    # Drawing loads matplotlib, which takes as long as a small plan.
    from drystone.drawing import (  # noqa: PLC0415
        view_of_result,
        write_pictures,
        write_report,
    )

    write_pictures(folder, result.wall, result.clusters, resistance=result.resistance)
    view = view_of_result(result, photo=photo, notices=(*stones.notices, *result.notices))
    write_report(folder / "report.html", view, pictures=folder)
    write_film(result, folder)
    if output.pareto:
        write_choice(result, folder)
    else:
        clear_choice(folder)
    if (earlier := exports_notice(folder)) is not None:
        print(f"drystone: {earlier}", file=sys.stderr)
    return result


def _check_stones(request: PlanRequest) -> None:
    """Refuse what cannot be meant, before a folder is made: E126, and E138 of a ruler."""
    stones = request.stones
    refuse_outside(request.px_per_m, picture_size_px(stones.source))
    site = Site.from_source(*request.wall, request.scale, request.px_per_m)
    if not fitting_stones(stones, site, request.settings):
        raise UsageError(
            "E126",
            f"none of the {len(stones)} stones can be built with: each is banned, or fits into "
            "the wall in no orientation.",
            where=stones.source.path,
            cure="Build a larger wall, or ban fewer stones.",
        )


def _announce(request: PlanRequest, output: PlanOutput) -> None:
    """Say what is planned with, and when its scale or its method is odd."""
    stones, px_per_m = request.stones, request.px_per_m
    if not output.quiet:
        seconds = request.seconds if request.settings.search.budget > 1 else None
        more = "" if seconds is None else " (--time, --budget)"
        print(
            f"drystone: {read_line(stones, request.wall, px_per_m, seconds)}{more}",
            file=sys.stderr,
        )
    if request.method != request.asked_method:
        print(
            f"drystone: {request.settings_file} has every setting, so that nothing of --method "
            f"{request.asked_method} is left; the plan names the method custom",
            file=sys.stderr,
        )
    median_px, _ = median_sides(sides_px(stone.mask) for stone in stones)
    notice = scale_notice(median_px, px_per_m)
    if notice is not None:
        print(f"drystone: {notice}", file=sys.stderr)
