"""A few kills at moments that matter; ``python -m tests.kills`` does many, at random ones."""

import signal
from functools import partial

import pytest

from tests.kills.harness import Case, called, killed, lost, made_stones, plan_bytes

pytestmark = pytest.mark.skipif(not hasattr(signal, "SIGKILL"), reason="no such signals here")


SMALL = "[search]\npasses = 3\nchains = 2\nshare_every = 2\n"
"""A search that soon comes to its chains."""


@pytest.fixture(scope="module")
def stones(tmp_path_factory):
    return made_stones(tmp_path_factory.mktemp("stones") / "few.png", 8, 100, 36, 2)


@pytest.mark.parametrize(
    ("options", "sent", "pause", "group"),
    [
        (("--method", "paper"), "INT", "stone 3", True),
        (("--budget", "13"), "TERM", "wall 2", False),
        (("--budget", "13", "--jobs", "2"), "KILL", "wall 7", False),
    ],
)
def test_nothing_runs_on_and_nothing_is_lost(options, sent, pause, group, stones, tmp_path):
    settings = tmp_path / "small.toml"
    settings.write_text(SMALL)
    plan = ("plan", str(stones), "--wall", "100x36", "--scale", "1", "-o", "{folder}", *options)
    small = ("--settings", str(settings)) if "paper" not in options else ()
    case = Case(sent, (*plan, *small), ("--resume",), plan_bytes, stones, pause)
    folder = tmp_path / "killed"
    one = killed(case, sent, folder, partial(case.waits, folder), group=group)
    assert one.faults == []
    assert one.code == {"INT": 130, "TERM": 143, "KILL": -9}[sent]
    assert (folder / "plan.json").exists()
    assert called(case.told(tmp_path / "whole"))[0] in (0, 4)
    assert list(lost(case, folder, plan_bytes(tmp_path / "whole"))) == []
