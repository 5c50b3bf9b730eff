"""A few kills at moments that matter; ``python -m tests.kills`` does many, at random ones."""

import signal
from functools import partial

import pytest

from tests.kills.harness import Case, called, killed, lost, made_stones, plan_bytes

pytestmark = pytest.mark.skipif(not hasattr(signal, "SIGKILL"), reason="no such signals here")


@pytest.fixture(scope="module")
def place(tmp_path_factory):
    """A folder with stones and settings, in which whole walls stay."""
    place = tmp_path_factory.mktemp("kills")
    made_stones(place / "few.png", 6, 70, 30, 2)
    # A search that soon comes to its chains, and does not rehearse
    search = "[search]\npasses = 3\nchains = 2\nshare_every = 2\n"
    (place / "small.toml").write_text(f"{search}[settle]\ntrials = 0\n[goal]\nfallen = 0\n")
    return place


@pytest.mark.parametrize(
    ("way", "jobs", "sent", "pause", "group"),
    [
        ("--method paper", "", "INT", "stone 3", True),
        ("--settings {small} --budget 6", "", "TERM", "wall 2", False),
        ("--settings {small} --budget 6", " --jobs 2", "KILL", "wall 5", False),
    ],
)
def test_nothing_runs_on_and_nothing_is_lost(way, jobs, sent, pause, group, place):
    stones, folder, whole = place / "few.png", place / sent, place / way.split()[-1]
    said = f"plan {stones} --wall 70x30 --scale 1 -o {{folder}} {way}{jobs}"
    words = tuple(said.replace("{small}", str(place / "small.toml")).split())
    case = Case(sent, words, ("--jobs", "1", "--resume"), plan_bytes, stones, pause)
    one = killed(case, sent, folder, partial(case.waits, folder), group=group)
    assert one.faults == []
    assert one.code == {"INT": 130, "TERM": 143, "KILL": -9}[sent]
    assert (folder / "plan.json").exists()
    if not whole.exists():  # the number of jobs does not shape it
        assert called(case.told(whole, "--jobs", "1"))[0] in (0, 4)
    assert list(lost(case, folder, plan_bytes(whole))) == []
