"""Walk-through of a researcher of algorithms: bench, a policy of one's own, an environment.

python examples/researcher.py            # a few walls
python examples/researcher.py --full     # the masons' stones, twenty seeds
"""

import argparse
import os
import shutil
import sys
import tempfile
import tomllib
from pathlib import Path

import numpy as np
from walk import Walk

import drystone as ds

HERE = Path(__file__).resolve().parent


def installed(folder: Path) -> Path:
    """Put the policy where Python finds it with its entry point; `pip install` does the same."""
    place = folder / "site"
    shutil.copytree(HERE / "own_policy", place)
    project = tomllib.loads((place / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    about = place / f"{project['name']}-{project['version']}.dist-info"
    about.mkdir()
    (about / "METADATA").write_text(
        f"Metadata-Version: 2.1\nName: {project['name']}\nVersion: {project['version']}\n",
        encoding="utf-8",
    )
    group = project["entry-points"]["drystone.policies"]
    lines = ["[drystone.policies]", *(f"{name} = {value}" for name, value in group.items())]
    (about / "entry_points.txt").write_text("\n".join(lines) + "\n", encoding="utf-8")
    return place


def by_its_name() -> None:
    """Plan with the policy from Python."""
    size = ds.generate.RubbleSettings(count=8, width_px=100, height_px=36, courses=2)
    stones = ds.generate.rubble_stones(size, np.random.default_rng(1))
    settings = ds.method_settings("paper").updated({"selection_rule": "mine"})
    result = ds.plan_wall(stones, 100, 36, settings=settings, scale=1.0)
    print(f"   {len(result.plan.stone_steps)} stones, F_SF {result.metrics.F_SF:.3f}")


def one_episode() -> None:
    """Play one wall of the environment, choosing any legal action."""
    import gymnasium  # noqa: PLC0415 - an extra

    env = gymnasium.make("drystone_lab.rl:drystone/Wall-v0")
    _, info = env.reset(seed=1)
    rng, total, steps, ended = np.random.default_rng(0), 0.0, 0, False
    while not ended:
        legal = np.flatnonzero(env.unwrapped.action_masks())  # type: ignore[attr-defined]
        if not legal.size:
            break
        _, reward, terminated, truncated, info = env.step(int(rng.choice(legal)))
        total, steps, ended = total + float(reward), steps + 1, terminated or truncated
    print(f"   {steps} actions, return {total:.3f}, info: {', '.join(info)}")


def walk(folder: Path, *, full: bool) -> Walk:
    """Do all steps in a folder."""
    place = installed(folder)
    known = filter(None, (str(place), os.environ.get("PYTHONPATH")))
    one = Walk(folder, {"PYTHONPATH": os.pathsep.join(known)})
    one.drystone("bench", "--list", lines=80)
    suite = ["--suite", "masons"] if full else ["--suite", "bricks", "--only", "bricks 2:1"]
    seeds = 20 if full else 1
    policies = ["paper", "random", "filter", "spyrrow", "mine"]
    bench = ["bench", *suite, "--policy", *policies, "--seeds", seeds, "--jobs", 2]
    one.drystone(*bench, "--store", "runs", lines=18)
    print(f"   in runs/: {', '.join(sorted(path.name for path in (folder / 'runs').iterdir()))}\n")
    print("# the same policy from Python")
    sys.path.insert(0, str(place))
    with one.timed("plan_wall with the policy"):
        by_its_name()
    sys.path.remove(str(place))
    print("# one episode of drystone/Wall-v0")
    with one.timed("one episode"):
        one_episode()
    quick = [] if full else ["--quick"]
    one.drystone("reproduce", "table2" if full else "figB34", *quick, "-o", "paper", lines=12)
    one.summary()
    return one


def main() -> None:
    """Read the options."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--full", action="store_true", help="the masons' stones, twenty seeds")
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        walk(Path(folder), full=options.full)


if __name__ == "__main__":
    main()
