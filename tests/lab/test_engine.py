"""Walls on outlines in the engine: bricks slide where friction ends."""

from types import SimpleNamespace

import pytest

from drystone_lab import engine
from drystone_lab.engine import EngineWall
from drystone_lab.table import BenchSettings
from drystone_lab.walls import BRICKS


def test_bricks_stand_and_slide_at_their_friction():
    pytest.importorskip("pymunk", reason="pymunk is not installed (extra `physics`)")
    walls, summary = engine.run(BenchSettings(quick=True))
    (row,) = walls.records()
    assert (row["wall"], row["stones"], row["fallen"]) == ("bricks, seed 0", 9, "none")
    for name, most in (("moved most px", 0.1), ("turn deg", 0.1), ("overlap px", 0.01)):
        assert row[name] < most
    for side in ("left", "right"):
        assert row[f"alpha {side}"] == pytest.approx(0.58)
        assert row[f"tilt {side}"] == pytest.approx(0.58, abs=0.02)
    (record,) = summary.records()
    assert (record["walls"], record["nothing falls"], record["both sides"]) == (1, "1 of 1", 2)
    assert record["rank correlation"] is record["weaker side"] is None
    assert record["tilt / alpha"] == pytest.approx(1.0, abs=0.03)


def test_what_fell_or_never_falls_is_in_no_pair():
    judged = [
        EngineWall("wall", 9, SimpleNamespace(stands=tilts != (None, None)), alphas, tilts)
        for alphas, tilts in (
            ((0.1, 0.2), (0.2, 0.3)),
            ((0.3, 0.5), (0.35, 0.6)),
            ((0.4, 0.6), (0.3, None)),
            ((0.5, None), (None, None)),
            ((0.6, 0.55), (0.9, 0.7)),
        )
    ]
    (record,) = engine._summary(judged).records()
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
