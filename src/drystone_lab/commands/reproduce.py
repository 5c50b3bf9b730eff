"""`drystone reproduce`: the paper's tables and figures, made again."""

import argparse
import sys
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from drystone.cli.output import make_folder, print_json
from drystone.errors import ExitCode, UsageError
from drystone.io.folder_lock import locked
from drystone.io.published import published_folder
from drystone_lab.commands import say
from drystone_lab.reproduce.items import ALL, ITEMS, item_names

if TYPE_CHECKING:  # loaded when something is made: --list does not wait for matplotlib
    from drystone_lab.reproduce.driver import MadeItem
    from drystone_lab.reproduce.item import PaperItem


def run(arguments: argparse.Namespace, items: "Mapping[str, PaperItem] | None" = None) -> ExitCode:
    """Make items, print their tables, and say where the report is."""
    if arguments.list:
        for name, words in ITEMS.items():
            print(f"{name:<12}{words['listed']}")
        return ExitCode.DONE
    names = _names(arguments)
    folder = Path(arguments.output)
    make_folder(folder)
    from drystone_lab.reproduce.driver import PAGE, reproduce  # noqa: PLC0415 - see above
    from drystone_lab.runs.workers import work_of  # noqa: PLC0415

    done = []
    with locked(folder, "*/"), work_of(arguments.jobs, arguments.dask) as work:
        data = published_folder(arguments.data)
        if data is not None and not data.is_dir():
            print(f"drystone: there is no folder {data} of published data", file=sys.stderr)
            data = None
        for made in reproduce(
            names, folder, items, data=data, quick=arguments.quick, seed=arguments.seed,
            again=arguments.again, work=work, say=(lambda _: None) if arguments.quiet else say,
        ):  # fmt: skip
            done.append(made)
            if made.error is not None:
                print(f"drystone: {made.name}: {made.error}", file=sys.stderr)
            elif not arguments.json and made.record is not None:
                _print(made.record, folder / made.name / PAGE)
    if arguments.json:
        told = [_as_json(made, folder / made.name / PAGE) for made in done]
        print_json({"report": str(folder / PAGE), "items": told})
    else:
        print(f"report: {folder / PAGE}")
    return exit_code(done, every=ALL in arguments.names)


def exit_code(done: "Sequence[MadeItem]", *, every: bool) -> ExitCode:
    """Return what the shell is told."""
    failed = [made for made in done if made.status == "failed"]
    missing = [made for made in done if made.status == "missing data"]
    if failed and failed[0].error is not None:
        return failed[0].error.exit_code
    if missing and (not every or len(missing) == len(done)):
        return ExitCode.BAD_INPUT
    return ExitCode.DONE


def _names(arguments: argparse.Namespace) -> tuple[str, ...]:
    """Return what is to be made, in the order of the paper; E138 without a name or a folder."""
    if not arguments.names or arguments.output is None:
        absent = "no folder to write to" if arguments.names else "nothing to make"
        names = " ".join(arguments.names) or "fig5"
        what = f"{absent} is named."
        cure = f"Write `drystone reproduce {names} -o DIR`; --list shows all names."
        raise UsageError("E138", what, where="reproduce", cure=cure)
    asked = {name for each in arguments.names for name in item_names(each)}
    return tuple(name for name in ITEMS if name in asked)


def _print(record: "Mapping[str, Any]", page: Path) -> None:
    from drystone_lab.table import Table  # noqa: PLC0415

    print(f"{record['name']}: {record['title']} ({record['section']})\n")
    for table in (*record["tables"], *record["times"]):
        print(Table(*(table[name] for name in ("title", "columns", "rows", "notes"))).text())
        print()
    print(f"page: {page}\n", flush=True)


def _as_json(made: "MadeItem", page: Path) -> dict[str, Any]:
    """Return what `--json` says of an item: the record, without what was run for it."""
    about: dict[str, Any] = {"name": made.name, "status": made.status}
    if made.error is not None:
        error = {"code": made.error.code, "message": str(made.error)}
        return about | {"error": error}
    record = made.record or {}
    names = (
        "title", "section", "request", "made", "taken", "paper", "ours", "tables", "times",
        "pictures",
    )  # fmt: skip
    return about | {"page": str(page)} | {name: record[name] for name in names}
