from collections.abc import Iterator
from contextlib import contextmanager

import pytest

from drystone.errors import UsageError
from drystone_lab.runs import workers
from drystone_lab.runs.workers import work_of


@contextmanager
def named(*args: object) -> Iterator[object]:
    yield args


def test_options_name_who_works(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(workers, "processes_at_work", lambda jobs: named("processes", jobs))
    monkeypatch.setattr(workers, "cluster_at_work", lambda address: named("cluster", address))
    with work_of(3, None) as work:
        assert work == ("processes", 3)
    with work_of(None, "tcp://a:1") as work:
        assert work == ("cluster", "tcp://a:1")


@pytest.mark.parametrize(("jobs", "address"), [(1, "tcp://a:1"), (2, "tcp://a:1"), (0, None)])
def test_options_that_make_no_sense(jobs: int, address: str | None) -> None:
    with pytest.raises(UsageError) as caught, work_of(jobs, address):
        pass
    assert caught.value.code == "E138"
