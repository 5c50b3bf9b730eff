import gc
import sys
import threading
import time
from importlib.metadata import PackageNotFoundError, version
from unittest.mock import Mock

import pytest

from drystone.errors import DrystoneError, UsageError
from drystone_lab.runs.outcome import Runner, one_by_one
from drystone_lab.runs.spec import RunSpec, published
from drystone_lab.runs.workers import check_versions, cluster_at_work, execute_there
from tests.lab.runs.bricks import NOT_SIX, SOURCE, deadly, kept, picture, run

distributed = pytest.importorskip("distributed", reason="the extra `dask` is not installed")

QUIET = {
    "threads_per_worker": 1,
    "dashboard_address": None,
    # None leaves a web server at a port that others may have.
    "scheduler_kwargs": {"dashboard_address": ":0"},
    "silence_logs": "CRITICAL",
}


@pytest.fixture(scope="module")
def cluster(tmp_path_factory):
    """Two workers, processes of their own; those that die are started again."""
    folder = str(tmp_path_factory.mktemp("dask"))
    with distributed.LocalCluster(
        n_workers=2, processes=True, local_directory=folder, **QUIET
    ) as cluster:
        yield cluster


@pytest.fixture
def work(cluster):
    with cluster_at_work(cluster.scheduler_address, patience_s=60) as work:
        yield work


@pytest.fixture
def thread():
    """A cluster with one worker, a thread of this process."""
    with distributed.LocalCluster(n_workers=1, processes=False, **QUIET) as cluster:
        yield cluster


def test_outcomes_are_the_same_bytes_whoever_works(work, tmp_path):
    picture(tmp_path / "data" / "set" / "bricks.png")
    specs = [run(1), run(3, published("set/bricks.png")), run(4)]

    def kept_by(name, work):
        """Keep outcomes, and read their bytes up to the times, which are last."""
        Runner(tmp_path / name, data=tmp_path / "data", work=work).run(specs)
        files = {path.name: path.read_bytes() for path in (tmp_path / name).iterdir()}
        return {file: read.partition(b', "times": {')[:2] for file, read in files.items()}

    one = kept_by("one", one_by_one)
    assert set(one) == {f"{spec.key}.json" for spec in specs}
    assert all(times for _, times in one.values())
    assert kept_by("dask", work) == one


def test_a_killed_worker_loses_nothing(work, tmp_path):
    once = tmp_path / "died"
    specs = [run(1), run(2), deadly(3, once), run(4), run(5), run(6)]
    outcomes = Runner(tmp_path / "store", work=work).run(specs)
    assert once.exists()
    assert outcomes[2].plan == next(one_by_one([run(3)], None)).plan
    assert [outcome.key for outcome in outcomes] == [spec.key for spec in specs]


def test_a_run_that_kills_workers_is_given_up(work, cluster, tmp_path, monkeypatch):
    monkeypatch.setattr(cluster.scheduler, "allowed_failures", 0)
    with pytest.raises(DrystoneError, match=f"^E402 {deadly(1)}: "):
        Runner(tmp_path, work=work).run([deadly(1)])


def test_a_run_that_fails_is_told(thread, tmp_path):
    with cluster_at_work(thread.scheduler_address) as work:
        with pytest.raises(DrystoneError, match="E130"):
            Runner(tmp_path, work=work).run([run(1), run(2, NOT_SIX)])
        assert list(work([], None)) == []
        assert Runner(tmp_path, work=work).run([run(3)])
    assert kept(tmp_path, run(1))
    assert not kept(tmp_path, run(2, NOT_SIX))


def test_what_ended_is_given_before_an_interrupt(work):
    specs = [run(1), run(2), run(3)]
    outcomes = work(specs, None)
    keys = [next(outcomes).key]
    others = outcomes.gi_frame.f_locals["asked"].values()
    until = time.monotonic() + 60
    while {future.status for future in others} != {"finished"}:
        assert time.monotonic() < until
        time.sleep(0.01)
    keys += [outcomes.throw(KeyboardInterrupt).key, next(outcomes).key]
    with pytest.raises(KeyboardInterrupt):
        next(outcomes)
    assert sorted(keys) == sorted(spec.key for spec in specs)


def test_a_cluster_that_goes_away(thread, tmp_path):
    specs = [run(seed) for seed in range(100)]
    with (
        cluster_at_work(thread.scheduler_address, patience_s=2.0) as work,
        pytest.raises(DrystoneError, match=r"E404 .*lost"),
    ):
        Runner(tmp_path, work=work, say=lambda _: thread.close()).run(specs)
    assert 1 <= sum(kept(tmp_path, spec) for spec in specs) < len(specs)


class Newer(RunSpec):
    """A run that has another key on the worker, which is a thread."""

    @property
    def key(self):
        return super().key if threading.current_thread() is threading.main_thread() else "newer"


def test_a_worker_of_another_version_that_came_later(thread):
    spec = Newer(source=SOURCE, width=60, height=20)
    at_work = cluster_at_work(thread.scheduler_address)
    with at_work as work, pytest.raises(UsageError, match="E405"):
        next(work([spec], None))


def test_published_stones_where_the_worker_has_them(tmp_path, monkeypatch):
    spec = run(1, published("bricks.png"))
    picture(tmp_path / "six" / "bricks.png", count=6)
    picture(tmp_path / "five" / "bricks.png", count=5)
    monkeypatch.setenv("DRYSTONE_DATA", str(tmp_path / "five"))
    assert execute_there(spec, tmp_path / "six").figures["stones"] == 6
    assert execute_there(spec, tmp_path / "elsewhere").figures["stones"] == 5
    monkeypatch.delenv("DRYSTONE_DATA")
    with pytest.raises(DrystoneError, match=r"E100 .*elsewhere"):
        execute_there(spec, tmp_path / "elsewhere")


HERE = version("drystone")


@pytest.mark.parametrize(
    ("scheduler", "workers", "said"),
    [
        (HERE, {"a": None, "b": "0.0.1"}, "and none at a, 0.0.1 at b."),
        (None, {"a": HERE}, "and none at scheduler."),
    ],
)
def test_other_versions(scheduler, workers, said):
    client, none = Mock(), PackageNotFoundError("drystone")
    client.run.return_value = {at: one or none for at, one in workers.items()}
    client.run_on_scheduler.side_effect = [scheduler or none]
    with pytest.raises(UsageError, match=f"E405 .*drystone is {HERE} here, {said}"):
        check_versions(client)
    client.run.assert_called_once_with(version, "drystone", on_error="return")
    client.run_on_scheduler.assert_called_once_with(version, "drystone")


def refused(address, said, patience_s=2.0):
    with pytest.raises(UsageError, match=said), cluster_at_work(address, patience_s=patience_s):
        pass


def test_nobody_answers_there_are_no_workers_or_there_is_no_dask(monkeypatch):
    for address in ("tcp://127.0.0.1:9", "nonsense://here"):
        refused(address, f"E404.*{address}", 0.3)
    gc.collect()  # lets go of the clients now: while another begins, their end would wait for that
    with distributed.LocalCluster(n_workers=0, processes=False, **QUIET) as cluster:
        refused(cluster.scheduler_address, r"E404 .*has no workers")
    monkeypatch.setitem(sys.modules, "distributed", None)
    refused("tcp://127.0.0.1:9", r"E403 .*drystone\[dask\]")
