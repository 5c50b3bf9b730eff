"""`drystone settings`: what plans go by, as the docstrings of the settings have it."""

import argparse
import dataclasses
import json
import re
import textwrap
from collections.abc import Iterator
from itertools import groupby
from typing import Any

from drystone.cli.output import print_json
from drystone.errors import ExitCode, UsageError, meant
from drystone.model.settings import range_text
from drystone.planner.settings import METHODS, PlannerSettings, method_settings
from drystone.selection.scored import Craft

PLANNER = "planner"
"""Name of the table of settings that stand at the top."""


def add(command: argparse.ArgumentParser) -> None:
    """Add its options."""
    # fmt: off
    option = command.add_argument
    option("names", metavar="NAME", nargs="*", help="settings or tables to list (default: all)")
    option("--method", default="best", metavar="NAME", help="whose values: best (default) or paper")
    option("--json", action="store_true", help="print as JSON")


def run(arguments: argparse.Namespace) -> ExitCode:
    """Print name, value, meaning and range of settings."""
    method = method_settings(arguments.method)
    listed: dict[str, dict[str, Any]] = {}
    for table, kind in planner_tables().items():
        holder = method if table == PLANNER else getattr(method, table)
        ends = {field.name: field.metadata for field in dataclasses.fields(kind)}
        for names, text in explained_rows(table, kind):
            for name in names:
                value, limits = getattr(holder, name), range_text(ends[name])
                dotted = name if table == PLANNER else f"{table}.{name}"
                listed[dotted] = {"value": value, "range": limits or None, "meaning": text}
    for asked in arguments.names:
        if not any(name == asked or name.startswith(f"{asked}.") for name in listed):
            cure = f"{meant(asked, [*listed, *planner_tables()])}`drystone settings` lists all."
            raise UsageError("E123", f"there is no setting {asked!r}.", where="settings", cure=cure)
    tops = tuple(f"{name}." for name in arguments.names)
    chosen = {n: one for n, one in listed.items() if not tops or f"{n}.".startswith(tops)}
    if arguments.json:
        print_json(chosen)
        return ExitCode.DONE
    for name, one in chosen.items():
        limits = "" if one["range"] is None else f"  ({one['range']})"
        print(f"{name} = {json.dumps(one['value'])}{limits.replace('`', '')}")
        meaning = one["meaning"].replace("`", "")
        print(textwrap.fill(meaning, 88, initial_indent="    ", subsequent_indent="    "))
    return ExitCode.DONE


def planner_tables() -> dict[str, type[Any]]:
    """Return the settings of the planner by the name of their TOML table."""
    tables: dict[str, type[Any]] = {PLANNER: PlannerSettings}
    for field in dataclasses.fields(PlannerSettings):
        nested = getattr(METHODS["paper"], field.name)
        if dataclasses.is_dataclass(nested):
            tables[field.name] = type(nested)
    return tables


def plain_fields(described: type[Any]) -> list[str]:
    """Return the names of the fields that do not hold settings themselves."""
    default = described()
    names = [field.name for field in dataclasses.fields(described)]
    return [name for name in names if not dataclasses.is_dataclass(getattr(default, name))]


def explained_rows(table: str, described: type[Any]) -> Iterator[tuple[tuple[str, ...], str]]:
    """Yield the fields of a table with their meaning; those explained together are one row."""
    known = entries(described)
    if table == "score":  # its weights are those of the costs, which are explained at the costs
        known |= entries(Craft)
    for (kind, text), together in groupby(plain_fields(described), key=known.__getitem__):
        choices = re.findall(r'"[^"]+"', kind) if kind.startswith("{") else []
        # What values there are, unless the text says so, then what they do.
        told = all(choice in text for choice in choices)
        values = "" if told else f"{', '.join(f'`{choice}`' for choice in choices)}. "
        yield tuple(together), values + text


def entries(described: type[Any]) -> dict[str, tuple[str, str]]:
    """Read the Parameters section of a numpydoc docstring: types and texts by names."""
    text = textwrap.dedent((described.__doc__ or "").expandtabs())
    text = re.split(r"^ *Parameters\n *-+\n", text, flags=re.MULTILINE)[1]
    text = re.split(r"\n *\w+\n *-{3,}\n", text)[0]
    found: dict[str, tuple[str, str]] = {}
    parts = re.split(r"^(?:    )?(\w[\w, ]*?)(?: : (.*))?\n(?=        |    \S)", text, flags=re.M)
    for names, kind, body in zip(parts[1::3], parts[2::3], parts[3::3], strict=True):
        for name in names.split(", "):
            found[name] = _plain(kind or ""), _plain(" ".join(body.split()))
    return found


def _plain(text: str) -> str:
    """Turn the marks of docstrings into those of the documents."""
    text = re.sub(r":\w+:`~?([^`]+)`", r"`\1`", text)
    text = re.sub(r" \(DESIGN [\d.]+\)", "", text)
    return text.replace("``", "`").replace("|", "\\|")
