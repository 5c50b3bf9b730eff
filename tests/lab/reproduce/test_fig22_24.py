"""Walls over the noise: their tables recomputed, and what is said of them."""

from collections.abc import Mapping
from statistics import median

import pytest

from drystone_lab.reproduce import fig22_24
from drystone_lab.reproduce.fig22_24 import make
from drystone_lab.reproduce.noise_claims import findings
from drystone_lab.reproduce.noise_sets import Reference, generated_set, noise_set
from drystone_lab.reproduce.noise_walls import (
    Level,
    built_levels,
    is_full,
    reference_table,
    residuals,
    trends,
)
from tests.lab.reproduce.made_outcomes import outcome
from tests.lab.reproduce.small_walls import context, gids, rows

SETS = {noise: generated_set(noise, 6, 0.1) for noise in (20, 80)}


@pytest.fixture(scope="module")
def output(tmp_path_factory):
    return make(context(tmp_path_factory.mktemp("noise")), SETS, 2)


def level(noise: int, random: float = 0.5, reference: Reference | None = None, **figures) -> Level:
    """A level of made walls: a value or a list of values for each figure."""
    lists = {name: v if isinstance(v, list) else [v] for name, v in figures.items()}
    ours = tuple(
        outcome(**dict(zip(lists, values, strict=True)))
        for values in zip(*lists.values(), strict=True)
    )
    others = (outcome(F_SF=random, F_LR=random),)
    return Level(noise_set(noise), {}, {"paper": ours, "random": others}, reference)


def said(levels: list[Level], word: str) -> Mapping[str, object]:
    """The finding whose claim has a word."""
    (found,) = [one for one in findings(levels) if word in one.claim]
    return vars(found)


def test_every_set_has_a_wall_of_either_rule_for_every_seed(output):
    walls = rows(output, "walls")
    keys = [(row["noise, %"], row["rule"], row["seed"]) for row in walls]
    assert keys == [(n, r, s) for n in (20, 80) for r in ("paper", "random") for s in (1, 2)]
    assert {row["stones"] for row in walls} == {"generated"}
    assert {row["of"] for row in walls} == {6}
    assert len(output.runs) == 8
    for run in output.runs:
        assert run.settings().two_sided
    rules = [run.settings().selection_rule for run in output.runs]
    assert rules == 2 * (["algorithm2"] * 2 + ["random"] * 2)


def test_levels_are_the_medians_of_their_walls(output):
    walls = rows(output, "walls")
    for row in rows(output, "levels"):
        mine = [w for w in walls if (w["noise, %"], w["rule"]) == (row["noise, %"], row["rule"])]
        for name in ("placed", "F_SF", "F_AV"):
            assert row[f"{name} median"] == pytest.approx(median(w[name] for w in mine), abs=1e-4)
    for row in walls:
        assert row["F_SF above 0.6"] is (row["F_SF"] > 0.6)


def test_the_filling_of_a_wall_is_the_area_of_its_stones_over_it(tmp_path):
    (noisy,) = built_levels(context(tmp_path), {80: SETS[80]}, [1])
    spec, out = noisy.example
    areas = {stone.id: stone.area_px for stone in SETS[80].source.stones(None)}
    placed = sum(areas[i] for i in out.clusters)
    assert out.figures["F_SF"] == pytest.approx(placed / (spec.width * spec.height), rel=0.01)


def test_pictures_show_every_set(output):
    names = [picture.name for picture in output.pictures]
    assert names == ["fig22", "fig23", "fig24"]
    titles = [ax.get_title(loc="left") for ax in output.pictures[0].figure.axes]
    assert [title.split("\n")[0] for title in titles] == [w.name for w in SETS.values()]
    assert {"group-20 % gen.", "group-80 % gen.", "example-20"} <= {*gids(output, "fig23")}
    ax = output.pictures[2].figure.axes[0]
    drawn = sum(len(line.get_xdata()) for line in ax.lines if "F_SF" in str(line.get_gid()))
    assert drawn == 4
    assert [tick.get_text() for tick in ax.get_xticklabels()] == ["20*", "80*"]


