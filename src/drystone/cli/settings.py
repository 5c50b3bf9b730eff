"""Planner settings from a method, a TOML file and options, in this order."""

import argparse
import tomllib
from collections.abc import Iterator
from dataclasses import fields, is_dataclass
from pathlib import Path
from typing import Any

from drystone.cli.numbers import positive, share, whole_from
from drystone.errors import InputError, UsageError
from drystone.io.file_bytes import file_bytes
from drystone.io.foreign import foreign
from drystone.planner.search_settings import AIMS, UNLIMITED
from drystone.planner.settings import METHODS, PlannerSettings, method_settings
from drystone.selection.policies.registry import rule_of

MOST_TOML_BYTES = 1_000_000
"""Larger settings are refused; all that there are have 3 kB."""

SECONDS_A_STONE = 1 / 3
"""How long better walls are looked for when nothing is said."""


_PLAIN = ("sampling", "two_sided", "orientations", "mu", "skip_too_large")
"""Settings that have an option of their own name."""

_Asked = tuple[str, dict[str, Any]]
"""Options, as an error names them, and what they change."""


def add_settings(command: argparse.ArgumentParser) -> None:
    """Add the options that say how a wall is planned."""
    group = command.add_argument_group("method")
    group.add_argument("--method", default="best", metavar="NAME", help="best (default) or paper")
    group.add_argument(
        "--settings", metavar="FILE.toml", help="parameters that replace the method's"
    )
    group.add_argument(
        "--seed", type=whole_from(0), default=0, help="of the random choices (default 0)"
    )
    group.add_argument(
        "--scale", type=share, metavar="S", help="plan on images reduced by S, 0 to 1"
    )
    group.add_argument(
        "--policy", metavar="NAME",
        help="who chooses the stones of a single pass: paper, random, lowest, scalarised, filter, "
        "towers, learned, or one that is installed (docs/policies.md)",
    )  # fmt: skip
    group.add_argument(
        "--sampling", choices=["variant", "uniform", "twofold", "full"],
        help="stones that are tried in a step: one of each cluster, as many at random, one of "
        "each and then all of the winner's cluster, or all",
    )  # fmt: skip
    group.add_argument("--placement", choices=["snug", "eq12", "lowest"])
    group.add_argument("--reach", choices=["any", "above"], help="where a stone may be inserted")
    group.add_argument(
        "--two-sided", action=argparse.BooleanOptionalAction, default=None, dest="two_sided",
        help="build from both ends",
    )  # fmt: skip
    group.add_argument(
        "--one-sided", action="store_false", dest="two_sided", help="same as --no-two-sided"
    )
    group.add_argument("--orientations", metavar="SET", help="sf, quarter, or a step such as 10deg")
    group.add_argument("--stabilise", choices=["both", "rotation", "wedge", "none"])
    group.add_argument("--mu", type=float, help="coefficient of friction (default .58)")
    group.add_argument(
        "--geometry", choices=["exact", "raster"],
        help="exact: stones settle on their outlines; raster: they are their pixels",
    )  # fmt: skip
    group.add_argument(
        "--settle", choices=["energy", "pivot"],
        help="with exact geometry: down to the least energy, or rolling as in the paper",
    )  # fmt: skip
    effort = group.add_mutually_exclusive_group()
    effort.add_argument(
        "--time", type=positive, metavar="SECONDS",
        help="time limit of the search (best: 10 s for 30 stones, and a whole wall)",
    )  # fmt: skip
    effort.add_argument(
        "--budget", type=whole_from(1), metavar="N",
        help="how many walls are built instead, which repeats exactly: 1 is a single pass",
    )  # fmt: skip
    group.add_argument(
        "--aim", nargs="+", action="extend", type=_aim, metavar="FIGURE=VALUE",
        help="figures to reach, such as F_SF=.88 F_AV=40 F_AH=1.5 F_LR=.8",
    )  # fmt: skip
    group.add_argument(
        "--skip-too-large", action="store_true", default=None,
        help="leave out stones that fit into the wall in no orientation",
    )  # fmt: skip
    group.add_argument(
        "--jobs",
        type=whole_from(1),
        default=1,
        metavar="N",
        help="processes; never the result of a budget",
    )


def _aim(text: str) -> tuple[str, float]:
    """Read what a figure of merit shall reach."""
    name, equals, value = text.partition("=")
    if name not in AIMS or not equals:
        message = f"{text!r} is not one of {', '.join(f'{known}=VALUE' for known in AIMS)}"
        raise argparse.ArgumentTypeError(message)
    return name, positive(value)


def settings_from(arguments: argparse.Namespace) -> PlannerSettings:
    """Return the settings that the command line asks for; errors name the file or the option."""
    settings = method_settings(arguments.method)
    if arguments.settings is not None:
        settings = _with_file(settings, arguments)
    geometry = arguments.geometry or settings.geometry
    _check_geometry(geometry, arguments)
    asked = settings
    for where, changes in [*_plain(arguments), *_grouped(settings, arguments)]:
        try:
            asked = asked.updated(changes)
        except UsageError as error:
            raise _blamed(error, where) from None
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
    apart = {name: _differences(made[0], method) for name, method in METHODS.items()}
    nearest = apart[arguments.method] == min(apart.values())
    return str(arguments.method) if nearest or not whole else "custom"


def _differences(one: object, other: object) -> int:
    """Count the values in which settings differ."""
    if not is_dataclass(one):
        return int(one != other)
    return sum(_differences(getattr(one, f.name), getattr(other, f.name)) for f in fields(one))


