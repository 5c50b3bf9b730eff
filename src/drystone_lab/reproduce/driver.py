"""`drystone reproduce`: items of the paper made one after the other, kept, and reported."""

import json
import os
import platform
import re
import time
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from datetime import UTC, datetime, timedelta
from importlib.metadata import version
from pathlib import Path
from typing import Any, Literal, NamedTuple

from PIL import PngImagePlugin

from drystone.drawing.canvas import save
from drystone.drawing.report.html import HERE, templates_in
from drystone.errors import DrystoneError, UsageError, counted
from drystone.io.folder_lock import has_files
from drystone.io.published import SETS
from drystone.kernels.backend import describe
from drystone.whole_files import write_whole
from drystone_lab.reproduce.item import Context, ItemFigure, Output, PaperItem
from drystone_lab.reproduce.items import ITEMS, item_named
from drystone_lab.runs.outcome import Runner, RunWorker, absent_data, one_by_one
from drystone_lab.runs.spec import published
from drystone_lab.table import Table, written


def heading(name: str, title: str) -> str:
    """Return the heading of an item: its numbers in the paper and what it shows.

    >>> heading("fig26-27", "stones of four kinds")
    'Fig. 26–27: stones of four kinds'
    >>> heading("figB33", "irregular stones"), heading("growth", "time over size")
    ('Fig. B.33: irregular stones', 'Time over size')
    """
    found = re.fullmatch(r"(fig|table)(B?)(\d+)(?:-(\d+))?", name)
    if found is None:
        return title[:1].upper() + title[1:]
    kind, appendix, first, last = found.groups()
    number = f"{'B.' if appendix else ''}{first}" + (f"–{last}" if last else "")  # noqa: RUF001 - a range
    return f"{'Fig.' if kind == 'fig' else 'Table'} {number}: {title}"


def part(text: str) -> str:
    """Return a section of the paper with its sign.

    >>> part("5.2"), part("§5.2"), part("B.1")
    ('§5.2', '§5.2', 'Appendix B.1')
    """
    number = text.removeprefix("§").strip()
    return f"Appendix {number}" if number.startswith("B") else f"§{number}"


def lead(records: Sequence[Mapping[str, Any]], total: int) -> str:
    """Say how much was made, with what, when, on what kind of machine."""
    if not records:
        return f"None of {total} was made so far."
    quick = sum(record["request"]["quick"] for record in records)
    kinds = [f"{quick} as quick versions"] * bool(quick)
    kinds += [f"{len(records) - quick} in full"] * (quick < len(records))
    days = sorted({record["made"]["date"].split()[0] for record in records})
    return (
        f"{len(records)} of {total} were made, {' and '.join(kinds)}, with drystone "
        f"{_different(record['request']['version'] for record in records)}, "
        f"{' to '.join(dict.fromkeys((days[0], days[-1])))}, on "
        f"{_different(record['made']['machine'] for record in records)}."
    )


def made_rows(records: Sequence[Mapping[str, Any]]) -> tuple[tuple[str, str], ...]:
    """Return what items were made with, by name; different values side by side."""
    if not records:
        return ()
    made = [record["made"] for record in records]
    walls = sum(record["taken"]["walls"] for record in records)
    planned = sum(record["taken"]["wall_seconds"] for record in records)
    packages = dict.fromkeys(name for one in made for name in one["packages"])
    return (
        ("drystone", _different(record["request"]["version"] for record in records)),
        ("kernels", _different(one["kernels"] for one in made)),
        ("Python", _different(one["python"] for one in made)),
        *((name, _different(one["packages"].get(name, "–") for one in made)) for name in packages),  # noqa: RUF001
        ("machine", _different(one["machine"] for one in made)),
        ("seeds", _different(record["request"]["seed"] for record in records)),
        ("walls", f"{walls} in {duration(planned)}"),  # those of several items once for each
    )


