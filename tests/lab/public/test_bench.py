import sys
from dataclasses import replace
from importlib.metadata import version
from itertools import product
from unittest.mock import Mock

import pytest

from drystone.errors import InputError, UsageError
from drystone_lab import packing
from drystone_lab.public import bench
from drystone_lab.public.store import kept_runs
from drystone_lab.public.suites import method_named, walls_of
from drystone_lab.public.tables import history_table, medians_of
from drystone_lab.runs import workers
from drystone_lab.runs.outcome import FIGURES, execute, one_by_one
from drystone_lab.table import BenchSettings
from tests.lab.runs import bricks

SETTINGS = BenchSettings(policies=("paper", "random"), quick=True)


def run_public(settings, suite="bricks"):
    return bench.run_public(suite, settings, "2026-01-01T00:00:00+00:00")


@pytest.fixture
def counted(monkeypatch):
    """How many runs were done."""
    done = []

    def work(specs, data):
        done.extend(specs)
        return one_by_one(specs, data)

    monkeypatch.setattr(workers, "one_by_one", work)
    return done


def test_every_method_builds_with_every_seed_and_kept_runs_are_not_done_again(tmp_path, counted):
    settings = replace(SETTINGS, store=tmp_path, seeds=1, seed=3)
    walls, everything, _, *others = run_public(settings)
    before = [walls, everything, *others]
    for changed, count in (({}, 2), ({"seeds": None}, 4), ({"again": True}, 6)):
        walls, everything, seconds, *others = run_public(replace(settings, **changed))
        assert len(counted) == count
        assert ([walls, everything, *others] == before) == ("seeds" not in changed)
        told = [(row["wall"], row["method"], row["seeds"]) for row in walls.records()]
        each = 2 if "seeds" in changed else 1
        assert told == [("bricks 2:1", "paper", each), ("bricks 2:1", "random", each)]
        # All bricks of the paper's method find their place.
        assert walls.records()[0]["placed share"] == 1.0
        assert (len(everything.rows), all(row["s"] > 0 for row in seconds.records())) == (2, True)
    rules = {(spec.seed, dict(spec.changes).get("selection_rule")) for spec in counted}
    assert rules == set(product((3, 4), (None, "random")))
    rows = kept_runs(tmp_path)
    assert [(row.method, row.seed) for row in rows] == [*product(("paper", "random"), (3, 4))]
    assert {row.version for row in rows} == {version("drystone")}
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
    shake = Mock(return_value=0.3)
    monkeypatch.setattr(bench, "shake_once", shake)
    spec = bricks.run(0)
    assert bench.pga_of(spec, execute(spec, None), None) == 0.3
    (scene, _), options = shake.call_args
    assert scene.mu == 0.58
    assert options == {"watched": frozenset(range(1, 7))}
    assert set(scene.shapes) == set(range(1, 7))
    assert all(shape.area == pytest.approx(200) for shape in scene.shapes.values())


def packing_into(monkeypatch, width):
    """Pack everything into a strip of a width; return what is asked for it."""
    packed = Mock(return_value=width)
    monkeypatch.setattr(packing, "load_packer", lambda: None)
    monkeypatch.setattr(bench, "load_packer", lambda: None)
    monkeypatch.setattr(packing, "packed_width_px", packed)
    return packed


@pytest.mark.parametrize(("strip", "over"), [(300.0, 300.0), (60.0, 120.0)])
def test_it_fills_a_strip_as_high_as_the_wall(monkeypatch, strip, over):
    packed, wall = packing_into(monkeypatch, strip), walls_of("bricks")[0]
    method, changes = method_named("spyrrow")
    outcome = execute(wall.run(3, *changes, method=method), None)
    stones = wall.source.stones(None)
    _, given, *asked = packed.call_args.args
    assert (len(given), asked) == (len(stones), [84, (0.0, 90.0, 180.0, 270.0), 3, 3])
    # A strip that is shorter than the wall leaves the rest of the wall empty.
    area = sum(int(stone.mask.sum()) for stone in stones)
    assert outcome.figures["F_SF"] == pytest.approx(area / (over * 84))
    assert {k for k, v in outcome.figures.items() if v is None} == {*FIGURES} - {"F_SF", "stones"}


def test_it_is_in_tables_but_in_no_pairs(monkeypatch, tmp_path):
    packing_into(monkeypatch, 150.0)
    policies = ("paper", "spyrrow", "lowest")
    settings = BenchSettings(policies=policies, quick=True, seeds=1, store=tmp_path)
    walls, everything, seconds, *others = run_public(settings)
    for table, column in ((walls, 1), (everything, 0), (seconds, 1)):
        assert "spyrrow" in [row[column] for row in table.rows]
    (row,) = (row for row in walls.rows if row[1] == "spyrrow")
    assert [cell for cell in row[3:] if cell is not None] == [row[6], row[8]]
    assert any(note.startswith("spyrrow is a yardstick") for note in walls.notes)
    assert not any("spyrrow" in row for table in others for row in table.rows)
    kept = {run.method: run for run in kept_runs(tmp_path)}
    assert (kept["spyrrow"].F_LR, kept["spyrrow"].F_SF) == (None, pytest.approx(row[6], abs=1e-4))
    # It builds no wall, so a history of it has no share of the stones, not 0.
    history = history_table(medians_of(kept.values())).records()
    shares = {row["method"]: row["placed share"] for row in history}
    assert shares["spyrrow"] is None
    assert shares["paper"] > 0.5
    # What is kept is not packed again.
    monkeypatch.setattr(packing, "packed_width_px", None)
    assert run_public(settings)[0].rows == walls.rows


def test_what_is_missing_is_said_before_anything_is_done(monkeypatch):
    monkeypatch.setitem(sys.modules, "spyrrow", None)
    monkeypatch.setattr(bench, "work_of", None)
    with pytest.raises(UsageError, match="E305"):
        run_public(BenchSettings(policies=("paper", "spyrrow")))