def _with_file(settings: PlannerSettings, arguments: argparse.Namespace) -> PlannerSettings:
    """Return settings with the values of the file in their place."""
    path = Path(arguments.settings)
    changes = read_toml(path)
    try:
        settings = settings.updated(changes)
        if settings.by_policy and arguments.policy is None:
            rule_of(settings.selection_rule)  # the file may name one that is not there
    except UsageError as error:
        table = error.where.removeprefix("settings").strip() if error.code == "E123" else ""
        raise _blamed(error, f"{path} [{table}]" if table else str(path)) from None
    return settings


def _blamed(error: UsageError, where: str) -> UsageError:
    """Return an error of settings that says where the values came from."""
    return UsageError(error.code, error.what, where=where, cure=error.cure)


def _plain(arguments: argparse.Namespace) -> list[_Asked]:
    """Return what options ask for that set one value each."""
    given = {name: getattr(arguments, name) for name in _PLAIN}
    placed: dict[str, Any] = {"geometry": arguments.geometry}
    if arguments.geometry == "raster":
        placed["search"] = {"budget": 1}  # better walls are looked for on outlines alone
    geometry = [] if arguments.geometry is None else [("--geometry", placed)]
    return geometry + [
        (f"--{name.replace('_', '-')}", {name: value})
        for name, value in given.items()
        if value is not None
    ]


def _grouped(settings: PlannerSettings, arguments: argparse.Namespace) -> Iterator[_Asked]:
    """Yield what the other options ask for; what only makes sense together is one change."""
    placement = {"rule": arguments.placement, "reach": arguments.reach}
    yield "--placement, --reach", {"placement": {k: v for k, v in placement.items() if v}}
    search = _search(settings, arguments)
    if arguments.policy is not None:
        yield "--policy", {"selection_rule": rule_of(arguments.policy), "search": search}
    else:
        yield "--time" if arguments.budget is None else "--budget", {"search": search}
    if arguments.aim:
        if search.get("budget", settings.search.budget) == 1:
            raise UsageError(
                "E138",
                "--aim would do nothing with a single pass.",
                cure="Leave it out, or let walls be searched: --time, --budget.",
            )
        yield "--aim", {"goal": dict(arguments.aim)}
    if arguments.settle is not None:
        yield "--settle", {"settle": {"method": arguments.settle}}
    if arguments.stabilise is not None:
        yield "--stabilise", {"stabilise": {"method": arguments.stabilise}}
    yield from _chosen(arguments)


def _chosen(arguments: argparse.Namespace) -> Iterator[_Asked]:
    """Yield what is said about single stones; `demo` has no such options."""
    ids = {name: sorted(set(getattr(arguments, name, []))) for name in ("ban", "pin")}
    given = {name: stones for name, stones in ids.items() if stones}
    yield " and ".join(f"--{name}" for name in given), given
    if getattr(arguments, "fixed_order", False):
        yield "--fixed-order", {"order": "given"}


def _search(settings: PlannerSettings, arguments: argparse.Namespace) -> dict[str, Any]:
    """Return the changes of the search's settings."""
    search: dict[str, Any] = {}
    if arguments.policy is not None:
        if arguments.time is not None or arguments.budget not in (None, 1):
            raise UsageError(
                "E138",
                "--policy chooses the stones of a single pass, which is not searched.",
                cure="Leave out --time and --budget, or --policy.",
            )
        return {"budget": 1}
    if arguments.budget is not None:
        search["budget"] = arguments.budget
    elif (arguments.geometry or settings.geometry) == "raster":
        return search
    elif search_seconds(settings, 0, arguments) is not None:
        search["budget"] = UNLIMITED
    return search


def search_seconds(
    settings: PlannerSettings, stones: int, arguments: argparse.Namespace
) -> float | None:
    """Return how long better walls are looked for; None when a budget or a policy says how many.

    Parameters
    ----------
    settings : PlannerSettings
        Before the options.
    stones : int
        How many there are.
    arguments : argparse.Namespace
        The options.
    """
    if arguments.policy is not None:
        return None
    if arguments.time is not None:
        return float(arguments.time)
    timed = arguments.budget is None and not _file_has_budget(arguments)
    return stones * SECONDS_A_STONE if timed and settings.search.budget > 1 else None


def _file_has_budget(arguments: argparse.Namespace) -> bool:
    """Say whether the settings file says how many walls are built."""
    if arguments.settings is None:
        return False
    search = read_toml(Path(arguments.settings)).get("search", {})
    return isinstance(search, dict) and "budget" in search


def _check_geometry(geometry: str, arguments: argparse.Namespace) -> None:
    """Refuse options that would do nothing on the geometry of a plan (E138)."""
    exact = geometry == "exact"
    useless = ("placement", "reach") if exact else ("settle",)
    given = [f"--{name}" for name in useless if getattr(arguments, name) is not None]
    if given:
        raise UsageError(
            "E138",
            f"{' and '.join(given)} would do nothing with --geometry {geometry}.",
            cure=f"Leave it out, or add --geometry {'raster' if exact else 'exact'}.",
        )


def read_toml(path: Path) -> dict[str, Any]:
    """Read a TOML file; a missing or broken one is an InputError (E128)."""

    def no_toml(why: str) -> InputError:
        return InputError(
            "E128",
            f"is no TOML: {why}.",
            where=str(path),
            cure="`drystone plan` writes the settings of a plan as settings.toml: start from that.",
        )

    try:
        data = file_bytes(path, MOST_TOML_BYTES)
    except OSError as error:
        raise InputError(
            "E128",
            f"cannot be read: {error.strerror}.",
            where=str(path),
            cure="Give a TOML file, such as the settings.toml that is written with every plan.",
        ) from None
    with foreign(no_toml):
        return tomllib.loads(data.decode("utf-8-sig"))
