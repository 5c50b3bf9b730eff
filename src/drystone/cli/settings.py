"""What is to be planned and where it goes, of stones, a method, a TOML file and options."""

import argparse
import tomllib
from collections.abc import Iterable, Iterator, Mapping
from contextlib import suppress
from dataclasses import asdict, dataclass
from itertools import chain
from pathlib import Path
from typing import Any

from drystone.cli.numbers import positive, share, whole_from
from drystone.errors import InputError, UsageError
from drystone.io.files import file_bytes, foreign
from drystone.model.settings import flat, nested
from drystone.model.stone import StoneSet
from drystone.planner.search_settings import AIMS, UNLIMITED
from drystone.planner.settings import METHODS, PlannerSettings, method_settings
from drystone.search.plan_wall import usual_budget, working_scale
from drystone.selection.policies.registry import rule_of

MOST_TOML_BYTES = 1_000_000
"""Larger settings are refused; all that there are have 3 kB."""

GUARD_S_A_STONE, GUARD_S = 10.0, 600.0
"""The clock ends such a search only after so long, and so long at least: machines are busy."""

SHOWN = (
    "--wall", "-o", "--overwrite", "--resume", "--from", "--px-per-m", "--ruler", "--method",
    "--settings", "--set", "--seed", "--mu", "--time", "--budget", "--aim", "--jobs", "--ban",
    "--pin", "--json",
)  # fmt: skip
"""What the help of `plan` lists; the other options are settings, for scripts and for studies."""


def add_settings(command: argparse.ArgumentParser) -> None:
    """Add the options that say how a wall is planned."""
    # fmt: off
    option = command.add_argument_group("method").add_argument
    option("--method", default="best", metavar="NAME", help="best (default) or paper")
    option("--settings", metavar="FILE.toml", help="settings that replace those of the method")
    option("--set", type=_setting, action="append", default=[], metavar="NAME=VALUE",
           dest="changes", help="one of them, such as settle.method=pivot; repeatable. "
           "`drystone settings` lists all")
    option("--seed", type=whole_from(0), default=0, metavar="N",
           help="of the random choices (default 0)")
    option("--scale", type=share, metavar="S", help="reduce the images by S first, 0 to 1")
    option("--policy", metavar="NAME")
    option("--sampling", choices=["variant", "shrinking", "uniform", "twofold", "full"])
    option("--placement", choices=["snug", "eq12", "lowest"])
    option("--reach", choices=["any", "above"])
    option("--two-sided", action=argparse.BooleanOptionalAction, default=None, dest="two_sided")
    option("--one-sided", action="store_false", dest="two_sided")
    option("--orientations", metavar="SET")
    option("--stabilise", choices=["both", "rotation", "wedge", "none"])
    option("--mu", type=float, help="coefficient of friction (default 0.58)")
    option("--geometry", choices=["exact", "raster"])
    option("--settle", choices=["energy", "pivot"])
    option("--budget", type=whole_from(1), metavar="N",
           help="number of walls to build; 1 is a single pass (best: 32 up to 40 stones)")
    option("--time", type=positive, metavar="SECONDS",
           help="stop the search after this time, however many walls were built")
    option("--aim", nargs="+", action="extend", type=_aim, metavar="FIGURE=VALUE",
           help="figures to reach, such as F_SF=0.88 F_AV=40 F_AH=1.5 F_LR=0.8")
    option("--skip-too-large", action="store_true", default=None)
    option("--jobs", type=whole_from(1), default=1, metavar="N",
           help="number of processes (a budget gives the same wall with any)")


def _setting(text: str) -> dict[str, Any]:
    """Read a dotted name and its value: as in TOML, or else a number or a text as it stands."""
    name, equals, value = text.partition("=")
    if not equals:
        raise argparse.ArgumentTypeError(f"{text!r} is not NAME=VALUE")
    read: Any = value.strip()
    with suppress(ValueError):
        read = float(value)
    with suppress(tomllib.TOMLDecodeError):
        read = tomllib.loads(f"value = {value}")["value"]
    return nested([(name.strip().split("."), read)])