def test_filling_that_falls_agrees_and_one_that_rises_does_not():
    falling = [level(n, F_SF=1 - n / 100, F_AV=n, F_LR=0.2, F_AH=1) for n in range(10, 90, 10)]
    rising = [level(n, F_SF=n / 100, F_AV=-n, F_LR=n / 10, F_AH=n) for n in range(10, 90, 10)]
    assert said(falling, "Filling falls")["holds"] is True
    assert said(rising, "Filling falls")["holds"] is False
    assert said(falling, "Interlocking")["holds"] is True
    assert said(rising, "Interlocking")["holds"] is False
    assert said(rising, "Lateral resistance")["holds"] is False
    assert said(falling, "most difficult")["holds"] is False  # of filling only
    # A trend of the five published sets that the three generated ones break up.
    mixed = {10: 1, 20: 2, 30: 9, 40: 3, 50: 4, 60: 0.5, 70: 5, 80: 0.2}
    broken = [level(n, F_SF=1, F_LR=value) for n, value in mixed.items()]
    for one, noise in ((2, 30), (5, 60), (7, 80)):
        wall = generated_set(noise, 6, 0.1)
        broken[one] = Level(wall, {}, broken[one].outcomes, None)
    assert said(broken, "Lateral resistance")["holds"] is None
    flat = [level(n, F_SF=1, F_LR=v) for n, v in zip(mixed, (3, 1, 4, 2, 5, 0, 4, 3), strict=True)]
    assert said(flat, "Lateral resistance")["holds"] is True
    # F_LR is always the same, so there is nothing to rank.
    assert said(falling, "Lateral resistance")["holds"] is None


def test_one_wall_of_low_noise_below_the_threshold_is_not_always():
    walls = [level(10, F_SF=[0.7, 0.61], F_LR=[1, 1]), level(70, F_SF=[0.5, 0.4], F_LR=[1, 1])]
    assert said(walls, "always above")["holds"] is True
    mixed = level(60, F_SF=0.5, F_LR=1)
    assert said([walls[0], mixed], "always above")["holds"] is True
    worse = [level(10, F_SF=[0.7, 0.6], F_LR=[1, 1]), walls[1]]
    found = said(worse, "always above")
    assert found["holds"] is False
    assert "1 of 2 walls below 60 %" in str(found["found"])
    assert not is_full(outcome(F_SF=0.6))


def test_the_hardest_set_has_the_lowest_filling_and_resistance():
    walls = [level(10, F_SF=0.7, F_LR=0.5), level(80, F_SF=0.5, F_LR=0.4)]
    assert said(walls, "most difficult")["holds"] is True
    assert said([walls[0], level(80, F_SF=0.5, F_LR=0.6)], "most difficult")["holds"] is False
    assert said([walls[0], level(70, F_SF=0.5, F_LR=0.4)], "most difficult")["holds"] is None


def test_the_surprise_is_the_level_above_its_neighbours():
    walls = [level(n, F_SF=f, F_LR=1) for n, f in ((10, 0.8), (20, 0.6), (40, 0.75), (50, 0.6))]
    above = residuals(walls)
    assert above == pytest.approx({10: 0.2, 20: -0.175, 40: 0.15, 50: -0.15})
    # 10 % is 0.2 above its one neighbour, as any first level is when filling falls.
    words = str(said(walls, "surprisingly")["found"])
    assert "of 40 % less that of the levels beside it is +0.150" in words


def test_a_trend_of_the_reference_walls_is_a_claim_of_its_own():
    def built(value):
        return Reference(23, 0.7, value, 5.0, (None, 0.1, 0.2, 0.3))

    def claim(values):
        walls = [
            level(n, F_SF=0.7, F_LR=1, F_AV=n, reference=built(value))
            for n, value in zip((10, 20, 40, 50, 70), values, strict=True)
        ]
        return said(walls, "F_AV of the reference")["holds"]

    assert claim([1.0, 2.0, 3.0, 4.0, 5.0]) is True
    assert claim([5.0, 4.0, 3.0, 2.0, 1.0]) is False
    assert claim([1.0, 3.0, 5.0, 4.0, 2.0]) is None  # rho .3, of five


def test_the_random_choice_and_the_reference_are_compared_by_medians():
    walls = [level(n, F_SF=[0.6, 0.8, 0.7], F_LR=[1, 1, 1], random=0.65) for n in (10, 20)]
    assert said(walls, "random")["holds"] is True
    walls[1] = level(20, F_SF=0.7, F_LR=1, random=0.71)
    assert said(walls, "random")["holds"] is False
    assert said(walls, "filled as much")["holds"] is None
    built = Reference(23, 0.7, 10.0, 5.0, (None, 0.1, 0.2, 0.3))
    same = [level(20, F_SF=0.69996, F_LR=1, reference=built)]
    assert said(same, "filled as much")["holds"] is True
    assert said([level(20, F_SF=0.6, F_LR=1, reference=built)], "filled as")["holds"] is False
    (row,) = reference_table(same).records()
    assert row["F_LR, no gap closed"] is None
    assert row["F_LR, gaps closed x1"] == 0.2


def test_trends_over_sets_use_a_median_each_and_published_ones_leave_generated_out():
    walls = [level(n, F_SF=[n / 100, 0.9]) for n in range(10, 90, 10)]
    each = trends(walls, "F_SF")
    assert each["walls"].count == 16
    assert each["sets"].count == 8
    assert each["sets"].rho == 1
    assert each["published"].count == 5


def test_published_sets_are_what_the_item_needs():
    assert fig22_24.ITEM.needs == tuple(f"thangavelu/noise_{n}.png" for n in (10, 20, 40, 50, 70))
