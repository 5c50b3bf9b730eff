"""The fuzzer finds every kind of defect in files that were valid before; readers have none."""

import io
import json
import subprocess
import sys
from contextlib import suppress
from pathlib import Path
from random import Random

import pytest
from fuzz.driver import Source, pixels_of, place
from fuzz.formats import FORMATS
from fuzz.walls import plans
from PIL import Image

from drystone.errors import DrystoneError
from tests.fuzz.planted import OUTSIDE, PLANTED

ROOT = Path(__file__).parents[2]
EACH = 10
"""Executions of a planted format in a round."""


def run(*words, module="tests.fuzz.planted"):
    """Run the fuzzer in a process of its own, as its children are forked."""
    return subprocess.run(  # noqa: S603 - our own code
        [sys.executable, "-m", module, *map(str, words)],
        check=False, capture_output=True, text=True, cwd=ROOT,
    )  # fmt: skip


@pytest.fixture(scope="module")
def found():
    """All faults by format, of which each execution is limited to .3 s."""
    ran = run("--seed", 14, "--count", EACH * len(PLANTED), "--cpu", 0.3, "--wall", 6, "--json")
    assert ran.returncode == 1, ran.stderr
    report = json.loads(ran.stdout)
    assert report["executions"] == dict.fromkeys((one.name for one in PLANTED), EACH)
    assert not OUTSIDE.exists()  # what is found is kept from happening
    # Nothing is found where nothing is.
    assert not {"fine", "refuses", "writes_within"} & {one["format"] for one in report["faults"]}
    return report["faults"]


KINDS = {
    "raises": "LookupError", "leaves": "SystemExit", "backtracks": "time", "waits": "stuck",
    "eats": "memory", "eats_quietly": "memory", "dies": "crash SIGSEGV", "prints": "output",
    "warns": "warning", "logs": "log", "starts": "process", "writes": "write", "removes": "write",
    "unpickles": "pickle", "connects": "network",
}  # fmt: skip
ELSEWHERE = {
    "backtracks": "re/__init__.py match", "prints": "stderr", "writes": "pathlib.py open",
    "starts": "subprocess.py _execute_child", "removes": "pathlib.py unlink",
    "connects": "socket.py getaddrinfo",
}  # fmt: skip
"""Where the defects are that lie in libraries."""


@pytest.mark.parametrize("name", KINDS)
def test_planted_defects_are_found(found, name):
    (fault,) = [fault for fault in found if fault["format"] == name]
    assert fault["kind"] == KINDS[name]
    assert ELSEWHERE.get(name, f"planted.py {name}") in fault["where"]
    assert 1 <= len(fault["numbers"]) < EACH


def files_in(folder):
    files = [path for path in folder.rglob("*") if path.is_file()]
    return {path.relative_to(folder): path.read_bytes() for path in files}


def test_jobs_change_nothing_and_files_come_back(tmp_path):
    formats = ("--seed", 14, "--formats", "raises", "prints")
    one, two = (
        run(*formats, "--count", 40, "--json", "--jobs", jobs, "--keep", tmp_path / f"{jobs}")
        for jobs in (1, 2)
    )
    assert json.loads(one.stdout)["faults"] == json.loads(two.stdout)["faults"]
    kept = files_in(tmp_path / "1")
    assert kept == files_in(tmp_path / "2")
    name = next(path.parent.name for path in kept if path.name != "faults.txt")
    kind, _, number = name.split("-")
    run(*formats, "--write", f"{kind}:{number}", "--keep", tmp_path / "again")
    again = {Path(name) / path: data for path, data in files_in(tmp_path / "again").items()}
    assert again == {path: data for path, data in kept.items() if path.parent.name == name}


def test_pixels_are_those_of_the_header():
    for kind in ("PNG", "GIF", "BMP"):
        Image.new("L", (70, 30)).save(data := io.BytesIO(), kind)
        case = {"a": data.getvalue(), "b": b"of nothing that has pixels, and long"}
        assert pixels_of(case) == 2100


@pytest.mark.parametrize("one", FORMATS, ids=lambda one: one.name)
def test_most_valid_files_are_read(one, tmp_path):
    """All but those that are there to be refused; with any of the settings, so some say no."""
    read, seeds = 0, one.seeds()
    assert seeds == one.seeds()
    for case in seeds:
        path = place(case, tmp_path / "case")
        for draw in range(12):
            with suppress(DrystoneError):
                one.run(path.parent if one.folder else path, Random(draw))
                read += 1
                break
    assert read >= len(seeds) / 2


def test_plans_have_all_that_is_read_of_them():
    raster, exact = plans()
    assert {"plan.json", "wall.png", "stones.png", "settings.toml", "photo.jpg"} <= raster.keys()
    assert exact.keys() - raster.keys() == {"blocks.json"}
    for case in (raster, exact):
        assert b'"kind": "wedge"' in case["plan.json"]


def test_an_execution_depends_on_its_number_and_the_seed_alone():
    some = [one for one in FORMATS if one.name in ("png", "coco", "dxf")]
    one, same, other = Source(some, 5), Source(some[::-1], 5), Source(some, 6)
    cases = [one.case("png", number)[0] for number in range(40)]
    assert cases == [same.case("png", number)[0] for number in range(40)]
    assert cases != [other.case("png", number)[0] for number in range(40)]


SEED, EXECUTIONS = 20261125, 2_290
"""Always the same files, by number and not by time; `make fuzz` draws others.

A third of a round: of the guards of readers that were removed, a whole round missed no more.
"""


@pytest.mark.fuzz
@pytest.mark.timeout(1200)
def test_damaged_files_of_all_formats(tmp_path):
    words = ("--seed", SEED, "--count", EXECUTIONS, "--jobs", 1, "--keep", tmp_path)
    ran = run(*words, module="fuzz")
    assert ran.returncode == 0, f"{ran.stdout}{ran.stderr}"
    assert f"{EXECUTIONS:,}" in ran.stdout
