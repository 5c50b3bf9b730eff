"""What is to be planned and where it goes, made once of stones and options."""

import argparse
from dataclasses import dataclass
from pathlib import Path

from drystone.cli.settings import recorded_method, search_seconds, settings_from
from drystone.model.stone import StoneSet
from drystone.planner.settings import PlannerSettings, method_settings
from drystone.search.plan_wall import working_scale


@dataclass(frozen=True, eq=False)
class PlanRequest:
    """A wall that is asked for.

    Parameters
    ----------
    stones : StoneSet
        To build with.
    wall : (float, float)
        Width and height, source px.
    px_per_m : float or None
        Scale of the source.
    scale : float
        Working resolution over that of the source.
    seed : int
        Of the random choices.
    asked_method, method : str
        The one asked for, and the one that the plan names.
    settings_file : str or None
        What replaced settings of the method.
    settings : PlannerSettings
        All of them.
    seconds : float or None
        How long is searched; None when a number of walls ends it.
    first_whole : bool
        Whether the first wall is built to its end whatever the clock says.
    jobs : int
        Processes.
    resume : bool
        Whether what is in the folder is gone on with.
    begin : Path or None
        The plan that the search begins with.
    """

    stones: StoneSet
    wall: tuple[float, float]
    px_per_m: float | None
    scale: float
    seed: int
    asked_method: str
    method: str
    settings_file: str | None
    settings: PlannerSettings
    seconds: float | None
    first_whole: bool
    jobs: int
    resume: bool
    begin: Path | None


@dataclass(frozen=True)
class PlanOutput:
    """Where a plan goes, and what is said of it.

    Parameters
    ----------
    folder : Path
        Of the plan.
    photo : Path or None
        Of the stones, to be put beside it.
    overwrite, pareto : bool
        Whether the folder may have files, and whether walls to choose from are written.
    json, quiet, profile : bool
        Whether the summary is JSON, there is no progress, and times are told.
    """

    folder: Path
    photo: Path | None
    overwrite: bool
    pareto: bool
    json: bool
    quiet: bool
    profile: bool


def request_from(
    stones: StoneSet,
    wall: tuple[float, float],
    px_per_m: float | None,
    arguments: argparse.Namespace,
) -> PlanRequest:
    """Return what the options of `plan` or `demo`, which has fewer, ask for."""
    begin = getattr(arguments, "begin", None)
    return PlanRequest(
        stones=stones,
        wall=wall,
        px_per_m=px_per_m,
        settings=settings_from(arguments),
        scale=arguments.scale or working_scale(stones),
        seed=arguments.seed,
        asked_method=arguments.method,
        method=recorded_method(arguments),
        settings_file=arguments.settings,
        seconds=search_seconds(method_settings(arguments.method), len(stones), arguments),
        first_whole=arguments.time is None,
        jobs=arguments.jobs,
        resume=getattr(arguments, "resume", False),
        begin=None if begin is None else Path(begin),
    )


def output_from(arguments: argparse.Namespace, photo: Path | None = None) -> PlanOutput:
    """Return where the options put a plan."""
    return PlanOutput(
        folder=Path(arguments.output),
        photo=photo,
        overwrite=arguments.overwrite,
        pareto=arguments.pareto,
        json=arguments.json,
        quiet=arguments.quiet or arguments.json,
        profile=arguments.profile,
    )
