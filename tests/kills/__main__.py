"""Many kills at random moments, and a table of what became of them.

``python -m tests.kills --kills 120`` takes about an hour; nothing else has to be done.
"""

import argparse
import sys
import tempfile
import time
from collections.abc import Sequence
from functools import partial
from pathlib import Path

import numpy as np

from tests.kills.harness import SIGNALS, Killed, cases, killed, lost, run_whole


def main(argv: Sequence[str] | None = None) -> int:
    """Kill, go on, and print; return 1 when anything was left, half or lost."""
    parser = argparse.ArgumentParser(prog="python -m tests.kills", description=__doc__)
    parser.add_argument("--kills", type=int, default=120, help="in all")
    parser.add_argument("--seed", type=int, default=0, help="of the moments")
    parser.add_argument("--only", nargs="*", default=[], help="names of commands")
    asked = parser.parse_args(argv)
    rng, done = np.random.default_rng(asked.seed), []
    with tempfile.TemporaryDirectory(prefix="drystone-kills-") as place:
        folder = Path(place)
        chosen = [case for case in cases(folder) if not asked.only or case.name in asked.only]
        known = {}
        for case in chosen:
            seconds = run_whole(case, folder / case.name)
            result = None if case.result is None else case.result(folder / case.name)
            known[case.name] = seconds, result
            say(f"{case.name}: {seconds:.1f} s")
        for number in range(asked.kills):
            case = chosen[number % len(chosen)]
            sent = SIGNALS[number // len(chosen) % len(SIGNALS)]
            seconds, result = known[case.name]
            at, group = seconds * rng.uniform(0.05, 1.0), bool(rng.integers(2)) and sent != "KILL"
            here = folder / f"kill{number}"
            end = time.monotonic() + at
            one = killed(case, sent, here, partial(passed, end), group=group)
            one.faults += lost(case, here, result)
            done.append(one)
            said = "; ".join(one.faults) or "nothing lost"
            whom = "all" if group else "one"
            say(f"{number + 1} {case.name}, {sent} to {whom} after {at:.1f} s: {one.code}, {said}")
    sys.stdout.write(f"{table(done)}\n")
    return int(any(one.faults for one in done))


def passed(end: float) -> bool:
    """Say whether it is later than that."""
    return time.monotonic() >= end


def say(text: str) -> None:
    """Say how far it is."""
    sys.stderr.write(f"{text}\n")


def table(done: Sequence[Killed]) -> str:
    """Return what became of the kills, by command and signal."""
    rows = ["| command | signal | kills | orphans | odd ends | invalid | lost |"]
    rows.append("|" + " --- |" * 7)
    kinds = {
        "orphans": ("orphans",),
        "odd ends": ("exit code", "traceback", "does not end"),
        "invalid": ("half", "check"),
        "lost": ("does not go on", "left behind", "another result", "merit"),
    }
    for case in dict.fromkeys(one.case for one in done):
        for sent in SIGNALS:
            mine = [one for one in done if (one.case, one.sent) == (case, sent)]
            counts = [
                sum(any(fault.startswith(words) for fault in one.faults) for one in mine)
                for words in kinds.values()
            ]
            rows.append(f"| {case} | {sent} | {len(mine)} | {' | '.join(map(str, counts))} |")
    return "\n".join(rows)


if __name__ == "__main__":
    sys.exit(main())
