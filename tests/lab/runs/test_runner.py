from collections.abc import Iterator, Sequence
from pathlib import Path

import pytest

from drystone_lab.runs.outcome import Runner, RunOutcome, RunStore, one_by_one
from drystone_lab.runs.spec import RunSpec
from tests.lab.runs.bricks import kept, run


class Book:
    """Does runs one by one, and writes down which."""

    def __init__(self, interrupt_after: int | None = None) -> None:
        self.done: list[int] = []
        self.interrupt_after = interrupt_after

    def __call__(self, specs: Sequence[RunSpec], data: Path | None) -> Iterator[RunOutcome]:
        for spec in specs:
            if len(self.done) == self.interrupt_after:
                raise KeyboardInterrupt
            yield from one_by_one([spec], data)
            self.done.append(spec.seed)


def test_outcomes_are_in_the_order_of_the_runs(tmp_path: Path) -> None:
    def backwards(specs: Sequence[RunSpec], data: Path | None) -> Iterator[RunOutcome]:
        yield from one_by_one(specs[::-1], data)

    specs = [run(3), run(1), run(2)]
    said: list[str] = []
    outcomes = Runner(RunStore(tmp_path), work=backwards, say=said.append).run(specs)
    assert [outcome.key for outcome in outcomes] == [spec.key for spec in specs]
    assert [line.split(",")[0] for line in said] == [f"{k} of 3 walls" for k in (1, 2, 3)]


def test_a_second_time_nothing_is_done(tmp_path: Path) -> None:
    book = Book()
    runner = Runner(RunStore(tmp_path), work=book)
    first = runner.run([run(1), run(2)])
    again = runner.run([run(2), run(1)])
    assert book.done == [1, 2]
    assert [one.plan for one in again] == [one.plan for one in reversed(first)]
    assert [one.times for one in again] == [one.times for one in reversed(first)]


def test_equal_runs_are_done_once(tmp_path: Path) -> None:
    book = Book()
    outcomes = Runner(RunStore(tmp_path), work=book).run([run(1), run(2), run(1)])
    assert book.done == [1, 2]
    assert outcomes[0] is outcomes[2]


def test_what_ended_before_an_interrupt_is_kept(tmp_path: Path) -> None:
    specs, store = [run(1), run(2), run(3)], RunStore(tmp_path)
    with pytest.raises(KeyboardInterrupt):
        Runner(store, work=Book(interrupt_after=2)).run(specs)
    assert [kept(store, spec) for spec in specs] == [True, True, False]
    later = Book()
    assert len(Runner(store, work=later).run(specs)) == 3
    assert later.done == [3]


def test_runs_that_nobody_did_are_missed(tmp_path: Path) -> None:
    with pytest.raises(RuntimeError, match="lost"):
        Runner(RunStore(tmp_path), work=lambda _specs, _data: iter(())).run([run(1)])
