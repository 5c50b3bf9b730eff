"""Runs the commands of a walk-through one after the other, and says how long each took."""

import os
import subprocess
import sys
import time
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path


@dataclass
class Walk:
    """Commands run so far.

    Parameters
    ----------
    folder : Path
        Where they run.
    environment : dict of str to str
        Variables that they get besides those of this process.
    taken : list of (str, float, float)
        Each command, or what was done instead of one, its seconds, and those of processors.
    """

    folder: Path
    environment: dict[str, str] = field(default_factory=dict)
    taken: list[tuple[str, float, float]] = field(default_factory=list)

    def drystone(
        self, *arguments: object, lines: int = 12, codes: Sequence[int] = (0,)
    ) -> subprocess.CompletedProcess[str]:
        """Run `drystone` and print the first lines of what it says.

        Parameters
        ----------
        *arguments : object
            Of the command line.
        lines : int
            How many lines of stdout are printed.
        codes : sequence of int
            Exit codes that are right: 4 is an incomplete wall, 5 one that does not stand.
        """
        words = [str(argument) for argument in arguments]
        command = [sys.executable, "-m", "drystone", *words]
        return self._run(command, ["drystone", *words], lines, codes)

    def python(self, code: str) -> subprocess.CompletedProcess[str]:
        """Run a line of Python as `python -c` does."""
        return self._run([sys.executable, "-c", code], ["python", "-c", f"'{code}'"], 20, (0,))

    @contextmanager
    def timed(self, what: str) -> Iterator[None]:
        """Count what is done in a block."""
        seconds, busy = time.perf_counter(), _busy()
        yield
        took = time.perf_counter() - seconds, _busy() - busy
        self.taken.append((what, *took))
        print(f"   {took[0]:.1f} s, {took[1]:.1f} s of processors\n", flush=True)

    def summary(self) -> None:
        """Print all commands with their seconds."""
        print("      s    cpu s")
        for what, seconds, busy in self.taken:
            print(f"{seconds:7.1f}  {busy:7.1f}  {what}")
        total = [sum(column) for column in zip(*(row[1:] for row in self.taken), strict=True)]
        print(f"{total[0]:7.1f}  {total[1]:7.1f}  in all")

    def _run(
        self, command: list[str], shown: list[str], lines: int, codes: Sequence[int]
    ) -> subprocess.CompletedProcess[str]:
        print(f"$ {' '.join(shown)}", flush=True)
        with self.timed(" ".join(shown)):
            ran = subprocess.run(
                command,
                cwd=self.folder,
                env=os.environ | self.environment,
                capture_output=True,
                text=True,
                check=False,
            )
            for line in [*ran.stderr.splitlines()[:8], *ran.stdout.splitlines()[:lines]]:
                print(f"   {line}")
        if ran.returncode not in codes:
            raise SystemExit(f"{' '.join(shown)} ended with {ran.returncode}:\n{ran.stderr}")
        return ran


def _busy() -> float:
    """Return the seconds of processors so far, of this process and of those that it started."""
    times = os.times()
    return times.user + times.system + times.children_user + times.children_system
