"""Planner settings from a method, a TOML file and options, in this order."""

import argparse
import tomllib
from pathlib import Path
from typing import Any

from drystone.errors import InputError, UsageError
from drystone.planner.settings import PlannerSettings, method_settings
from drystone.selection.policies.registry import rule_of

UNLIMITED = 1_000_000
"""Budget of a search that the clock ends."""

SECONDS_A_STONE = 1 / 3
"""How long better walls are looked for when nothing is said."""


def settings_from(arguments: argparse.Namespace) -> PlannerSettings:
    """Return the settings that the command line asks for."""
    settings = method_settings(arguments.method)
    if arguments.settings is not None:
        settings = settings.updated(read_toml(Path(arguments.settings)))
    changes: dict[str, Any] = {}
    for name in ("geometry", "sampling", "two_sided", "orientations", "mu", "skip_too_large"):
        value = getattr(arguments, name)
        if value is not None:
            changes[name] = value
    placement = {"rule": arguments.placement, "reach": arguments.reach}
    changes["placement"] = {k: v for k, v in placement.items() if v is not None}
    _check_geometry(
        settings.updated({k: v for k, v in changes.items() if k == "geometry"}), arguments
    )
    if arguments.policy is not None:
        changes["selection_rule"] = rule_of(arguments.policy)
    if arguments.settle is not None:
        changes["settle"] = {"method": arguments.settle}
    changes |= _chosen(arguments)
    changes["search"] = _search(settings, arguments)
    if arguments.aim:
        if changes["search"].get("budget", settings.search.budget) == 1:
            raise UsageError(
                "E138",
                "--aim would do nothing with a single pass.",
                cure="Leave it out, or let walls be searched: --time, --budget.",
            )
        changes["goal"] = dict(arguments.aim)
    if arguments.stabilise is not None:
        changes["stabilise"] = {"method": arguments.stabilise}
    asked = settings.updated(changes)
    if asked.by_policy:
        rule_of(asked.selection_rule)  # a settings file may name one that is not there
    return asked


def _chosen(arguments: argparse.Namespace) -> dict[str, Any]:
    """Return what is said about single stones; `demo` has no such options."""
    changes: dict[str, Any] = {}
    for name in ("ban", "pin"):
        ids = getattr(arguments, name, [])
        if ids:
            changes[name] = sorted(set(ids))
    if getattr(arguments, "fixed_order", False):
        changes["order"] = "given"
    return changes


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


def _check_geometry(settings: PlannerSettings, arguments: argparse.Namespace) -> None:
    """Refuse options that would do nothing on the geometry of a plan (E138)."""
    exact = settings.geometry == "exact"
    useless = ("placement", "reach") if exact else ("settle",)
    given = [f"--{name}" for name in useless if getattr(arguments, name) is not None]
    if given:
        raise UsageError(
            "E138",
            f"{' and '.join(given)} would do nothing with --geometry {settings.geometry}.",
            cure=f"Leave it out, or add --geometry {'raster' if exact else 'exact'}.",
        )


def read_toml(path: Path) -> dict[str, Any]:
    """Read a TOML file; a missing or broken one is an InputError (E128)."""
    try:
        return tomllib.loads(path.read_text(encoding="utf-8"))
    except OSError as error:
        raise InputError("E128", f"cannot be read: {error.strerror}.", where=str(path)) from None
    except (tomllib.TOMLDecodeError, UnicodeDecodeError) as error:
        raise InputError(
            "E128",
            f"is no TOML: {error}.",
            where=str(path),
            cure="`drystone plan` writes the settings of a plan as settings.toml: start from that.",
        ) from None