def _together(changes: Iterable[Mapping[str, Any]]) -> dict[str, Any]:
    """Return nested changes as one; of two values the later one."""
    whole: dict[str, Any] = {}
    for name, value in chain.from_iterable(one.items() for one in changes):
        both = isinstance(value, dict) and isinstance(whole.get(name), dict)
        whole[name] = _together((whole[name], value)) if both else value
    return whole


def _aim(text: str) -> tuple[str, float]:
    name, equals, value = text.partition("=")
    if name not in AIMS or not equals:
        message = f"{text!r} is not one of {', '.join(f'{known}=VALUE' for known in AIMS)}"
        raise argparse.ArgumentTypeError(message)
    return name, positive(value)


def settings_from(arguments: argparse.Namespace) -> PlannerSettings:
    """Return the settings that the command line asks for; errors name the file or the option."""
    settings = method_settings(arguments.method)
    if arguments.settings is not None:
        path = Path(arguments.settings)
        changes = read_toml(path)
        try:
            settings = settings.updated(changes)
            if settings.by_policy and arguments.policy is None:
                rule_of(settings.selection_rule)  # the file may name one that is not there
        except UsageError as error:
            table = error.where.removeprefix("settings").strip() if error.code == "E123" else ""
            where = f"{path} [{table}]" if table else str(path)
            raise UsageError(error.code, error.what, where=where, cure=error.cure) from None
    try:
        settings = settings.updated(_together(arguments.changes))
    except UsageError as error:
        cure = f"{error.cure} `drystone settings` lists all."
        raise UsageError(error.code, error.what, where="--set", cure=cure) from None
    geometry = arguments.geometry or settings.geometry
    useless = ("placement", "reach") if geometry == "exact" else ("settle",)
    given = [f"--{name}" for name in useless if getattr(arguments, name) is not None]
    if given:
        what = f"{' and '.join(given)} would do nothing with --geometry {geometry}."
        cure = f"Leave it out, or add --geometry {'raster' if geometry == 'exact' else 'exact'}."
        raise UsageError("E138", what, cure=cure)
    asked = settings
    for where, changes in [*_changes(settings, arguments)]:
        try:
            asked = asked.updated(changes)
        except UsageError as error:
            raise UsageError(error.code, error.what, where=where, cure=error.cure) from None
    return asked


def recorded_method(arguments: argparse.Namespace) -> str:
    """Return the method that a plan names: the one asked for, or ``"custom"``.

    A settings file that has every setting, like the settings.toml of a plan, leaves nothing of
    the method that is asked for.  When it is nearer to another one, the plan is of neither.
    """
    if arguments.settings is None:
        return str(arguments.method)
    changes = read_toml(Path(arguments.settings))
    try:
        made = [method.updated(changes) for method in METHODS.values()]
    except UsageError:
        return str(arguments.method)  # it does not stand alone
    whole = all(one == made[0] for one in made)
    own = dict(flat(asdict(made[0])))
    apart = {
        name: sum(own[path] != value for path, value in flat(asdict(method)))
        for name, method in METHODS.items()
    }
    nearest = apart[arguments.method] == min(apart.values())
    return str(arguments.method) if nearest or not whole else "custom"


def _changes(
    settings: PlannerSettings, arguments: argparse.Namespace
) -> Iterator[tuple[str, dict[str, Any]]]:
    """Yield options, as an error names them, and what they change together."""

    def given(**options: str) -> dict[str, Any]:
        values = {name: getattr(arguments, option) for name, option in options.items()}
        return {name: value for name, value in values.items() if value not in (None, [])}

    if arguments.geometry == "raster":  # better walls are looked for on outlines alone
        yield "--geometry", {"geometry": "raster", "search": {"budget": 1}}
    else:
        yield "--geometry", given(geometry="geometry")
    for name in ("sampling", "two_sided", "orientations", "mu", "skip_too_large"):
        yield f"--{name.replace('_', '-')}", given(**{name: name})
    yield "--placement, --reach", {"placement": given(rule="placement", reach="reach")}
    search = _search(settings, arguments)
    if arguments.policy is not None:
        yield "--policy", {"selection_rule": rule_of(arguments.policy), "search": search}
    else:
        yield "--time" if arguments.budget is None else "--budget", {"search": search}
    if arguments.aim:
        if search.get("budget", settings.search.budget) == 1:
            what = "--aim would do nothing with a single pass."
            cure = "Leave it out, or let walls be searched: --time, --budget."
            raise UsageError("E138", what, cure=cure)
        yield "--aim", {"goal": dict(arguments.aim)}
    yield "--settle", {"settle": given(method="settle")}
    yield "--stabilise", {"stabilise": given(method="stabilise")}
    chosen = {name: sorted(set(ids)) for name, ids in given(ban="ban", pin="pin").items()}
    yield " and ".join(f"--{name}" for name in chosen), chosen
    if arguments.fixed_order:
        yield "--fixed-order", {"order": "given"}


