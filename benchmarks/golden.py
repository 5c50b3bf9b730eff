"""``python -m benchmarks.golden`` tells whether plans are the same bytes as before, and as fast.

Plans of R, PR, IR (where the published stones are) and of four generated sets, by both methods and
two seeds, with what `analyse`, `measure` and `check` say of them.  With ``--against SRC``, the
``src`` folder of another checkout, both plan in turn on the same machine in the same minutes, and
each difference of bytes and the ratio of times is told; otherwise what is there is printed.
Whatever shapes a plan on purpose is explained in CHANGELOG.
"""

import argparse
import hashlib
import json
import os
import statistics
import subprocess
import sys
import tempfile
import time
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
DATA = Path(os.environ.get("DRYSTONE_DATA", ROOT.parent / "shared" / "data"))
METHODS = ("paper", "best")
SEEDS = (1, 2)
BUDGET = 8
"""Walls that `best` tries."""

GENERATED = {
    "rubble": ("280x80", ()),
    "polygon": ("480x200", ("--count", "24")),
    "fourier": ("300x120", ("--count", "20")),
    "brick": ("240x100", ("--count", "30", "--set", "aspect=2", "--set", "height_px=20")),
}
"""Free size of the wall and options of `generate`."""

PUBLISHED = {
    "R": ("almeida/R.png", "1445x395", ".2"),
    "PR": ("almeida/PR.png", "600x160", ".5"),
    "IR": ("almeida/IR.png", "1446x377", ".3"),
}
"""File of the published stones, free size of the wall in source px, scale."""


@dataclass(frozen=True)
class Run:
    """One plan: a digest of each of its outputs, and CPU seconds of the command."""

    digests: dict[str, str]
    cpu_s: float


def drystone(source: Path, *arguments: str) -> bytes:
    """Run a command of one checkout and return what it prints; it may end with any documented code.

    Raises
    ------
    RuntimeError
        When it ends with a fault or bad usage.
    """
    environment = {**os.environ, "PYTHONPATH": str(source)}
    done = subprocess.run(  # noqa: S603 - the arguments are ours
        [sys.executable, "-m", "drystone", *arguments],
        env=environment,
        capture_output=True,
        check=False,
    )
    if done.returncode not in (0, 4, 5):
        raise RuntimeError(f"{arguments} ended with {done.returncode}: {done.stderr.decode()}")
    return done.stdout


def planned(
    source: Path, stones: Path, wall: str, scale: tuple[str, ...], method: str, seed: int
) -> Run:
    """Plan a wall, let it be judged, and return digests of all that came out."""
    budget = ("--budget", str(BUDGET)) if method == "best" else ()
    with tempfile.TemporaryDirectory() as folder:
        out = Path(folder) / "out"
        before = os.times()
        drystone(
            source, "plan", str(stones), "--wall", wall, *scale, "--method", method, *budget,
            "--seed", str(seed), "--jobs", "1", "--quiet", "-o", str(out),
        )  # fmt: skip
        after = os.times()
        said = {
            "plan.json": (out / "plan.json").read_bytes(),
            "measure": drystone(source, "measure", str(out), "--json"),
            "analyse": drystone(source, "analyse", str(out), "--json"),
            "check": drystone(source, "check", str(out), "--stones", str(stones), "--json"),
        }
    spent = after.children_user + after.children_system
    spent -= before.children_user + before.children_system
    # The folder has another name each time.
    plain = {name: text.replace(folder.encode(), b"") for name, text in said.items()}
    return Run({n: hashlib.sha256(text).hexdigest()[:16] for n, text in plain.items()}, spent)


def import_s(source: Path, *arguments: str) -> float:
    """Return the least wall-clock seconds of three starts of Python with some arguments."""
    environment = {**os.environ, "PYTHONPATH": str(source)}
    seconds = []
    for _ in range(3):
        began = time.perf_counter()
        command = [sys.executable, *arguments]
        subprocess.run(command, env=environment, capture_output=True, check=True)  # noqa: S603
        seconds.append(time.perf_counter() - began)
    return min(seconds)


def cases(folder: Path, only: list[str]) -> dict[str, tuple[Path, str, tuple[str, ...]]]:
    """Return stones, wall and scale by name; generated sets are made once, by this checkout."""
    found: dict[str, tuple[Path, str, tuple[str, ...]]] = {}
    for name, (file, wall, scale) in PUBLISHED.items():
        if (DATA / file).exists():
            found[name] = DATA / file, wall, ("--scale", scale)
    for kind, (wall, options) in GENERATED.items():
        stones = folder / f"{kind}.png"
        drystone(ROOT / "src", "generate", kind, *options, "--seed", "1", "-o", str(stones))
        found[kind] = stones, wall, ()
    return {name: case for name, case in found.items() if not only or name in only}


def main(arguments: argparse.Namespace) -> int:
    """Plan all walls and print; return 1 where bytes differ."""
    own, other, ratios, differ = ROOT / "src", arguments.against, [], 0
    with tempfile.TemporaryDirectory() as folder:
        for name, case in cases(Path(folder), arguments.only).items():
            for method in METHODS:
                for seed in SEEDS:
                    ours = planned(own, *case, method, seed)
                    line = f"{name} {method} seed {seed}: {ours.cpu_s:.1f} s"
                    if other is None:
                        say(f"{line} {json.dumps(ours.digests)}")
                        continue
                    theirs = planned(other, *case, method, seed)
                    ratios.append(ours.cpu_s / theirs.cpu_s)
                    changed = [n for n in ours.digests if ours.digests[n] != theirs.digests[n]]
                    differ += bool(changed)
                    said = "other bytes of " + ", ".join(changed) if changed else "same bytes"
                    say(f"{line}, {ratios[-1]:.2f} of the other's time, {said}")
    starts = {"import drystone": ("-c", "import drystone"), "--help": ("-m", "drystone", "--help")}
    for what, command in starts.items():
        other_s = "" if other is None else f", the other {import_s(other, *command):.2f} s"
        say(f"{what}: {import_s(own, *command):.2f} s{other_s}")
    if ratios:
        say(f"median of the times: {statistics.median(ratios):.2f}; {differ} plans differ")
    return int(differ > 0)


def say(line: str) -> None:
    """Print a line at once: the whole takes minutes."""
    sys.stdout.write(line + "\n")
    sys.stdout.flush()


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument(
        "--against", type=Path, metavar="SRC", help="src folder of another checkout"
    )
    parser.add_argument("--only", nargs="*", default=[], metavar="SET", help="sets to plan")
    sys.exit(main(parser.parse_args()))
