"""Walls on outlines in the engine: bricks slide where friction ends."""

from types import SimpleNamespace

import pytest

from drystone_lab import engine
from drystone_lab.engine import EngineWall
from drystone_lab.table import BenchSettings
from drystone_lab.walls import BRICKS

NO_ENGINE = "pymunk is not installed (extra `physics`)"


def judged(alphas, tilts, *, stands=True):
    built = SimpleNamespace(stands=stands)
    return EngineWall("wall", 9, built, alphas, tilts)


def test_bricks_stand_and_slide_at_their_friction():
    pytest.importorskip("pymunk", reason=NO_ENGINE)
    walls, summary = engine.run(BenchSettings(quick=True))
    (row,) = walls.records()
    assert (row["wall"], row["stones"]) == ("bricks, seed 0", 9)
    assert row["fallen"] == "none"
    assert row["moved most px"] < 0.1
    assert row["turn deg"] < 0.1
    assert row["overlap px"] < 0.01
    for side in ("left", "right"):
        assert row[f"alpha {side}"] == pytest.approx(0.58)
        assert row[f"tilt {side}"] == pytest.approx(0.58, abs=0.02)
    (record,) = summary.records()
    assert (record["walls"], record["nothing falls"], record["both sides"]) == (1, "1 of 1", 2)
    assert record["rank correlation"] is record["weaker side"] is None
    assert record["tilt / alpha"] == pytest.approx(1.0, abs=0.03)


def test_what_fell_or_never_falls_is_in_no_pair():
    (record,) = engine._summary(
        [
            judged((0.1, 0.2), (0.2, 0.3)),
            judged((0.3, 0.5), (0.35, 0.6)),
            judged((0.4, 0.6), (0.3, None)),
            judged((0.5, None), (None, None), stands=False),
            judged((0.6, 0.55), (0.9, 0.7)),
        ]
    ).records()
    assert (record["walls"], record["nothing falls"], record["both sides"]) == (5, "4 of 5", 7)
    # Alphas .1 .2 .3 .4 .5 .55 .6 and tilts .2 .3 .35 .3 .6 .7 .9: ranks 1 2.5 4 2.5 5 6 7.
    assert record["rank correlation"] == pytest.approx(0.93697, abs=1e-5)
    assert record["weaker side"] == pytest.approx(1.0)  # (.1, .2), (.3, .35), (.55, .7)
    # Ratios .75 1.17 1.2 1.27 1.5 1.5 2.
    assert record["tilt / alpha"] == pytest.approx(0.7 / 0.55)


def test_a_wall_that_does_not_rest_is_not_tilted(monkeypatch):
    monkeypatch.setattr(engine, "build_up", lambda *_: None)
    monkeypatch.setattr(engine, "tilt_of", lambda _: None)
    assert engine._judged(BRICKS, BRICKS.stones(None), 0).tilts == (None, None)
