"""The fuzzer finds every kind of defect, names its place and goes on; readers have none."""

import io
import json
import subprocess
import sys
from pathlib import Path

import pytest
from fuzz.driver import pixels_of
from PIL import Image

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


@pytest.mark.parametrize(
    ("name", "kind", "where"),
    [
        ("raises", "LookupError", "planted.py raises"),
        ("leaves", "SystemExit", "planted.py leaves"),
        ("spins", "time", "planted.py spins"),
        ("backtracks", "time", "re/__init__.py match"),
        ("waits", "stuck", "planted.py waits"),
        ("eats", "memory", "planted.py eats"),
        ("eats_quietly", "memory", "planted.py eats_quietly"),
        ("dies", "crash SIGSEGV", "planted.py dies"),
        ("prints", "output", "stderr"),
        ("warns", "warning", "planted.py warns"),
        ("logs", "log", "planted.py logs"),
        ("starts", "process", "subprocess.py _execute_child"),
        ("hides", "process", "subprocess.py _execute_child"),
        ("writes", "write", "pathlib.py open"),
        ("removes", "write", "pathlib.py unlink"),
        ("unpickles", "pickle", "planted.py unpickles"),
        ("connects", "network", "socket.py getaddrinfo"),
    ],
)
def test_planted_defects_are_found(found, name, kind, where):
    (fault,) = [fault for fault in found if fault["format"] == name]
    assert fault["kind"] == kind
    assert where in fault["where"]
    assert 1 <= len(fault["numbers"]) < EACH


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


def files_in(folder):
    """Contents by name of all files in a folder."""
    files = [path for path in folder.rglob("*") if path.is_file()]
    return {path.relative_to(folder): path.read_bytes() for path in files}


@pytest.mark.parametrize("kind", ["PNG", "GIF", "BMP"])
def test_pixels_are_those_of_the_header(kind):
    data = io.BytesIO()
    Image.new("L", (70, 30)).save(data, kind)
    assert pixels_of({"a": data.getvalue(), "b": b"of nothing that has pixels, and long"}) == 2100


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
