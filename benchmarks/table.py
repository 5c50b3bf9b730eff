"""Tables of what was measured, from the JSON of pytest-benchmark."""

import json
import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from drystone.planner.profile import PARTS
from drystone_lab.table import Cell, Table

FLOOR = "floor"
"""Size of what shows the speed of the machine."""

UNITS = ((1.0, "s"), (1e-3, "ms"), (1e-6, "us"), (1e-9, "ns"))


@dataclass(frozen=True)
class Measured:
    """One measurement."""

    what: str  # what, size: The function and its input
    size: str
    grows: float  # Size as a number; 0 when growth is not asked for
    twin: str | None  # What the slow twin does; None for the function of the package
    seconds: float  # The least of all rounds, for one call of the function
    facts: dict[str, Any]  # What else was kept


@dataclass(frozen=True)
class Session:
    """All measurements of one process."""

    kernels: str  # Which ran
    machine: str  # Processor, Python and NumPy
    measured: tuple[Measured, ...]  # In the order of the tests

    def fast(self) -> dict[tuple[str, str], Measured]:
        """Return the functions of the package by name and size."""
        return {(m.what, m.size): m for m in self.measured if m.twin is None}

    def twins(self, what: str, size: str) -> list[Measured]:
        """Return the slow twins of a function."""
        return [m for m in self.measured if m.twin and (m.what, m.size) == (what, size)]


def read_session(path: Path) -> Session:
    """Read what pytest-benchmark wrote."""
    data = json.loads(path.read_text(encoding="utf-8"))
    measured = []
    for entry in data["benchmarks"]:
        facts = entry["extra_info"]
        seconds = entry["stats"]["min"] / facts["count"]
        names = (facts["what"], facts["size"], facts["grows"], facts["twin"])
        measured.append(Measured(*names, seconds, facts))
    about = data["machine_info"]
    machine = f"{about['cpu']['brand_raw']}, Python {about['python_version']}, {about['numpy']}"
    return Session(about["kernels"], machine, tuple(measured))


def tables(first: Session, numpy: Session | None) -> dict[str, Table]:
    """Return all tables by their names in docs/evidence/speed.md.

    Parameters
    ----------
    first : Session
        With the kernels that are installed, and with the slow twins.
    numpy : Session or None
        With the kernels in NumPy; None when they are those of the first.
    """
    return {
        "functions": function_table(first, numpy),
        "walls": wall_table(first, numpy),
        "parts": part_table(first, numpy),
        "limits": limit_table(first, numpy),
        "memory": memory_table(first),
    }


def function_table(first: Session, numpy: Session | None) -> Table:
    """Return each function beside its twins, and exponents of growth."""
    fast, other = first.fast(), {} if numpy is None else numpy.fast()
    rows: list[tuple[Cell, ...]] = []
    names = dict.fromkeys(name for name, size in fast if _is_function(name, size))
    for what in names:
        sizes = [size for name, size in fast if name == what]
        for size in sizes:
            mine, beside = fast[what, size], other.get((what, size))
            rows += _lines(mine, beside, first.twins(what, size))
        series = [[fast[what, size] for size in sizes]]
        series.append([other[what, size] for size in sizes if (what, size) in other])
        series.append([m for m in first.measured if m.what == what and m.twin])
        if len(sizes) > 1:
            rows.append((what, "exponent", *(_exponent(s) for s in series), "", "-", "-"))
    return Table(
        "Functions beside their slow twins",
        ("function", "size", "package", "NumPy", "slow", "slow twin", "slow / package",
         "NumPy / package"),
        tuple(rows),
        (
            f"{first.machine}; kernels of the package: {first.kernels}.",
            "CPU time of one call, the least of all rounds; one pose, one stone or one candidate is"
            " one call.",
            "Exponents: of time over the pixels of the image, or over the stones of the wall.",
        ),
    )  # fmt: skip


def _is_function(what: str, size: str) -> bool:
    return size != FLOOR and not what.startswith(("wall", "peak"))