def duration(seconds: float) -> str:
    """Write a time.

    >>> duration(3.21), duration(90), duration(7300)
    ('3.2 s', '1 min 30 s', '2 h 1 min')
    """
    if seconds < 59.95:
        return f"{seconds:.1f} s"
    minutes, rest = divmod(round(seconds), 60)
    return f"{minutes} min {rest} s" if minutes < 60 else f"{minutes // 60} h {minutes % 60} min"


def _different(values: Iterable[object]) -> str:
    return "; ".join(dict.fromkeys(map(str, values)))


PAGE = "index.html"
LONG = 30
"""Tables of more rows are folded up."""

SHOWN = 0.624
"""CSS px of a px of a picture: its text is then a little larger than drawn (200 px an inch)."""


def write_page(
    path: Path,
    records: Sequence[Mapping[str, Any]],
    misses: Mapping[str, Mapping[str, Any]],
    order: Sequence[str],
) -> Path:
    """Write the report of everything that was made; pictures and tables are linked beside it.

    `misses` are title, section and error of items that could not be made when they were last asked
    for; they may have a record of an earlier time all the same.  `order` has the names of all.
    """
    made = {record["name"]: {**record, "prefix": f"{record['name']}/"} for record in records}
    sections = [
        {"name": name, "error": None, **misses.get(name, {}), **made.get(name, {})}
        for name in order
        if name in made or name in misses
    ]
    return _write(
        path,
        title="The paper's tables and figures, made again",
        lead=lead(records, len(order)),
        sections=sections,
        made=made_rows(records),
        up="",
    )


def write_item_page(path: Path, record: Mapping[str, Any]) -> Path:
    """Write the page of one item, into the folder of its files."""
    return _write(
        path,
        title=heading(record["name"], record["title"]),
        lead="",
        sections=[{**record, "prefix": "", "error": None}],
        made=made_rows([record]),
        up=f"../{PAGE}#{record['name']}",
    )


def _words(table: Mapping[str, Any]) -> list[bool]:
    """Return which columns are not numbers."""
    columns = range(len(table["columns"]))
    return [any(isinstance(row[k], str) for row in table["rows"]) for k in columns]


def _write(path: Path, **content: object) -> Path:
    environment = templates_in(Path(__file__).parent, HERE)
    environment.globals |= {
        "heading": heading, "part": part, "counted": counted, "duration": duration,
        "written": written, "words": _words, "LONG": LONG, "SHOWN": SHOWN,
    }  # fmt: skip
    text = environment.get_template("page.html").render(**content)
    write_whole(path, text.encode("utf-8", "replace"))
    return path


PACKAGES = (
    "numpy", "scipy", "scikit-image", "shapely", "highspy", "clarabel", "pillow", "matplotlib",
)  # fmt: skip
"""That results depend on, beside drystone itself."""


def is_met(request: Mapping[str, Any], made: Mapping[str, Any]) -> bool:
    """Return whether what was made for one request is what another asks for.

    >>> few = {"seed": 1, "published": []}
    >>> more = {"seed": 1, "published": ["almeida/R.png"]}
    >>> is_met(few, more), is_met(more, few)
    (True, False)
    """
    same = {**made, "published": request["published"]} == request
    return same and {*request["published"]} <= {*made["published"]}


def write_picture(folder: Path, picture: ItemFigure) -> dict[str, Any]:
    """Write a picture as PNG and SVG; return its names, size in px and caption for JSON."""
    png, svg = f"{picture.name}.png", f"{picture.name}.svg"
    for name in (png, svg):
        save(picture.figure, folder / name)
    with PngImagePlugin.PngImageFile(folder / png) as image:
        width, height = image.size
    return {
        "name": picture.name, "png": png, "svg": svg, "width_px": width, "height_px": height,
        "caption": picture.about,
    }  # fmt: skip


def files_of(record: dict[str, Any]) -> Iterator[str]:
    """Yield the names of the files of an item, without its JSON and page."""
    for table in (*record["tables"], *record["times"]):
        yield table["file"]
    for picture in record["pictures"]:
        yield picture["png"]
        yield picture["svg"]