def _search(settings: PlannerSettings, arguments: argparse.Namespace) -> dict[str, Any]:
    if arguments.policy is not None:
        if arguments.time is not None or arguments.budget not in (None, 1):
            what = "--policy chooses the stones of a single pass, which is not searched."
            raise UsageError("E138", what, cure="Leave out --time and --budget, or --policy.")
        return {"budget": 1}
    if arguments.budget is not None:
        return {"budget": arguments.budget}
    file = {} if arguments.settings is None else read_toml(Path(arguments.settings))
    search = _together((file, *arguments.changes)).get("search", {})
    has_budget = isinstance(search, dict) and "budget" in search
    searched = settings.search.budget > 1 and not has_budget
    exact = (arguments.geometry or settings.geometry) == "exact"
    return {"budget": UNLIMITED} if exact and (searched or arguments.time is not None) else {}


def limited(
    settings: PlannerSettings, stones: int, arguments: argparse.Namespace
) -> tuple[PlannerSettings, float | None]:
    """Return the settings with a budget for so many stones, and the time limit, if any.

    Where neither `--time` nor anything else says how much is done, that is the default budget: the
    same on every machine, with a time limit as a guard.
    """
    if arguments.time is not None:
        return settings, float(arguments.time)
    if settings.search.budget != UNLIMITED:
        return settings, None
    budget = {"budget": usual_budget(stones)}
    return settings.updated({"search": budget}), max(GUARD_S, stones * GUARD_S_A_STONE)


def read_toml(path: Path) -> dict[str, Any]:
    """Read a TOML file; a missing or broken one is an InputError (E128)."""

    def no_toml(why: str) -> InputError:
        cure = "`drystone plan` writes the settings of a plan as settings.toml: start from that."
        return InputError("E128", f"is not valid TOML: {why}.", where=str(path), cure=cure)

    try:
        data = file_bytes(path, MOST_TOML_BYTES)
    except OSError as error:
        what = f"cannot be read: {error.strerror}."
        cure = "Give a TOML file, such as the settings.toml that is written with every plan."
        raise InputError("E128", what, where=str(path), cure=cure) from None
    with foreign(no_toml):
        return tomllib.loads(data.decode("utf-8-sig"))


@dataclass(frozen=True, eq=False)
class PlanRequest:
    """A wall that is asked for, and where its plan goes."""

    stones: StoneSet
    wall: tuple[float, float]  # width and height, source px
    px_per_m: float | None  # of the source
    scale: float  # working resolution over that of the source
    method: str  # the one that the plan names
    settings: PlannerSettings
    seconds: float | None  # time limit of the search
    folder: Path
    photo: Path | None  # of the stones, to be put beside the plan
    quiet: bool
    options: argparse.Namespace  # all options as they were given


def request_from(
    stones: StoneSet,
    wall: tuple[float, float],
    px_per_m: float | None,
    arguments: argparse.Namespace,
    photo: Path | None = None,
) -> PlanRequest:
    """Return what the options of `plan` or `demo` ask for."""
    settings, seconds = limited(settings_from(arguments), len(stones), arguments)
    return PlanRequest(
        stones=stones,
        wall=wall,
        px_per_m=px_per_m,
        settings=settings,
        scale=arguments.scale or working_scale(stones),
        method=recorded_method(arguments),
        seconds=seconds,
        folder=Path(arguments.output),
        photo=photo,
        quiet=arguments.quiet or arguments.json,
        options=arguments,
    )