def wall_table(first: Session, numpy: Session | None) -> Table:
    """Return whole walls beside the slow planner."""
    fast, other = first.fast(), {} if numpy is None else numpy.fast()
    rows: list[tuple[Cell, ...]] = []
    for (what, size), mine in fast.items():
        if what.startswith("wall"):
            rows += _lines(mine, other.get((what, size)), first.twins(what, size))
    return Table(
        "Whole walls",
        ("wall", "size", "package", "NumPy", "slow", "slow twin", "slow / package",
         "NumPy / package"),
        tuple(rows),
        (
            "From stones in memory to the finished plan; the same stones and the same poses by"
            " either planner. CPU time, but for rows that say elapsed.",
        ),
    )  # fmt: skip


def part_table(first: Session, numpy: Session | None) -> Table:
    """Return where the time of whole walls goes."""
    rows: list[tuple[Cell, ...]] = []
    for session in (first, numpy):
        for m in () if session is None else session.measured:
            if "parts" in m.facts:
                parts = [m.facts["parts"].get(part, 0.0) for part in PARTS]
                kernels = "NumPy" if session is numpy else session.kernels
                named = (m.what, kernels, m.facts["steps"], m.facts["candidates"])
                elapsed = m.facts["elapsed"]
                rows.append((*named, *(_time(s) for s in [*parts, elapsed - sum(parts), elapsed])))
    return Table(
        "Time by part",
        ("wall", "kernels", "steps", "candidates", *PARTS, "rest", "all"),
        tuple(rows),
        (
            "By the clock, of the quickest run. Steps and candidates of all rounds. Rest: sampling,"
            " selection, keeping books.",
        ),
    )


def memory_table(first: Session) -> Table:
    """Return peaks of memory."""
    rows: list[tuple[Cell, ...]] = [
        (m.size, *(f"{m.facts['memory'][key]:.1f}" for key in ("loaded", "resident", "traced")))
        for m in first.measured
        if "memory" in m.facts
    ]
    return Table(
        "Peak memory of a plan, MB",
        ("method", "resident before", "resident at most", "allocated at most"),
        tuple(rows),
        ("Resident: of the process, libraries included. Allocated: traced while planning.",),
    )


def limit_table(first: Session, numpy: Session | None) -> Table:
    """Return how long each function takes for each of the things that it has to touch."""
    other = {} if numpy is None else numpy.fast()
    rows: list[tuple[Cell, ...]] = []
    for (what, size), mine in first.fast().items():
        items = mine.facts["items"]
        if items:
            beside = other.get((what, size))
            times = (mine.seconds / items, beside.seconds / items if beside else None)
            each = [_time(s) if s is not None else "-" for s in times]
            rows.append((what, size, mine.facts["item"], f"{items:.3g}", *each))
    return Table(
        "Time for each thing that a function has to touch",
        ("function", "size", "things", "things a call", "package", "NumPy"),
        tuple(rows),
        ("Floors: what NumPy does at best with such things on this machine, in arrays of 4096 and"
         " more.",),
    )  # fmt: skip


def _lines(
    mine: Measured, beside: Measured | None, twins: Sequence[Measured]
) -> list[tuple[Cell, ...]]:
    """Return a row for each slow twin, at least one."""
    named = (mine.what, mine.size, _time(mine.seconds), _time(beside.seconds) if beside else "-")
    gain = f"{beside.seconds / mine.seconds:.1f}" if beside else "-"
    if not twins:
        return [(*named, "-", "", "-", gain)]
    return [
        (*named, _time(t.seconds), t.twin, f"{t.seconds / mine.seconds:.0f}", gain) for t in twins
    ]


def _time(seconds: float) -> str:
    """Write a time to three digits.

    Examples
    --------
    >>> _time(0.00123456), _time(0.0)
    ('1.23 ms', '0 s')
    """
    if seconds == 0:
        return "0 s"
    unit, name = next((u for u in UNITS if abs(seconds) >= u[0]), UNITS[-1])
    return f"{seconds / unit:.3g} {name}" if seconds < 1000 else f"{seconds:.0f} s"


def _exponent(measured: Iterable[Measured]) -> str:
    """Fit log time over log size; of several twins the first."""
    points: dict[float, float] = {}
    for m in measured:
        points.setdefault(m.grows, m.seconds)
    if len(points) < 2:
        return "-"
    x, y = zip(*((math.log(n), math.log(s)) for n, s in points.items()), strict=True)
    return f"{float(np.polyfit(x, y, 1)[0]):.2f}"
