"""Commands that are killed at some moment: nothing runs on, nothing is half, nothing is lost.

A command runs in a group of its own, so whatever it starts is found by the number of the group.
"""

import io
import json
import os
import signal
import subprocess
import sys
import time
from collections.abc import Callable
from contextlib import redirect_stderr, redirect_stdout
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from PIL import Image

from drystone.cli import main
from drystone.io.checkpoint import CHECKPOINT

SIGNALS = ("INT", "TERM", "KILL")

PATIENCE_S = 10.0
"""Whatever a killed command has started ends within this time,"""

ENDING_S = 120.0
"""and the command itself within this after INT and TERM, on a machine that is busy too."""

KEPT_S = 5.0
"""What a search with a time limit has found so long before it is killed is kept."""

LOGGED = """
import signal, sys, time

signal.signal(signal.SIGINT, signal.default_int_handler)  # which a shell may ignore

from drystone.cli import keeping, main
from drystone.planner.events import Callbacks

log, pause = open(sys.argv[1], "a", buffering=1), sys.argv[2]

def wait_at(place):
    if place == pause:
        open(sys.argv[1] + ".paused", "w").close()
        while True:  # a signal just before a long sleep would be seen after it only
            time.sleep(0.05)

def on_walls(_, found):
    log.write(f"{time.time()} {found.merit!r}\\n")
    wait_at(f"wall {found.walls}")

Callbacks.on_walls, Callbacks.on_step = on_walls, lambda _, step: wait_at(f"stone {step.number}")
if pause:
    keeping.EVERY_S, keeping.SHARE = 0.0, 1.0
sys.exit(main(sys.argv[3:]))
"""
"""The command line, with a log of when which merit was the best.

It may wait somewhere to be killed, and then keeps all that it finds at once.
"""


@dataclass(frozen=True)
class Case:
    """A command whose runs are killed."""

    name: str
    arguments: tuple[str, ...]  # ``{folder}`` for where it writes
    again: tuple[str, ...]  # What is added to go on
    # Reads from the folder what an uninterrupted run must give too; None for a search that the
    # clock ends
    result: Callable[[Path], Any] | None
    stones: Path | None = None  # Of the plan in the folder; None when there is none
    pause: str = ""  # Where it waits to be killed, as "stone 3" or "wall 7"; empty for nowhere

    def told(self, folder, *more):
        return [one.replace("{folder}", str(folder)) for one in (*self.arguments, *more)]

    def command(self, folder, *more):
        log = str(folder.with_suffix(".log"))
        return [sys.executable, "-c", LOGGED, log, self.pause, *self.told(folder, *more)]

    def waits(self, folder):
        """Say whether the command waits to be killed."""
        return folder.with_suffix(".log.paused").exists()


@dataclass
class Killed:
    """What became of a run that was killed."""

    case: str
    sent: str
    code: int
    faults: list[str] = field(default_factory=list)


def plan_bytes(folder):
    return (folder / "plan.json").read_bytes()


def outcomes(folder):
    """Return the runs that are kept, without their times."""
    runs = {path.name: json.loads(path.read_bytes()) for path in (folder / "runs").glob("*.json")}
    return {name: (data["figures"], data["plan"]) for name, data in runs.items()}


def figure(folder):
    """Return what an item of `reproduce` says, its runs included, without times."""
    record = json.loads((folder / "figB34" / "figB34.json").read_bytes())
    return outcomes(folder), record["ours"], record["tables"]


def ran(case, folder, *more):
    """Let a command end by itself."""
    return subprocess.run(  # noqa: S603 - our own code
        case.command(folder, *more), capture_output=True, text=True, check=False
    )


def called(arguments):
    """Call the command line in this process; return its exit code and what it said."""
    words = io.StringIO()
    with redirect_stdout(words), redirect_stderr(words):
        return main(arguments), words.getvalue()


def killed(case, sent, folder, moment, *, group):
    """Run a command in a new folder, send a signal when `moment()` says so, and see what is left.

    With `group` the signal goes to all of its processes, as from a terminal or a supervisor.
    """
    with folder.with_suffix(".txt").open("w") as words:
        process = subprocess.Popen(  # noqa: S603 - our own code
            case.command(folder), stdout=words, stderr=words, start_new_session=True
        )
        while process.poll() is None and not moment():
            time.sleep(0.01)
        at = time.time()
        if process.poll() is None:
            (os.killpg if group else os.kill)(process.pid, getattr(signal, f"SIG{sent}"))
        try:
            code = process.wait(ENDING_S)
        except subprocess.TimeoutExpired:
            os.killpg(process.pid, signal.SIGKILL)
            return Killed(case.name, sent, 0, ["does not end"])
    found = Killed(case.name, sent, code)
    left = _left_after(process.pid)
    if left:
        found.faults.append(f"orphans: {left}")
        os.killpg(process.pid, signal.SIGKILL)
    found.faults += _odd_end(sent, code, folder.with_suffix(".txt").read_text())
    found.faults += invalid(case, folder)
    folder.with_suffix(".at").write_text(repr(at))
    return found


