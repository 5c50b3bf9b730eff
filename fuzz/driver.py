"""Executions shared out among processes that may die, and what came of them."""

import gc
import math
import multiprocessing
import os
import shutil
import signal
import struct
import tempfile
import time
import traceback
from collections import Counter, defaultdict
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field
from functools import partial
from itertools import chain
from multiprocessing.connection import Connection, wait
from multiprocessing.process import BaseProcess
from pathlib import Path
from random import Random
from typing import Any, BinaryIO

from fuzz.mutate import Case, mutated
from fuzz.raw import FOREIGN
from fuzz.sandbox import Fault, Limits, Sandbox, where_killed

_FORK = multiprocessing.get_context("fork")
_MOST_PX = 200_000_000
"""Beyond it readers refuse, so that no time is due to pixels."""
_AT_ONCE = 10
"""Executions of one process, for each of the weight of a format."""

Key = tuple[str, str, str]
"""Format, kind and place: faults that have all in common are one."""


@dataclass(frozen=True)
class Format:
    """Something that is read.

    Parameters
    ----------
    name : str
        What it is called in tables.
    seeds : callable
        Returns valid cases, always the same.
    run : callable
        Reads a changed case: the path of its main file, or of its folder, and a generator for
        what else may differ.
    weight : int
        Share of the executions.
    folder : bool
        The folder is what is read.
    """

    name: str
    seeds: Callable[[], Sequence[Case]]
    run: Callable[[Path, Random], object]
    weight: int = 20
    folder: bool = False


@dataclass
class Report:
    """What came of executions.

    Parameters
    ----------
    seed : int
        Of all random choices.
    executions : Counter
        By format.
    read : Counter
        Of these, those in which everything was read.
    seconds : Counter
        Processor time that they took, by format.
    numbers : mapping
        Numbers of the executions by fault.
    said : mapping
        Words of the first of them.
    """

    seed: int
    executions: Counter[str] = field(default_factory=Counter)
    read: Counter[str] = field(default_factory=Counter)
    seconds: Counter[str] = field(default_factory=Counter)
    numbers: dict[Key, list[int]] = field(default_factory=lambda: defaultdict(list))
    said: dict[Key, str] = field(default_factory=dict)

    def add(self, name: str, number: int, fault: Fault | str) -> None:
        """Note a fault; words are of a fault of the fuzzer itself."""
        if isinstance(fault, str):
            raise RuntimeError(f"execution {name}:{number}: {fault}")
        key = name, fault.kind, fault.where
        if number <= min(self.numbers[key], default=number):
            self.said[key] = fault.said
        self.numbers[key].append(number)

    def defects(self, name: str) -> list[Key]:
        """Return the faults of a format."""
        return sorted(key for key in self.numbers if key[0] == name)


class Source:
    """Makes the case of an execution from the seed, its format and its number alone."""

    def __init__(self, formats: Sequence[Format], seed: int) -> None:
        self.seed = seed
        self._seeds = {one.name: one.seeds() for one in formats}
        # Of its own format only, so that it does not depend on what else is read.
        self._pools = {
            name: [*FOREIGN, *chain.from_iterable(case.values() for case in seeds)]
            for name, seeds in self._seeds.items()
        }

    def case(self, name: str, number: int) -> tuple[Case, Random]:
        """Return changed files, and a generator for what else differs in how they are read."""
        rng, reading = (Random(f"{self.seed} {name} {number}{what}") for what in ("", " read"))
        return mutated(rng.choice(self._seeds[name]), rng, self._pools[name]), reading


def place(case: Case, folder: Path) -> Path:
    """Write a case into a folder, alone; return the path of its main file."""
    folder.mkdir(exist_ok=True)
    with os.scandir(folder) as old:
        for entry in old:
            remove = shutil.rmtree if entry.is_dir(follow_symlinks=False) else os.unlink
            remove(entry.path)
    for name, data in case.items():
        path = folder / name
        if isinstance(data, bytes):
            path.write_bytes(data)
        elif data == "fifo":
            os.mkfifo(path)
        elif data == "folder":
            path.mkdir()
        elif data == "loop":
            path.symlink_to(path)
        elif data == "endless":
            path.symlink_to("/dev/zero")
    return folder / next(iter(case))


def pixels_of(case: Case) -> int:
    """Return how many pixels the headers of PNG, GIF and BMP files promise, 0 for others."""
    total = 0
    for data in case.values():
        if isinstance(data, bytes) and len(data) > 26:
            size = (0, 0)
            head = data.rfind(b"IHDR") + 4
            if 4 <= head <= len(data) - 8:
                size = struct.unpack(">II", data[head : head + 8])
            elif data.startswith(b"GIF8"):
                size = struct.unpack("<HH", data[6:10])
            elif data.startswith(b"BM"):
                size = struct.unpack("<ii", data[18:26])
            total += min(abs(size[0] * size[1]), _MOST_PX)
    return total


@dataclass(frozen=True)
class _Part:
    """Executions of one format that one process is given."""

    format: Format
    numbers: range


