"""``python -m benchmarks``: measure everything and print the tables; ``--help`` for options."""

import argparse
import os
import subprocess
import sys
import tempfile
from pathlib import Path

from benchmarks.page import write_page
from benchmarks.table import Session, read_session, tables
from drystone.kernels.backend import VARIABLE

ROOT = Path(__file__).resolve().parents[1]

FILES = [
    f"benchmarks/test_{room}.py"
    for room in ("placement", "outlines", "stones", "statics", "metrics", "walls", "floors")
]
"""In the order of the tables."""

LIMITS = {"full": ("0.5", "5"), "quick": ("0.1", "3"), "smoke": ("0.01", "1")}
"""Seconds and rounds that a function is measured at least."""


def main(arguments: argparse.Namespace) -> None:
    """Measure with the kernels that are installed, then with kernels in Python; print."""
    with tempfile.TemporaryDirectory() as folder:
        first = measured(arguments.sizes, Path(folder) / "first.json")
        numpy = None
        if first.kernels != "Python":
            numpy = measured(arguments.sizes, Path(folder) / "numpy.json", kernels="python")
    found = tables(first, numpy)
    for table in found.values():
        text = table.markdown() if arguments.markdown else table.text()
        sys.stdout.write(text + "\n\n")
    if arguments.page:
        write_page(arguments.page, found)


def measured(sizes: str, path: Path, kernels: str | None = None) -> Session:
    """Run the measurements in a process of their own.

    Parameters
    ----------
    sizes : str
        How much is timed.
    path : Path
        For what pytest-benchmark writes.
    kernels : str, optional
        Measured without the slow twins, which are the same with any kernels; those that are
        installed, with the twins, unless given.
    """
    seconds, rounds = LIMITS[sizes]
    command = [
        *(sys.executable, "-m", "pytest", *FILES, "-q", "--no-header", "-p", "no:xdist"),
        *("--timeout", "0", "--sizes", sizes, "--benchmark-json", str(path), "--benchmark-quiet"),
        *("--benchmark-timer", "time.process_time", "--benchmark-disable-gc"),
        *("--benchmark-max-time", seconds, "--benchmark-min-rounds", rounds),
    ]
    environment = dict(os.environ)
    if kernels is not None:
        command += ["-m", "not slow"]
        environment[VARIABLE] = kernels
    subprocess.run(  # noqa: S603 - our own code
        command, check=True, cwd=ROOT, env=environment, stdout=sys.stderr
    )
    return read_session(path)


def parser() -> argparse.ArgumentParser:
    """Return the options."""
    made = argparse.ArgumentParser(prog="python -m benchmarks", description=main.__doc__)
    made.add_argument(
        "--quick", action="store_const", const="quick", default="full", dest="sizes",
        help="a minute instead of ten",
    )  # fmt: skip
    made.add_argument("--sizes", choices=list(LIMITS), help="smoke: everything once, for tests")
    made.add_argument("--markdown", action="store_true", help="print as Markdown")
    made.add_argument(
        "--page", type=Path, help="write the tables into docs/evidence/speed.md, growth too"
    )
    return made


if __name__ == "__main__":
    main(parser().parse_args())
