"""Single passes on outlines, and what becomes of them on finer outlines."""

from types import SimpleNamespace

import pytest

from drystone_lab import passes
from drystone_lab.exact_walls import BuiltWall, Target, one_pass
from drystone_lab.table import BenchSettings
from tests.verify.exact_examples import WALL_PX, exact_example, with_stone

BY_HAND = exact_example()
TARGET = Target("by hand", lambda _: BY_HAND.stones, *WALL_PX, 1.0)


def built(wall, mu=0.58):
    result = SimpleNamespace(wall=wall, plan=SimpleNamespace(settings={"mu": mu}))
    return BuiltWall(TARGET, "exact", 1, BY_HAND.stones, result)


def test_bricks_are_laid_in_every_way():
    (table,) = passes.run(BenchSettings(quick=True))
    assert [row["passes"] for row in table.records()] == [
        "bricks, best", "bricks, without look-ahead", "bricks, --settle pivot"
    ]  # fmt: skip
    for row in table.records():
        assert (row["all placed"], row["placed"]) == ("2 of 2", 9)
        for name in ("F_SF", "F_LR .05 px", ".1 px", ".25 px", "F_LR"):
            assert row[name] == pytest.approx(1.0, abs=1e-3)
        assert (row["wedges"], row["relaid at .1 px: lost"]) == (0, 0)


def test_ways_change_only_what_they_say():
    best = one_pass("exact").as_dict()
    changed = [
        {
            (room, name)
            for room, values in way.change(one_pass("exact")).as_dict().items()
            if isinstance(values, dict)
            for name in values
            if values[name] != best[room][name]
        }
        for way in passes.WAYS
    ]
    assert changed == [set(), {("score", "analysed"), ("score", "llc")}, {("settle", "method")}]


def test_a_wall_that_rests_is_laid_again_with_its_wedge():
    lost, resistance = passes.relay(built(exact_example(count=3).wall))
    assert lost == 0
    assert resistance == pytest.approx(passes._resistance(built(exact_example(count=3).wall), 0.1))


def test_what_hangs_in_the_air_is_lost_and_the_others_carry_on():
    wall = with_stone(exact_example(count=2).wall, BY_HAND.stones, (300, 0.0), (65.0, 18.0))
    lost, resistance = passes.relay(built(wall))
    assert lost == 1
    assert resistance == pytest.approx(1.0)
    assert passes._resistance(built(wall), 0.1) == 0.0  # with it nothing stands


def test_what_counts_as_contact_is_up_to_the_tolerance():
    wall = with_stone(exact_example(count=1).wall, BY_HAND.stones, (5, 0.0), (40.0, 0.07))
    assert passes._resistance(built(wall), 0.05) == 0.0
    assert passes._resistance(built(wall), 0.1) == pytest.approx(1.0)


def test_the_friction_is_that_of_the_plan():
    wall = exact_example(count=1).wall  # 20 x 20 px, set back by .2: topples at .98
    assert passes._resistance(built(wall, 0.8), 0.1) == pytest.approx(1.0)
    assert passes._resistance(built(wall, 2.0), 0.1) == pytest.approx(0.49)
    assert passes.relay(built(wall, 2.0))[1] == pytest.approx(0.49)
