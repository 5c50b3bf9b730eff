"""Run the command line in process, on small stone sets."""

import json
import re
import shutil
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

import pytest

from drystone.cli import main
from drystone.cli.commands import craft
from drystone.drawing.canvas import save
from drystone.drawing.export import frames
from drystone.drawing.pictures import mechanism


@dataclass(frozen=True)
class Ran:
    """What a command returned and printed."""

    code: int
    out: str
    err: str

    def json(self):
        """The one JSON object on stdout; NaN and infinities are none."""
        return json.loads(self.out, parse_constant=pytest.fail)

    def refused(self, *said, exit_code=2):
        """Nothing was printed but an error, in which there are a code or some words."""
        assert (self.code, self.out) == (exit_code, ""), self.err
        for words in said:
            assert words in self.err


def listed(command):
    """Names in the row of a command in docs/plan-format.md; options and values are none."""
    page = (Path(__file__).parents[2] / "docs" / "plan-format.md").read_text("utf-8")
    (row,) = re.findall(rf"^\| `{command} --json`.*$", page, re.MULTILINE)
    names = {*re.findall(r"`(\w+)`", row.split("|", 2)[2])}
    return names - {"raster", "exact", "null", "answers"}


def keys(report, *within):
    """Names at the top of what `--json` prints, and in some of the objects."""
    return set(report).union(*(report[name] for name in within))


@contextmanager
def coarse(dpi=80):
    """Draw with fewer px and fewer frames: what is in a picture, and where it goes, is the same."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(save, "__defaults__", (dpi,))
        patch.setattr(craft, "SHEET_DPI", dpi)
        patch.setattr(craft, "SINGLE_DPI", dpi)
        patch.setattr(frames, "FINER", 1)
        patch.setattr(frames.Film.__init__, "__defaults__", (240,))
        patch.setattr(mechanism, "LONGER_SIDE_PX", 160)
        patch.setitem(mechanism.mechanism_frames.__kwdefaults__, "frames", 4)
        yield


@pytest.fixture(autouse=True)
def _coarse():
    with coarse():
        yield


@pytest.fixture
def run(capsys):
    def call(*arguments):
        capsys.readouterr()
        try:
            code = main([str(argument) for argument in arguments])
        except SystemExit as stopped:
            code = int(stopped.code or 0)
        return Ran(code, *capsys.readouterr())

    return call


def contents(folder):
    """The files of a folder, by name."""
    return {path.name: path.read_bytes() for path in folder.iterdir() if path.is_file()}


def rewrite(path, tamper):
    content = json.loads(path.read_text(encoding="utf-8"))
    tamper(content)
    path.write_text(json.dumps(content), encoding="utf-8")


def _generated(tmp_path_factory, kind, *sizes):
    path = tmp_path_factory.mktemp("stones") / f"{kind}.png"
    words = [word for size in sizes for word in ("--set", size)]
    assert main(["generate", kind, "-o", str(path), "--count", "6", "--seed", "1", *words]) == 0
    return path


@pytest.fixture(scope="session")
def rubble(tmp_path_factory):
    """Six stones of two courses for a wall of 70 x 30 px."""
    return _generated(tmp_path_factory, "rubble", "width_px=70", "height_px=30", "courses=2")


@pytest.fixture(scope="session")
def bricks(tmp_path_factory):
    """Six bricks of 20 x 10 px."""
    return _generated(tmp_path_factory, "brick", "height_px=10", "aspect=2")


SIZE = "70x30"
"""Of a wall for the rubble, px."""

WALL = ("--wall", SIZE, "--scale", "1", "--method", "paper")
"""A wall for the rubble, planned quickly."""


def plan_into(tmp_path_factory, stones, *wall):
    folder = tmp_path_factory.mktemp("plans") / "plan"
    with coarse():
        assert main(["plan", str(stones), *wall, "-o", str(folder), "--seed", "1"]) in (0, 4)
    return folder


@pytest.fixture(scope="session")
def finished(rubble, tmp_path_factory):
    """The folder of a plan of the rubble; not to be changed."""
    return plan_into(tmp_path_factory, rubble, *WALL)


@pytest.fixture(scope="session")
def standing(bricks, tmp_path_factory):
    """A whole wall that stands in the engine too, the stones beside it; not to be changed."""
    folder = plan_into(tmp_path_factory, bricks, "--wall", "60x20", *WALL[2:])
    shutil.copy(bricks, folder)
    return folder


@pytest.fixture
def plan_copy(finished, rubble, tmp_path):
    """A plan in a folder of its own, the stones beside it, to be tampered with."""
    folder = shutil.copytree(finished, tmp_path / "copy")
    shutil.copy(rubble, folder)
    return folder


EXACT = ("--wall", SIZE, "--scale", "1", "--budget", "1")
"""A wall for the rubble by one pass of `best`, which plans on outlines."""

UNTRIED = ("--set", "settle.trials=0", "--set", "goal.fallen=0")
"""Settings of `best` for tests that the errors of a builder are nothing to."""


@pytest.fixture(scope="session")
def settled(rubble, tmp_path_factory):
    """The folder of a plan of the rubble on outlines; not to be changed."""
    return plan_into(tmp_path_factory, rubble, *EXACT)


@pytest.fixture(scope="session")
def metric(rubble, tmp_path_factory):
    """The same plan in metres, of 200 px each; not to be changed."""
    wall = ("--wall", "0.35mx15cm", "--px-per-m", "200", *EXACT[2:])
    return plan_into(tmp_path_factory, rubble, *wall)


@pytest.fixture
def settled_copy(settled, rubble, tmp_path):
    """A plan on outlines in a folder of its own, the stones beside it, to be tampered with."""
    folder = shutil.copytree(settled, tmp_path / "settled")
    shutil.copy(rubble, folder)
    return folder
