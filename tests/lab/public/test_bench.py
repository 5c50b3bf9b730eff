"""Runs of the public benchmark, on bricks."""

from dataclasses import replace

import pytest

from drystone.errors import InputError
from drystone_lab.public import bench
from drystone_lab.public.store import Stamp, kept_runs
from drystone_lab.runs import workers
from drystone_lab.runs.outcome import execute, one_by_one
from drystone_lab.table import BenchSettings
from tests.lab.runs import bricks

STAMP = Stamp("1.0", "2026-01-01T00:00:00+00:00", "Linux x86_64")
SETTINGS = BenchSettings(policies=("paper", "random"), quick=True)


def run_public(settings, suite="bricks"):
    return bench.run_public(suite, settings, STAMP)


@pytest.fixture
def counted(monkeypatch):
    """How many runs were done."""
    done = []

    def work(specs, data):
        done.extend(specs)
        return one_by_one(specs, data)

    monkeypatch.setattr(workers, "one_by_one", work)
    return done


def figures(tables):
    return [table.records() for table in tables if not table.title.startswith("Seconds")]


def test_every_method_builds_every_wall_with_every_seed(counted):
    walls, everything, seconds, *_ = run_public(replace(SETTINGS, seed=3))
    found = [(row["wall"], row["method"], row["seeds"]) for row in walls.records()]
    assert found == [("bricks 2:1", "paper", 2), ("bricks 2:1", "random", 2)]
    assert {(spec.seed, dict(spec.changes).get("selection_rule")) for spec in counted} == {
        (3, None), (4, None), (3, "random"), (4, "random"),
    }  # fmt: skip
    # All bricks of the paper's method find their place.
    assert walls.records()[0]["placed share"] == 1.0
    assert all(row["s"] > 0 for row in seconds.records())
    assert len(everything.rows) == 2


def test_runs_of_a_store_are_not_done_again(tmp_path, counted):
    settings = replace(SETTINGS, store=tmp_path, seeds=1)
    before = figures(run_public(settings))
    for changed, count in (({}, 2), ({"seeds": 2}, 4), ({"again": True}, 6)):
        found = figures(run_public(replace(settings, **changed)))
        assert len(counted) == count
        assert (found == before) == ("seeds" not in changed)
    rows = kept_runs(tmp_path)
    runs = [("paper", 0), ("paper", 1), ("random", 0), ("random", 1)]
    assert [(row.method, row.seed) for row in rows] == runs
    assert {row.version for row in rows} == {"1.0"}
    assert len(list((tmp_path / "runs").iterdir())) == 4
    row = rows[0]
    assert (row.suite, row.suite_version, row.placed, row.shaken) == ("bricks", 1, 30, "no")
    run_public(replace(settings, policies=("paper",), changes=(("sampling", "full"),)))
    assert [row.settings for row in kept_runs(tmp_path)].count('{"sampling": "full"}') == 1


def test_walls_without_data_are_named():
    settings = replace(SETTINGS, only=("R", "bricks 2:1"), quick=False, seeds=1)
    tables = run_public(settings, "all")
    assert {row["wall"] for row in tables[0].records()} == {"bricks 2:1"}
    assert any("DIR): R." in note for note in tables[0].notes)
    with pytest.raises(InputError, match=r"^E100 almeida/PR.png, almeida/R.png, almeida/IR.png: "):
        run_public(replace(settings, only=()), "masons")


def test_a_damaged_store_is_found_before_the_runs(tmp_path, counted):
    (tmp_path / "runs.csv").write_text("this is not a table, and never was one")
    with pytest.raises(InputError, match="E401"):
        run_public(replace(SETTINGS, store=tmp_path))
    assert counted == []


def test_shaken_walls_are_shaken_once(tmp_path, monkeypatch):
    pytest.importorskip("pymunk", reason="pymunk is not installed (extra `physics`)")
    amplitudes = iter([None, 0.25])
    monkeypatch.setattr(bench, "pga_of", lambda *_: next(amplitudes))
    settings = replace(SETTINGS, policies=("paper",), store=tmp_path, shake=True)
    run_public(replace(settings, shake=False, seeds=1))  # of the two, one is kept already
    first = run_public(settings)[0]
    assert first.records()[0]["PGA, g"] == 0.25
    assert run_public(settings)[0] == first
    assert list(amplitudes) == []
    run_public(replace(settings, shake=False))
    found = [(run.shaken, run.pga_g) for run in kept_runs(tmp_path)]
    assert found == [("falls", None), ("yes", 0.25)]


def test_a_wall_of_bricks_on_the_table(monkeypatch):
    """What is shaken is the finished wall, in the paper's friction."""
    pytest.importorskip("pymunk", reason="pymunk is not installed (extra `physics`)")
    seen = []

    def shake(scene, _engine, *, watched):
        seen.append((scene, watched))
        return 0.3

    monkeypatch.setattr(bench, "shake_once", shake)
    spec = bricks.run(0)
    assert bench.pga_of(spec, execute(spec, None), None) == 0.3
    ((scene, watched),) = seen
    assert scene.mu == 0.58
    assert watched == frozenset(range(1, 7)) == frozenset(scene.shapes)
    assert all(shape.area == pytest.approx(200) for shape in scene.shapes.values())
