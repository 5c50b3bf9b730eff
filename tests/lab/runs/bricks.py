import os
import signal
from dataclasses import dataclass
from pathlib import Path

from drystone.generate import lay_out
from drystone.io.wall_image import write_labels
from drystone_lab.runs.outcome import Runner
from drystone_lab.runs.spec import RunSpec, generated
from tests.planner import scenes

SOURCE = generated("brick", 1, count=6, height_px=10, aspect=2)
NOT_SIX = generated("brick", 1, count=-6)
"""Bricks that no generator makes: E130."""


def run(seed, source=SOURCE):
    """Return a run of a few hundredths of a second."""
    return RunSpec(source=source, width=60, height=20, seed=seed)


@dataclass(frozen=True, kw_only=True)
class Deadly(RunSpec):
    """A run at which its process dies: every time, or once when a file can be made."""

    once: str = ""

    def settings(self):
        if self.once and Path(self.once).exists():
            return super().settings()
        if self.once:
            Path(self.once).touch()
        os.kill(os.getpid(), signal.SIGKILL)
        raise AssertionError("still alive")


def deadly(seed, once=None):
    return Deadly(source=SOURCE, width=60, height=20, seed=seed, once=str(once or ""))


def picture(path, count=6):
    """Write bricks as a label image."""
    path.parent.mkdir(parents=True, exist_ok=True)
    write_labels(lay_out(scenes.bricks(count)), path)
    return path


def kept(folder, spec):
    return Runner(folder).kept(spec.key) is not None