def _write_table(folder: Path, name: str, table: Table) -> dict[str, Any]:
    file = f"{name}.csv"
    write_whole(folder / file, table.csv().encode())
    return {
        "name": name, "file": file, "title": table.title, "columns": list(table.columns),
        "rows": [list(row) for row in table.rows], "notes": list(table.notes),
    }  # fmt: skip


MARK = "reproduce.json"
MARK_SCHEMA = "drystone-reproduce/1"
ITEM_SCHEMA = "drystone-item/1"


class ReportFolder:
    """Where items are written, one folder each, with a report of all of them."""

    def __init__(self, path: Path) -> None:
        self.path = path
        path.mkdir(parents=True, exist_ok=True)
        mark = _read(path / MARK, MARK_SCHEMA)
        if mark is None and has_files(path):
            what = "the folder is not empty, and it is none that `drystone reproduce` wrote."
            cure = "Choose another with -o; nothing in it was touched."
            raise UsageError("E129", what, where=str(path), cure=cure)
        # Items that could not be made when they were last asked for: why, by name.
        self.misses: dict[str, dict[str, str]] = {} if mark is None else mark["misses"]
        self._write_misses()

    def record(self, name: str) -> dict[str, Any] | None:
        """Return what the JSON of an item says; None when it was not made, or a file is gone."""
        folder = self.path / name
        record = _read(folder / f"{name}.json", ITEM_SCHEMA)
        if record is None or not all((folder / file).is_file() for file in files_of(record)):
            return None
        return record

    def keep(
        self, name: str, item: PaperItem, output: Output, about: Mapping[str, Any]
    ) -> dict[str, Any]:
        """Write the files of an item in place of those of an earlier one; its JSON comes last."""
        folder = self.path / name
        folder.mkdir(exist_ok=True)
        # Without its JSON, which goes first, nothing is there of an earlier version.
        path = folder / f"{name}.json"
        earlier = _read(path, ITEM_SCHEMA)
        path.unlink(missing_ok=True)
        for file in () if earlier is None else files_of(earlier):
            (folder / file).unlink(missing_ok=True)
        record = {
            "schema": ITEM_SCHEMA,
            "name": name,
            "title": item.words["title"],
            "section": item.words["section"],
            **about,
            "paper": list(item.words["paper"]),
            "ours": list(output.ours),
            "tables": [_write_table(folder, name, table) for name, table in output.tables],
            "times": [_write_table(folder, f"{name}_times", table) for name, table in output.times],
            "pictures": [write_picture(folder, picture) for picture in output.pictures],
            "seeds": sorted({spec.seed for spec in output.runs}),
            "runs": [{"key": spec.key, **spec.as_dict()} for spec in output.runs],
        }
        write_item_page(folder / PAGE, record)
        text = json.dumps(record, ensure_ascii=False, allow_nan=False, indent=1)
        write_whole(path, text.encode())
        return record

    def miss(self, name: str, item: PaperItem, error: DrystoneError | None) -> None:
        """Note why an item cannot be made, or without an error that it is there."""
        if error is None:
            self.misses.pop(name, None)
        else:
            about = {key: item.words[key] for key in ("title", "section")}
            self.misses[name] = about | {"error": str(error)}
        self._write_misses()

    def _write_misses(self) -> None:
        mark = {"schema": MARK_SCHEMA, "misses": self.misses}
        text = json.dumps(mark, ensure_ascii=False, indent=1)
        write_whole(self.path / MARK, text.encode())


def _read(path: Path, schema: str) -> dict[str, Any] | None:
    """Return the contents of one of our files; None when it is not there, or is none."""
    try:
        data = json.loads(path.read_text(encoding="utf-8"))
    except (OSError, ValueError):  # cut short or of another program: as good as not there
        return None
    return data if isinstance(data, dict) and data.get("schema") == schema else None


EVERY_S = 2.0  # walls are told of no oftener than that


class MadeItem(NamedTuple):
    """What became of an item."""

    name: str
    # "kept" when it was finished before
    status: Literal["made", "kept", "missing data", "failed"]
    record: Mapping[str, Any] | None  # Contents of its JSON, None when there is none
    error: DrystoneError | None  # Why there is none


