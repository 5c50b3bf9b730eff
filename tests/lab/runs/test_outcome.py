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
    assert tuple(execute(spec, None).plan["wall"].values()) == (source.width_px, source.height_px)


def test_an_interrupted_wall_is_no_outcome(monkeypatch):
    def interrupted(_):
        raise KeyboardInterrupt
        yield

    monkeypatch.setattr(Planner, "steps", interrupted)
    with pytest.raises(KeyboardInterrupt):
        execute(run(1), None)


def booked(done, stop=None):
    """Do runs one by one, write down which, and be interrupted after some."""

    def work(specs, data):
        for spec in specs:
            if len(done) == stop:
                raise KeyboardInterrupt
            yield from one_by_one([spec], data)
            done.append(spec.seed)

    return work


def test_outcomes_are_in_the_order_of_the_runs(tmp_path):
    specs, said = [run(3), run(1), run(2)], []
    backwards = Runner(
        RunStore(tmp_path),
        work=lambda specs, data: one_by_one(specs[::-1], data),
        say=said.append,
    )
    assert [outcome.key for outcome in backwards.run(specs)] == [spec.key for spec in specs]
    assert [line.split(",")[0] for line in said] == [f"{k} of 3 walls" for k in (1, 2, 3)]


def test_equal_runs_are_done_once_and_a_second_time_nothing_is_done(tmp_path):
    done = []
    runner = Runner(RunStore(tmp_path), work=booked(done))
    first, again = (runner.run([run(1), run(2), run(1)]) for _ in range(2))
    assert first[0] is first[2]
    assert done == [1, 2]
    assert [(one.plan, one.times) for one in again] == [(one.plan, one.times) for one in first]


def test_what_ended_before_an_interrupt_is_kept(tmp_path):
    specs, store, later = [run(1), run(2), run(3)], RunStore(tmp_path), []
    with pytest.raises(KeyboardInterrupt):
        Runner(store, work=booked([], stop=2)).run(specs)
    assert [kept(store, spec) for spec in specs] == [True, True, False]
    assert len(Runner(store, work=booked(later)).run(specs)) == 3
    assert later == [3]


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
    assert vars(RunStore(store.folder).get(outcome.key)) == vars(outcome)
    assert store.get(run(2).key) is None


def without(part, name):
    """What takes a name out of a part of a file."""

    def damage(text):
        data = json.loads(text)
        del data[part][name]
        return json.dumps(data)

    return damage


@pytest.mark.parametrize(
    "damage",
    [
        lambda text: text[: len(text) // 2],
        lambda _: "null",
        lambda _: '{"figures": 1, "plan": 2, "times": 3}',
        lambda text: "\udcff" + text,
        without("plan", "steps"),
        without("times", "wall"),
        without("figures", "F_LR"),
    ],
)
def test_a_damaged_file_is_named_with_the_cure(tmp_path, outcome, damage):
    store = RunStore(tmp_path)
    store.put(outcome)
    (path,) = tmp_path.iterdir()
    path.write_text(damage(path.read_text("utf-8")), "utf-8", errors="surrogateescape")
    with pytest.raises(DrystoneError, match=f"^E401 {path}: .*Delete the file"):
        store.get(outcome.key)
