"""Options and tables of the fuzzer."""

import argparse
import json
import math
import os
import secrets
import sys
from collections.abc import Sequence
from pathlib import Path

from fuzz.driver import Format, Report, Source, fuzz, place
from fuzz.sandbox import Limits

_KEPT = 3
"""Files that are kept of one fault."""


def main(formats: Sequence[Format], argv: Sequence[str] | None = None) -> int:
    """Fuzz; print a table, and every fault once; return 1 when there is one."""
    arguments = parser([one.name for one in formats]).parse_args(argv)
    if arguments.formats:
        formats = [one for one in formats if one.name in arguments.formats]
    if arguments.write:
        name, number = arguments.write.split(":")
        case, _ = Source(formats, arguments.seed).case(name, int(number))
        sys.stdout.write(f"{place(case, arguments.keep)}\n")
        return 0
    sys.stderr.write(f"seed {arguments.seed}\n")
    limits = Limits(cpu_s=arguments.cpu, wall_s=arguments.wall)
    report = fuzz(
        formats, arguments.seed, count=arguments.count, seconds=arguments.time,
        jobs=arguments.jobs, limits=limits, say=sys.stderr.write,
    )  # fmt: skip
    if arguments.keep:
        keep(report, Source(formats, arguments.seed), arguments.keep)
    sys.stdout.write(as_json(report) if arguments.json else table(report))
    return int(bool(report.numbers))


def parser(names: Sequence[str]) -> argparse.ArgumentParser:
    """Return the options."""
    made = argparse.ArgumentParser(
        prog="python -m fuzz",
        description="Reads damaged files of all formats, and tells what no user should see.",
    )
    add = made.add_argument
    add("--seed", type=int, default=secrets.randbelow(2**32), help="drawn when it is not given")
    add("--count", type=int, metavar="N", help="executions")
    add("--time", type=float, metavar="S", default=math.inf, help="seconds")
    add("--jobs", type=int, default=os.cpu_count() or 1, metavar="N", help="processes")
    add("--formats", nargs="+", choices=names, metavar="NAME", help=f"of {', '.join(names)}")
    add("--keep", type=Path, metavar="DIR", help="for the files that did it")
    add("--cpu", type=float, default=Limits.cpu_s, metavar="S", help="processor time of a file")
    add("--wall", type=float, default=Limits.wall_s, metavar="S", help="patience with a file")
    add("--json", action="store_true", help="print JSON")
    add("--write", metavar="NAME:N", help="only write the files of one execution, to --keep")
    return made


def keep(report: Report, source: Source, folder: Path) -> None:
    """Write the first files of every fault, each with a line on what it does."""
    folder.mkdir(parents=True, exist_ok=True)
    for (name, kind, where), numbers in sorted(report.numbers.items()):
        for number in sorted(numbers)[:_KEPT]:
            place(source.case(name, number)[0], folder / f"{name}-{report.seed}-{number}")
            with (folder / "faults.txt").open("a", encoding="utf-8") as file:
                said = report.said[name, kind, where]
                file.write(f"{name}-{report.seed}-{number}: {kind} {where}: {said}\n")


def as_json(report: Report) -> str:
    """Return everything as JSON."""
    faults = [
        {"format": key[0], "kind": key[1], "where": key[2], "numbers": sorted(numbers),
         "said": report.said[key]}
        for key, numbers in sorted(report.numbers.items())
    ]  # fmt: skip
    return json.dumps({"executions": dict(report.executions), "faults": faults}, indent=1) + "\n"


def table(report: Report) -> str:
    """Return formats with executions, executions a second and defects; then the defects."""
    rows = [f"{'format':<10} {'executions':>10} {'read':>9} {'a second':>9} {'defects':>8}"]

    def row(name: str, executions: int, read: int, seconds: float, defects: int) -> None:
        speed = executions / max(seconds, 1e-9)
        rows.append(f"{name:<10} {executions:>10,} {read:>9,} {speed:>9,.0f} {defects:>8}")

    for name, count in report.executions.items():
        row(name, count, report.read[name], report.seconds[name], len(report.defects(name)))
    sums = (counts.total() for counts in (report.executions, report.read, report.seconds))
    row("all", *sums, len(report.numbers))
    for key, numbers in sorted(report.numbers.items()):
        name, kind, where = key
        rows += ["", f"{name}: {kind} in {where}", f"  {report.said[key]}"]
        rows.append(f"  {len(numbers)} times, first in execution {name}:{min(numbers)}")
    return "\n".join(rows) + "\n"
