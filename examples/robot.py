"""Walk-through of a robot researcher: from a picture of stones to poses, and a live loop.

python examples/robot.py            # small stone set and budget
python examples/robot.py --full     # as somebody would plan
"""

import argparse
import json
import shutil
import tempfile
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
from walk import Walk

import drystone as ds
from drystone.planner.events import Step
from drystone.planner.measured import MeasuredPose

PX_PER_M = 200


@dataclass
class Robot:
    """A robot that is not quite exact, with a camera that sees what it did.

    Parameters
    ----------
    noise_m, noise_deg : float
        Standard deviation of where it puts stones down.
    seed : int
        Of the noise.
    """

    noise_m: float = 0.005
    noise_deg: float = 1.0
    seed: int = 0
    wall: dict[int, MeasuredPose] = field(default_factory=dict)

    def place(self, step: Step) -> None:
        """Put a stone down at the pose of a step."""
        rng = np.random.default_rng([self.seed, step.stone_id])
        pose = step.pose3d
        angle = np.degrees(np.arctan2(pose.xaxis[2], pose.xaxis[0]))
        # It lies on others, not in them.
        up = abs(rng.normal(0.0, self.noise_m))
        self.wall[step.stone_id] = MeasuredPose(
            pose.x_m + rng.normal(0.0, self.noise_m),
            pose.z_m + up,
            angle + rng.normal(0.0, self.noise_deg),
        )

    def look(self) -> dict[int, MeasuredPose]:
        """Measure the wall."""
        return dict(self.wall)


def live_loop(stones_path: Path, width_m: float, height_m: float) -> None:
    """Plan a stone, place it, measure the wall, plan the next one from there."""
    stones = ds.read_stones(stones_path)
    site = ds.Site.from_source(
        width_m * PX_PER_M, height_m * PX_PER_M, ds.working_scale(stones), PX_PER_M
    )
    settings = ds.method_settings("best").updated({"search": {"budget": 1}})
    planner, robot = ds.Planner(stones, site, seed=1, settings=settings), Robot()
    for step in planner.steps():
        robot.place(step)
        seen = planner.observe(robot.look())
        last = seen.deviations[-1]
        print(
            f"   stone {step.stone_id:2d}  x {step.pose3d.x_m:.3f} m  z {step.pose3d.z_m:.3f} m  "
            f"off by {last.shift_px / PX_PER_M * 1000:4.1f} mm {last.angle_deg:+.1f} deg  "
            f"{'stands' if seen.stands else 'does not stand'}"
        )
        if step.number == 5 and not planner.settings.ban:
            del robot.wall[step.stone_id]
            gone = planner.observe(robot.look(), lost=[step.stone_id])
            print(f"   stone {step.stone_id} broke: planned on without it (lost: {gone.lost})")
    assert planner.stopped is not None
    print(f"   {len(planner.build.actions)} stones, {planner.stopped.text}")


def walk(folder: Path, *, full: bool) -> Walk:
    """Do all steps in a folder."""
    count, width, height = (32, 1.4, 0.4) if full else (10, 0.7, 0.25)
    size = [f"width_px={width * PX_PER_M:.0f}", f"height_px={height * PX_PER_M:.0f}"]
    courses = [] if full else ["--set", "courses=3"]
    one = Walk(folder)
    one.drystone(
        "generate", "rubble", "-o", "stones.png", "--count", count,
        *(word for value in size for word in ("--set", value)), *courses,
    )  # fmt: skip
    budget = [] if full else ["--budget", 2]
    wall = ["--px-per-m", PX_PER_M, "--wall", f"{width}mx{height}m", "--seed", 1]
    one.drystone("plan", "stones.png", *wall, *budget, "-o", "out/", codes=(0, 4))
    one.drystone("export", "out/plan.json", "--to", "poses", "compas", "moveit", "obj", "urdf")
    if shutil.which("jq"):
        print("(or: jq '.steps[0].centroid' out/plan.json)")
    one.python('import json; print(json.load(open("out/plan.json"))["steps"][0]["centroid"])')
    poses = json.loads((folder / "out" / "poses.json").read_text(encoding="utf-8"))
    print(f"   poses.json: {json.dumps(poses)[:300]} ...\n")
    print("# the live loop: plan, place, measure, plan on")
    with one.timed("live loop in Python"):
        live_loop(folder / "stones.png", width, height)
    banned = 12 if full else 5
    one.drystone(
        "plan", "stones.png", *wall, *budget, "--from", "out/plan.json", "--ban", banned,
        "-o", "without/", codes=(0, 4),
    )  # fmt: skip
    one.summary()
    return one


def main() -> None:
    """Read the options."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--full", action="store_true", help="32 stones, searched for")
    parser.add_argument("-o", "--output", metavar="DIR", help="keep the files there")
    options = parser.parse_args()
    if options.output:
        Path(options.output).mkdir(parents=True)
        walk(Path(options.output), full=options.full)
        return
    with tempfile.TemporaryDirectory() as folder:
        walk(Path(folder), full=options.full)


if __name__ == "__main__":
    main()
