"""Many kills at random moments, and what became of them.

``python -m tests.kills --kills 120`` takes about an hour; nothing else has to be done.  With
``--keep FILE`` it goes on where it was, should somebody kill it too.
"""

import argparse
import json
import sys
import tempfile
import time
from dataclasses import asdict
from pathlib import Path

import numpy as np

from drystone_lab.commands import say
from tests.kills.harness import SIGNALS, Killed, cases, killed, lost, ran


def main(argv=None):
    """Kill, go on, and print; return 1 when anything was left, half or lost."""
    parser = argparse.ArgumentParser(prog="python -m tests.kills", description=__doc__)
    parser.add_argument("--kills", type=int, default=120, help="in all")
    parser.add_argument("--seed", type=int, default=0, help="of the moments")
    parser.add_argument("--keep", type=Path, metavar="FILE", help="of what was done, a line each")
    asked = parser.parse_args(argv)
    lines = asked.keep.read_text().splitlines() if asked.keep and asked.keep.exists() else []
    done = [Killed(**json.loads(line)) for line in lines]
    with tempfile.TemporaryDirectory(prefix="drystone-kills-") as place:
        folder = Path(place)
        chosen, known = cases(folder), {}
        for case in chosen if len(done) < asked.kills else ():
            begun = time.monotonic()
            whole = ran(case, folder / case.name)
            seconds = time.monotonic() - begun
            assert whole.returncode in (0, 4), whole.stderr
            result = None if case.result is None else case.result(folder / case.name)
            known[case.name] = seconds, result
            say(f"{case.name}: {seconds:.1f} s")
        for number in range(len(done), asked.kills):
            case = chosen[number % len(chosen)]
            sent = SIGNALS[number // len(chosen) % len(SIGNALS)]
            seconds, result = known[case.name]
            rng = np.random.default_rng([asked.seed, number])
            at, group = seconds * rng.uniform(0.05, 1.0), bool(rng.integers(2)) and sent != "KILL"
            here, end = folder / f"kill{number}", time.monotonic() + at
            one = killed(case, sent, here, lambda end=end: time.monotonic() >= end, group=group)
            one.faults += lost(case, here, result)
            done.append(one)
            if asked.keep:
                with asked.keep.open("a") as file:
                    file.write(f"{json.dumps(asdict(one))}\n")
            said = "; ".join(one.faults) or "nothing lost"
            whom = "all" if group else "one"
            say(f"{number + 1} {case.name}, {sent} to {whom} after {at:.1f} s: {one.code}, {said}")
    bad = sum(bool(one.faults) for one in done)
    say(f"{bad} of {len(done)} kills left something that runs, is half or is lost")
    return int(bad > 0)


if __name__ == "__main__":
    sys.exit(main())