class _Worker:
    """A process that works on a part."""

    def __init__(self, part: _Part, source: Source, folder: Path, limits: Limits) -> None:
        self.part = part
        self.folder = Path(tempfile.mkdtemp(dir=folder))
        self.trace: BinaryIO = tempfile.TemporaryFile()  # noqa: SIM115
        self.now = _FORK.RawArray("d", (part.numbers.start, 0.0, 0.0))
        self.connection, theirs = _FORK.Pipe(duplex=False)
        self.process: BaseProcess = _FORK.Process(
            target=_work,
            args=(part, source, self.folder, limits, self.trace, self.now, theirs),
            daemon=True,
        )
        self.process.start()
        theirs.close()


def _work(
    part: _Part,
    source: Source,
    folder: Path,
    limits: Limits,
    trace: BinaryIO,
    now: Any,
    connection: Connection,
) -> None:
    gc.freeze()
    number = part.numbers.start
    try:
        sandbox = Sandbox(folder, limits, trace)
        begun = time.process_time()
        for number in part.numbers:
            now[:] = number, time.process_time() - begun, sandbox.read
            case, rng = source.case(part.format.name, number)
            path = place(case, folder / "case")
            path = path.parent if part.format.folder else path
            for fault in sandbox.run(partial(part.format.run, path, rng), pixels_of(case)):
                connection.send((number, fault))
        now[:] = part.numbers.stop, time.process_time() - begun, sandbox.read
    except BaseException:  # of the fuzzer, not of what it tries
        connection.send((number, traceback.format_exc()))
    connection.close()


def fuzz(
    formats: Sequence[Format],
    seed: int,
    *,
    count: int | None = None,
    seconds: float = math.inf,
    jobs: int = 1,
    limits: Limits | None = None,
    say: Callable[[str], object] = str,
) -> Report:
    """Execute, by number or by time.

    Parameters
    ----------
    formats : sequence of Format
        What is read.
    seed : int
        Of all random choices; the same seed and number of an execution give the same files.
    count : int, optional
        How many executions there are, of all formats by their weights.
    seconds : float
        After which no more are begun.
    jobs : int
        Processes at a time; they change nothing of what is found.
    limits : Limits, optional
        Of every execution.
    say : callable
        Told of every defect when it is found first.
    """
    limits = limits or Limits()
    source, report = Source(formats, seed), Report(seed)
    end = time.monotonic() + seconds
    parts = _parts(formats, count)
    left: list[_Part] = []
    working: dict[Connection, _Worker] = {}
    with tempfile.TemporaryDirectory(prefix="fuzz") as name:
        while True:
            while len(working) < jobs and time.monotonic() < end:
                part = left.pop() if left else next(parts, None)
                if part is None:
                    break
                worker = _Worker(part, source, Path(name), limits)
                working[worker.connection] = worker
            if not working:
                return report
            known = set(report.numbers)
            try:
                ready = wait(list(working))
            except KeyboardInterrupt:
                end = 0.0  # what was found is told
                continue
            for connection in ready:
                worker = working[connection]
                try:
                    report.add(worker.part.format.name, *connection.recv())
                except EOFError:
                    del working[connection]
                    left += _ended(worker, report, limits)
            for key in report.numbers.keys() - known:
                say(f"{key[0]}:{min(report.numbers[key])} {key[1]} in {key[2]}\n")


def _parts(formats: Sequence[Format], count: int | None) -> Iterator[_Part]:
    """Yield parts of all formats in turn, without end or until there are enough."""
    begin = Counter[str]()
    in_round = _AT_ONCE * sum(one.weight for one in formats)
    left = math.inf if count is None else count
    while left > 0:
        share = min(1.0, left / in_round)
        for one in formats:
            size = int(min(left, math.ceil(one.weight * _AT_ONCE * share)))
            yield _Part(one, range(begin[one.name], begin[one.name] + size))
            begin[one.name] += size
            left -= size


def _ended(worker: _Worker, report: Report, limits: Limits) -> list[_Part]:
    """Note what a process did; return what it left undone when it died."""
    worker.process.join()
    part, name = worker.part, worker.part.format.name
    number, used, read = worker.now
    end = int(number)
    died = end < part.numbers.stop
    if died:
        report.add(name, end, _killed(worker, limits))
        end += 1
    worker.trace.close()
    worker.connection.close()
    shutil.rmtree(worker.folder)
    report.executions[name] += end - part.numbers.start
    report.read[name] += int(read)
    report.seconds[name] += used + limits.cpu_s * died
    return [_Part(part.format, range(end, part.numbers.stop))] if end < part.numbers.stop else []


def _killed(worker: _Worker, limits: Limits) -> Fault:
    """Say what a process died of."""
    code, at = worker.process.exitcode or 0, where_killed(worker.trace)
    if code == -signal.SIGPROF:
        return Fault(
            "time", at, f"more processor time than {limits.cpu_s} s, and that of its pixels"
        )
    if code == -signal.SIGALRM:
        return Fault("stuck", at, f"nothing for {limits.wall_s} s")
    name = signal.Signals(-code).name if code < 0 else f"exit {code}"
    return Fault(f"crash {name}", at, "the process died")