def _left_after(group):
    """Return the processes of a group that are at work after some patience."""
    listing = ["ps", "-A", "-o", "pgid=", "-o", "stat=", "-o", "args="]
    until = time.monotonic() + PATIENCE_S
    while True:
        said = subprocess.run(listing, capture_output=True, text=True, check=True)  # noqa: S603
        rows = [line.split(maxsplit=2) for line in said.stdout.splitlines()]
        left = [row[-1] for row in rows if row[0] == str(group) and row[1][0] != "Z"]
        if not left or time.monotonic() > until:
            return left
        time.sleep(0.2)


def _odd_end(sent, code, words):
    """Say what a command must not end with; one that had ended, or not begun, is its own."""
    number = getattr(signal, f"SIG{sent}")
    if code not in (0, 4, -number, {"INT": 130, "TERM": 143}.get(sent, -number)):
        yield f"exit code {code}: {words[-300:]}"
    if code >= 0 and "Traceback" in words:
        yield f"traceback: {words[-300:]}"


def invalid(case, folder):
    """Say what is half in a folder, or no plan that `check` accepts."""
    for path in sorted(folder.rglob("*")) if folder.exists() else ():
        if path.name.startswith(".") or path.is_dir():
            continue  # what a killed run was writing, and its lock
        try:
            if path.suffix == ".json":
                json.loads(path.read_bytes())
            elif path.suffix in (".png", ".gif"):
                with Image.open(path) as picture:
                    picture.load()
            elif path.suffix == ".html" and not path.read_text().rstrip().endswith("</html>"):
                yield f"half: {path.name}"
        except (OSError, ValueError) as error:
            yield f"half: {path.name}: {error}"
    if case.stones is not None and (folder / "plan.json").exists():
        code, words = called(["check", str(folder), "--stones", str(case.stones)])
        if code != 0:
            yield f"check: {words}"


def lost(case, folder, whole):
    """Go on with a run that was killed, and say what an uninterrupted one has and it has not."""
    log = folder.with_suffix(".log")
    before = _merits(log)
    if case.result is not None:
        code, words = called(case.told(folder, *case.again))
    else:
        done = ran(case, folder, *case.again)
        code, words = done.returncode, done.stderr
    if code not in (0, 4) or "Traceback" in words:
        yield f"does not go on: {code} {words[-300:]}"
        return
    hidden = [one.name for one in folder.rglob(".*")]
    if hidden or (folder / CHECKPOINT).exists():
        yield f"left behind: {hidden or CHECKPOINT}"
    if case.result is not None:
        if case.result(folder) != whole:
            yield "another result"
        return
    yield from invalid(case, folder)
    at = float(folder.with_suffix(".at").read_text())
    kept = [merit for when, merit in before if when <= at - KEPT_S]
    after = _merits(log)[len(before) :]
    if kept and after and after[0][1] < max(kept):
        yield f"merit {after[0][1]}, and {max(kept)} was found {KEPT_S} s before"


def _merits(log):
    lines = log.read_text().splitlines() if log.exists() else []
    return [(float(when), float(merit)) for when, merit in (line.split() for line in lines)]


def made_stones(path, count, width, height, courses):
    """Write a generated stone set."""
    settings = f"--set width_px={width} --set height_px={height} --set courses={courses}"
    code, words = called(
        ["generate", "rubble", "--count", str(count), "-o", str(path), *settings.split()]
    )
    assert code == 0, words
    return path


def cases(folder):
    """Return the commands, on generated stones that are written to a folder."""
    few = made_stones(folder / "few.png", 12, 130, 50, 3)
    many = made_stones(folder / "many.png", 60, 700, 300, 6)
    search = f"plan {few} --wall 130x50 --scale 1 --seed 1 -o {{folder}} "
    paper = f"plan {many} --wall 400x160 --scale 1 --method paper -o {{folder}}"
    bench = "bench --suite bricks --policy paper random --quick --jobs 2 --store {folder}"
    item = "reproduce figB34 --quick -o {folder} --jobs 2"
    return [
        Case(name, tuple(words.split()), ("--resume",) if stones else (), result, stones)
        for name, words, result, stones in (
            ("paper", paper, plan_bytes, many),
            ("best, budget", search + "--budget 60", plan_bytes, few),
            ("best, time", search + "--time 10", None, few),
            ("best, jobs 2", search + "--budget 60 --jobs 2", plan_bytes, few),
            ("bench", bench, outcomes, None),
            ("reproduce", item, figure, None),
        )
    ]