def reproduce(
    names: Sequence[str],
    folder: Path,
    items: Mapping[str, PaperItem] | None = None,
    *,
    data: Path | None = None,
    quick: bool = False,
    seed: int = 1,
    again: bool = False,
    work: RunWorker = one_by_one,
    say: Callable[[str], None] = lambda _: None,
    now: Callable[[], datetime] = lambda: datetime.now(UTC),
) -> Iterator[MadeItem]:
    """Make items and yield what became of each; the report is written anew after every one.

    With `again` finished items are made again; their walls are taken from the folder all the same.
    `say` is told of progress, and `now` gives the time of day that is written into the report.
    """
    items = {name: item_named(name) for name in ITEMS} if items is None else items
    report = ReportFolder(folder)
    progress = ItemProgress(say, len(names))
    context = Context(Runner(folder / "runs", data, work, progress.walls), quick, seed)
    for name in names:
        progress.begin(name)
        made = _made(name, items[name], report, context, now, again=again)
        report.miss(name, items[name], made.error)
        records = [record for each in items if (record := report.record(each)) is not None]
        write_page(folder / PAGE, records, report.misses, list(items))
        progress.line(made.status)
        yield made


def _made(
    name: str, item: PaperItem, report: ReportFolder, context: Context,
    now: Callable[[], datetime], *, again: bool,
) -> MadeItem:  # fmt: skip
    """Return what becomes of an item: it is kept, made, or there is an error."""
    # What the contents depend on, beside the name.  Published are the files that are there: some
    # items leave out rows whose stones are not.
    data, files = context.data, [file.name for each in SETS.values() for file in each.files]
    there = [each for each in files if data is not None and (data / each).is_file()]
    request = {
        "version": version("drystone"), "quick": context.quick, "seed": context.seed,
        "published": there,
    }  # fmt: skip
    kept = None if again else report.record(name)
    if kept is not None and is_met(request, kept["request"]):
        return MadeItem(name, "kept", kept, None)
    absent = [each for each in item.words.get("needs", ()) if not published(each).is_there(data)]
    begun = time.perf_counter()
    try:
        if absent:
            raise absent_data(absent, known=data is not None)
        output = item.make(context)
    except DrystoneError as error:
        return MadeItem(name, "missing data" if absent else "failed", None, error)
    seconds = time.perf_counter() - begun
    # Whenever its walls were planned
    outcomes = [context.runner.kept(key) for key in {spec.key for spec in output.runs}]
    walls = [outcome.times["wall"] for outcome in outcomes if outcome is not None]
    about = {
        "request": request,
        "made": {
            "date": now().strftime("%Y-%m-%d %H:%M UTC"),
            "machine": f"{platform.system()} {platform.machine()}, {os.cpu_count()} cores",
            "python": platform.python_version(),
            "kernels": describe(),
            "packages": {name: version(name) for name in PACKAGES},
        },
        "taken": {"seconds": seconds, "walls": len(walls), "wall_seconds": sum(walls)},
    }
    return MadeItem(name, "made", report.keep(name, item, output, about), None)


class ItemProgress:
    """Says which item is made, and how many of its walls are there."""

    def __init__(
        self, say: Callable[[str], None], total: int, clock: Callable[[], float] = time.monotonic
    ) -> None:
        self._say = say
        self._clock = clock
        self._total = total
        self._begun = clock()
        self._number = 0

    def begin(self, name: str) -> None:
        """Say that an item is begun."""
        self._number += 1
        self._name = name
        self._said = float("-inf")
        self.line("")

    def walls(self, text: str) -> None:
        """Say how many of its walls are there, unless that was just done."""
        if self._clock() - self._said >= EVERY_S:
            self._said = self._clock()
            self.line(text)

    def line(self, text: str) -> None:
        """Say something of it."""
        elapsed = timedelta(seconds=int(self._clock() - self._begun))
        what = f"{self._number} of {self._total}, {self._name}"
        self._say(f"[{elapsed}] {what}{': ' if text else ''}{text}")
