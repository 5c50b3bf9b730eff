"""Fourier stones: numbers of stones, kinds, and comparisons of fixed with varied sizes."""

from statistics import mean, median

import pytest

from drystone_lab.reproduce.fig26_27 import KINDS, Kind, findings, make
from drystone_lab.runs.spec import RunSpec
from tests.lab.reproduce.made_outcomes import outcome
from tests.lab.reproduce.small_walls import context, rows

SMALL = (Kind(0.0, 10.0, 10.0), Kind(0.0, 5.0, 15.0))


@pytest.mark.parametrize("kind", KINDS, ids=lambda kind: kind.name)
def test_the_expected_area_is_that_of_the_stones(kind):
    areas = [
        stone.mask.sum()
        for seed in range(4)
        for stone in kind.run(seed, 1000, 1.0).source.stones(None)
    ]
    # 300 stones or more a seed; the areas of varied ones scatter by two thirds of their mean.
    assert mean(areas) == pytest.approx(kind.mean_area_px, rel=0.08 if kind.varied else 0.01)


def test_a_wall_has_stones_of_so_many_times_its_area():
    run = KINDS[0].run(3, 210, 2.0)
    assert dict(run.source.settings)["count"] == 32  # 2 * 210^2 / 2831.8 = 31.1
    assert (run.width, run.height, run.scale, run.seed) == (210, 210, 1.0, 3)
    assert run.source.seed == 3
    assert run.settings().two_sided
    assert [kind.varied for kind in KINDS] == [False, True, False, True]
    assert KINDS[3].name == "elliptic, radius 10 to 50 px"


def test_walls_of_every_kind_and_ratio_are_summed_up(tmp_path):
    output = make(context(tmp_path), SMALL, 2, 60, (2.0, 1.1))
    walls = rows(output, "walls")
    assert len(walls) == len(output.runs) == 8
    for row in rows(output, "kinds"):
        mine = [w["F_SF"] for w in walls
                if (w["kind"], w["area of stones / wall"])
                == (row["kind"], row["area of stones / wall"])]  # fmt: skip
        assert row["F_SF median"] == pytest.approx(median(mine), abs=1e-4)
    assert [p.name for p in output.pictures] == ["fig26", "fig27"]
    assert len(output.pictures[0].figure.axes) == 2
    assert any("With 1.1 times" in words for words in output.ours)
    assert "after we had seen the walls of both 2 and 1.1 times" in output.ours[0]
    # Two walls of a kind tell nothing with any number of stones.
    assert "the verdicts are the same" in output.ours[-1]


def walls(*values):
    spec = RunSpec(source=KINDS[0].run(1, 60, 1.0).source)
    return tuple((spec, outcome(F_SF=v, F_AV=v)) for v in values)


def test_varied_sizes_are_compared_with_fixed_ones_of_their_shape():
    low, high = walls(0.1, 0.2, 0.3, 0.4, 0.5), walls(0.6, 0.7, 0.8, 0.9, 1.0)
    better = findings(dict(zip(KINDS, (low, high, high, low), strict=True)))
    assert [one.holds for one in better] == [True, False, True, False]
    # All 25 pairs are won: U = 25, mean 12.5, deviation sqrt(25 * 11 / 12), with half a pair less.
    assert "p 0.0061" in better[0].found
    assert "0.3 for a fixed size and 0.8 for varied" in better[0].found


def test_few_walls_or_one_size_tell_nothing():
    few = findings(dict(zip(KINDS[:2], (walls(0.1), walls(0.9)), strict=True)))
    assert [one.holds for one in few] == [None, None]
    assert findings({KINDS[0]: walls(0.1)}) == ()
