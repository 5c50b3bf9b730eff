"""Tests."""

import json
from dataclasses import replace

import numpy as np
import pytest

from drystone.errors import DrystoneError
from drystone.planner.planner import Planner
from drystone.search.plan_wall import plan_wall
from drystone_lab.runs.outcome import FIGURES, Runner, RunStore, execute, one_by_one
from tests.lab.runs.bricks import SOURCE, kept, run


def test_it_is_what_plan_wall_gives():
    outcome = execute(run(3), None)
    stones, rest = SOURCE.stones(None), {"seed": 3, "method": "paper", "scale": 1.0}
    result = plan_wall(stones, 60, 20, **rest, coulomb=False)
    assert outcome.as_plan == result.plan
    assert result.metrics.F_LR_coulomb is None
    assert plan_wall(stones, 60, 20, **rest).metrics.F_LR_coulomb is not None
    assert tuple(outcome.figures) == FIGURES
    assert outcome.figures["placed"] == outcome.figures["stones"] == 6
    assert outcome.figures["F_LR"] == result.metrics.F_LR
    assert outcome.figures["wedges"] == 0
    assert outcome.key == run(3).key
    # The wall is built again from its plan.
    wall = outcome.wall(run(3), None)
    assert set(np.unique(wall.labels)) - {0} == set(outcome.clusters)
    assert np.count_nonzero(wall.labels) / wall.labels.size == outcome.figures["F_SF"]


def test_the_image_is_the_wall_when_no_size_is_given():
    spec = replace(run(1), width=0.0, height=0.0)
    source = spec.source.stones(None).source
    assert execute(spec, None).plan["wall"] == {
        "width": source.width_px,
        "height": source.height_px,
    }


def test_an_interrupted_wall_is_no_outcome(monkeypatch):
    def interrupted(_):
        raise KeyboardInterrupt
        yield

    monkeypatch.setattr(Planner, "steps", interrupted)
    with pytest.raises(KeyboardInterrupt):
        execute(run(1), None)


class Book:
    """Does runs one by one, and writes down which."""

    def __init__(self, interrupt_after=None):
        self.done = []
        self.interrupt_after = interrupt_after

    def __call__(self, specs, data):
        for spec in specs:
            if len(self.done) == self.interrupt_after:
                raise KeyboardInterrupt
            yield from one_by_one([spec], data)
            self.done.append(spec.seed)


def test_outcomes_are_in_the_order_of_the_runs(tmp_path):
    def backwards(specs, data):
        yield from one_by_one(specs[::-1], data)

    specs = [run(3), run(1), run(2)]
    said = []
    outcomes = Runner(RunStore(tmp_path), work=backwards, say=said.append).run(specs)
    assert [outcome.key for outcome in outcomes] == [spec.key for spec in specs]
    assert [line.split(",")[0] for line in said] == [f"{k} of 3 walls" for k in (1, 2, 3)]


def test_equal_runs_are_done_once_and_a_second_time_nothing_is_done(tmp_path):
    book = Book()
    runner = Runner(RunStore(tmp_path), work=book)
    first = runner.run([run(1), run(2), run(1)])
    assert first[0] is first[2]
    again = runner.run([run(1), run(2), run(1)])
    assert book.done == [1, 2]
    assert [(one.plan, one.times) for one in again] == [(one.plan, one.times) for one in first]


def test_what_ended_before_an_interrupt_is_kept(tmp_path):
    specs, store = [run(1), run(2), run(3)], RunStore(tmp_path)
    with pytest.raises(KeyboardInterrupt):
        Runner(store, work=Book(interrupt_after=2)).run(specs)
    assert [kept(store, spec) for spec in specs] == [True, True, False]
    later = Book()
    assert len(Runner(store, work=later).run(specs)) == 3
    assert later.done == [3]


def test_runs_that_nobody_did_are_missed(tmp_path):
    with pytest.raises(RuntimeError, match="lost"):
        Runner(RunStore(tmp_path), work=lambda _specs, _data: iter(())).run([run(1)])


@pytest.fixture(scope="module")
def outcome():
    return execute(run(1), None)


def test_what_was_kept_is_found(tmp_path, outcome):
    store = RunStore(tmp_path / "new" / "folder")
    assert store.get(outcome.key) is None
    store.put(outcome)
    found = RunStore(store.folder).get(outcome.key)
    assert found.key == outcome.key
    assert (found.figures, found.times) == (outcome.figures, outcome.times)
    assert found.plan == outcome.plan
    assert store.get(run(2).key) is None


def without(text, *names):
    data = json.loads(text)
    part = data
    for name in names[:-1]:
        part = part[name]
    del part[names[-1]]
    return json.dumps(data)


@pytest.mark.parametrize(
    "damage",
    [
        lambda text: text[: len(text) // 2],
        lambda _: "null",
        lambda _: '{"figures": 1, "plan": 2, "times": 3}',
        lambda text: "\udcff" + text,
        lambda text: without(text, "plan", "steps"),
        lambda text: without(text, "times", "wall"),
        lambda text: without(text, "figures", "F_LR"),
    ],
)
def test_a_damaged_file_is_named_with_the_cure(tmp_path, outcome, damage):
    store = RunStore(tmp_path)
    store.put(outcome)
    (path,) = tmp_path.iterdir()
    path.write_text(damage(path.read_text("utf-8")), "utf-8", errors="surrogateescape")
    with pytest.raises(DrystoneError, match=f"^E401 {path}: .*Delete the file"):
        store.get(outcome.key)
