"""What `plan` and `demo` share: plan, write everything, print the summary."""

import argparse
import math
import sys
from contextlib import nullcontext
from pathlib import Path

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
from drystone.cli.output import print_json, working_in
from drystone.cli.plan_photo import check_photo, with_photo
from drystone.cli.plan_summary import print_summary, summary
from drystone.cli.progress import step_bar
from drystone.cli.resuming import Earlier, course_heights, earlier_run, made_of, tell_finished
from drystone.cli.scale import picture_size_px, refuse_outside, scale_notice
from drystone.cli.settings import recorded_method, search_seconds, settings_from
from drystone.cli.timing import print_profile, profile_summary
from drystone.errors import DrystoneError, ExitCode, UsageError
from drystone.io.checkpoint import CHECKPOINT
from drystone.io.plan_folder import write_plan_folder
from drystone.model.plan import Plan
from drystone.model.site import Site
from drystone.model.stone import StoneSet
from drystone.model.stone_size import median_sides, sides_px
from drystone.planner.settings import PlannerSettings, method_settings
from drystone.planner.workshop import fitting_stones
from drystone.search.interrupts import held
from drystone.search.plan_result import PlanResult
from drystone.search.plan_wall import plan_wall, working_scale
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


def plan_and_write(
    stones: StoneSet,
    wall: tuple[float, float],
    arguments: argparse.Namespace,
    photo: Path | None = None,
    *,
    prepared: bool = False,
) -> ExitCode:
    """Plan a wall of given size in source px, write all files, print the summary.

    Parameters
    ----------
    stones : StoneSet
        To build with.
    wall : (float, float)
        Width and height, source px.
    arguments : argparse.Namespace
        Of the command.
    photo : Path or None
        Of the stones.
    prepared : bool
        Whether the folder is ready and locked.
    """
    folder = Path(arguments.output)
    settings = settings_from(arguments)
    earlier = earlier_run(folder, stones, wall, arguments, settings)
    if earlier.plan is not None and earlier.finished:
        return _EXIT[tell_finished(earlier.plan, stones, settings, arguments)]
    earlier.tell()
    begin = plan_to_begin_with(stones, wall, arguments, settings)
    _check_stones(stones, wall, arguments, settings)
    check_photo(photo, stones, folder)
    if arguments.pareto:
        prepare_choice(folder)
    overwrite = arguments.overwrite or earlier.begun
    names = (*WRITTEN, CHECKPOINT)
    ready = working_in(folder, names, overwrite=overwrite, within=PLACES)
    with nullcontext() if prepared else ready:
        keeper = Keeper(folder, made_of(stones, wall, arguments, settings), photo)
        keeper.begin(earlier.standing)
        result = _planned(stones, wall, arguments, settings, earlier, begin, keeper)
        # What it has come to is not lost by a second interrupt.
        with held():
            return _written_and_told(result, stones, arguments, photo, keeper)


def _planned(
    stones: StoneSet,
    wall: tuple[float, float],
    arguments: argparse.Namespace,
    settings: PlannerSettings,
    earlier: Earlier,
    begin: Plan | None,
    keeper: Keeper,
) -> PlanResult:
    """Plan a wall, and say how long that takes."""
    seconds = search_seconds(method_settings(arguments.method), len(stones), arguments)
    _announce(stones, wall, arguments, seconds if settings.search.budget > 1 else None)
    with step_bar(
        len(stones), settings, seconds, quiet=arguments.quiet or arguments.json
    ) as callbacks:
        return plan_wall(
            stones,
            *wall,
            seed=arguments.seed,
            method=recorded_method(arguments),
            settings=settings,
            scale=arguments.scale,
            px_per_m=arguments.px_per_m,
            seconds=math.inf if seconds is None else seconds,
            first_whole=arguments.time is None,
            n_jobs=arguments.jobs,
            callbacks=callbacks,
            built=None if earlier.plan is None else rebuild_wall(earlier.plan, stones),
            course_heights_px=course_heights(earlier.plan or begin),
            begin=None if begin is None else rebuild_wall(begin, stones),
            choice=arguments.pareto,
            keep=keeper,
            standing=earlier.standing,
        )


def _written_and_told(
    result: PlanResult,
    stones: StoneSet,
    arguments: argparse.Namespace,
    photo: Path | None,
    keeper: Keeper,
) -> ExitCode:
    """Write all files and print the summary; also that of a wall that cannot be written."""
    folder = Path(arguments.output)
    for notice in result.notices:
        print(f"drystone: {notice}", file=sys.stderr)
    failed: Exception | None = None
    try:
        result = _write(result, stones, folder, photo, choice=arguments.pareto)
        keeper.end(result)
    except (DrystoneError, OSError) as error:
        failed = error
    profile = profile_summary(result, arguments.jobs) if arguments.profile else None
    if arguments.json:
        told = summary(result, folder)
        if arguments.pareto:
            told["pareto"] = choice_summary(result, folder)
        print_json(told | ({} if profile is None else {"profile": profile}))
    else:
        print_summary(result, folder)
        if arguments.pareto:
            print_choice(result)
        if profile is not None:
            print_profile(profile)
    if failed is not None:
        raise failed
    if not (arguments.quiet or arguments.json):
        say_written(folder)
    return _EXIT[result.status]


def _write(
    result: PlanResult, stones: StoneSet, folder: Path, photo: Path | None, *, choice: bool
) -> PlanResult:
    """Write the plan and its pictures; return it as it was written, with its photo."""
    result, beside = with_photo(result, photo, folder)
    write_result(result, stones, folder, beside)
    write_film(result, folder)
    if choice:
        write_choice(result, folder)
    else:
        clear_choice(folder)
    if (earlier := exports_notice(folder)) is not None:
        print(f"drystone: {earlier}", file=sys.stderr)
    return result


def _check_stones(
    stones: StoneSet,
    wall: tuple[float, float],
    arguments: argparse.Namespace,
    settings: PlannerSettings,
) -> None:
    """Refuse what cannot be meant, before a folder is made: E126, and E138 of a ruler."""
    refuse_outside(arguments.px_per_m, picture_size_px(stones.source))
    scale = arguments.scale or working_scale(stones)
    site = Site.from_source(*wall, scale, arguments.px_per_m)
    if not fitting_stones(stones, site, settings):
        raise UsageError(
            "E126",
            f"none of the {len(stones)} stones can be built with: each is banned, or fits into "
            "the wall in no orientation.",
            where=stones.source.path,
            cure="Build a larger wall, or ban fewer stones.",
        )


def _announce(
    stones: StoneSet,
    wall: tuple[float, float],
    arguments: argparse.Namespace,
    seconds: float | None,
) -> None:
    """Say what is planned with, and when its scale or its method is odd."""
    if not (arguments.quiet or arguments.json):
        said = read_line(stones, wall, arguments.px_per_m, seconds)
        more = "" if seconds is None else " (--time, --budget)"
        print(f"drystone: {said}{more}", file=sys.stderr)
    if recorded_method(arguments) != arguments.method:
        print(
            f"drystone: {arguments.settings} has every setting, so that nothing of --method "
            f"{arguments.method} is left; the plan names the method custom",
            file=sys.stderr,
        )
    median_px, _ = median_sides(sides_px(stone.mask) for stone in stones)
    notice = scale_notice(median_px, arguments.px_per_m)
    if notice is not None:
        print(f"drystone: {notice}", file=sys.stderr)


def write_result(
    result: PlanResult, stones: StoneSet, folder: Path, photo: Path | None = None
) -> None:
    """Write plan.json, settings.toml, wall.png, the pictures and the report."""
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
