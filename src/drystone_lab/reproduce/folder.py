"""A folder of items that were made, and what it says of them."""

import json
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any

from drystone.errors import DrystoneError, UsageError
from drystone.io.folder_lock import has_files
from drystone.whole_files import write_whole
from drystone_lab.reproduce.files import files_of, write_picture, write_tables
from drystone_lab.reproduce.item import Item, Output
from drystone_lab.reproduce.page import PAGE, Miss, write_item_page, write_page
from drystone_lab.reproduce.request import Request
from drystone_lab.runs.store import RunStore

MARK = "reproduce.json"
MARK_SCHEMA = "drystone-reproduce/1"
ITEM_SCHEMA = "drystone-item/1"


class ReportFolder:
    """Where items are written, one folder each, with a report of all of them.

    Parameters
    ----------
    path : Path
        Made when it is missing; taken when it is empty or one of these.

    Raises
    ------
    UsageError
        E129: there are other files in it.
    """

    def __init__(self, path: Path) -> None:
        self.path = path
        path.mkdir(parents=True, exist_ok=True)
        if _read(path / MARK, MARK_SCHEMA) is None and has_files(path):
            raise UsageError(
                "E129",
                "the folder is not empty, and it is none that `drystone reproduce` wrote.",
                where=str(path),
                cure="Choose another with -o; nothing in it was touched.",
            )
        self._write_misses(self.misses)

    @property
    def runs(self) -> RunStore:
        """Finished walls."""
        return RunStore(self.path / "runs")

    @property
    def misses(self) -> dict[str, dict[str, str]]:
        """Items that could not be made when they were last asked for: why, by name."""
        mark = _read(self.path / MARK, MARK_SCHEMA)
        return {} if mark is None else mark["misses"]

    def page(self, name: str) -> Path:
        """Return where the page of an item is."""
        return self.path / name / PAGE

    def record(self, name: str) -> dict[str, Any] | None:
        """Return what the JSON of an item says; None when it was not made, or a file is gone."""
        folder = self.path / name
        record = _read(folder / f"{name}.json", ITEM_SCHEMA)
        if record is None or not all((folder / file).is_file() for file in files_of(record)):
            return None
        return record

    def finished(self, name: str, request: Request) -> dict[str, Any] | None:
        """Return the record of an item that was made for such a request; None without one."""
        record = self.record(name)
        return record if record is not None and request.is_met_by(record["request"]) else None

    def keep(
        self, name: str, item: Item, output: Output, about: Mapping[str, Any]
    ) -> dict[str, Any]:
        """Write the files of an item in place of those of an earlier one; its JSON comes last.

        Returns
        -------
        record : dict
            What the JSON says.
        """
        folder = self.path / name
        folder.mkdir(exist_ok=True)
        self._remove(name)
        record = {
            "schema": ITEM_SCHEMA,
            "name": name,
            "title": item.title,
            "section": item.section,
            **about,
            "paper": list(output.paper),
            "ours": list(output.ours),
            **write_tables(folder, output),
            "pictures": [write_picture(folder, picture) for picture in output.pictures],
            "seeds": sorted({spec.seed for spec in output.runs}),
            "runs": [{"key": spec.key, **spec.as_dict()} for spec in output.runs],
        }
        write_item_page(self.page(name), record)
        text = json.dumps(record, ensure_ascii=False, allow_nan=False, indent=1)
        write_whole(folder / f"{name}.json", text.encode())
        self.forget_miss(name)
        return record

    def miss(self, name: str, item: Item, error: DrystoneError) -> None:
        """Note why an item cannot be made."""
        text = {"title": item.title, "section": item.section, "error": str(error)}
        self._write_misses({**self.misses, name: text})

    def forget_miss(self, name: str) -> None:
        """Note no longer why an item was not made: it is there."""
        self._write_misses({key: miss for key, miss in self.misses.items() if key != name})

    def write_report(self, order: Iterable[str]) -> Path:
        """Write the page of everything that was made so far."""
        names = list(order)
        records = [record for name in names if (record := self.record(name)) is not None]
        misses = [Miss(name, **self.misses[name]) for name in names if name in self.misses]
        return write_page(self.path / PAGE, records, misses, names)

    def _remove(self, name: str) -> None:
        """Take away the files of an earlier version, its JSON first: without it none is there."""
        path = self.path / name / f"{name}.json"
        record = _read(path, ITEM_SCHEMA)
        path.unlink(missing_ok=True)
        for file in () if record is None else files_of(record):
            (path.parent / file).unlink(missing_ok=True)

    def _write_misses(self, misses: Mapping[str, Mapping[str, str]]) -> None:
        text = json.dumps({"schema": MARK_SCHEMA, "misses": misses}, ensure_ascii=False, indent=1)
        write_whole(self.path / MARK, text.encode())


def _read(path: Path, schema: str) -> dict[str, Any] | None:
    """Return the contents of one of our files; None when it is not there, or is none."""
    if not path.is_file():
        return None
    try:
        data = json.loads(path.read_text(encoding="utf-8"))
    except ValueError:  # cut short or of another program: as good as not there
        return None
    return data if isinstance(data, dict) and data.get("schema") == schema else None
