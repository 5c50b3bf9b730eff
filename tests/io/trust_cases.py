"""Run the command line over files that were found to fail, with limits, in a process of its own."""

import contextlib
import io
import json
import resource
import shutil
import sys
import time
from pathlib import Path

from drystone.cli import main

_MORE = {"slow_5ea9e29c60.dxf": ("--unit", "mm"), "slow_f4dfb01177.stl": ("--px-per-m", "300")}
"""Options with which a file is slow."""


def run(cases: str, work: str) -> None:
    """Read all files of a folder; print for each how that ended, and what it took."""
    # A case that hangs is killed here, and is the one after the last that was printed.
    resource.setrlimit(resource.RLIMIT_CPU, (60, 61))
    resource.setrlimit(resource.RLIMIT_AS, (4_000_000_000, 4_000_000_000))
    for path in sorted(Path(cases).iterdir()):
        for command in _commands(path, Path(work)):
            begun, said = time.process_time(), io.StringIO()
            with contextlib.redirect_stdout(io.StringIO()), contextlib.redirect_stderr(said):
                code = main(command)
            told = {
                "name": path.name, "code": code, "said": said.getvalue(),
                "seconds": time.process_time() - begun, "megabytes": _most_megabytes(),
            }  # fmt: skip
            sys.stdout.write(json.dumps(told) + "\n")
            sys.stdout.flush()


def _commands(path: Path, work: Path) -> list[list[str]]:
    stones, out = str(work / "stones.png"), str(work / "out")
    if path.suffix == ".md":
        return []
    if path.suffix == ".toml":
        plan = ["plan", stones, "--wall", "60x40", "-o", out]
        return [[*plan, "--settings", str(path)]]
    if path.name.startswith("plan_"):
        (work / "plan").mkdir(exist_ok=True)
        shutil.copy(path, work / "plan" / "plan.json")
        return [["measure", str(work / "plan")], ["check", str(work / "plan"), "--stones", stones]]
    read = ["stones", str(path)]
    return [read, [*read, *_MORE[path.name]]] if path.name in _MORE else [read]


def _most_megabytes() -> int:
    """Return the largest memory so far; that of the system includes the parent's."""
    for line in Path("/proc/self/status").read_text(encoding="ascii").splitlines():
        if line.startswith("VmHWM:"):
            return int(line.split()[1]) // 1000
    return 0
