from pathlib import Path

import pytest
from PIL import Image

from drystone.statics.flow.nonassociative import NonassociativeResistance, NonassociativeResult
from drystone.statics.result import LimitStatus
from drystone_lab import shear
from drystone_lab.shear import GRAVITY, SERIES, Loading, ShearForces, run, shear_wall
from drystone_lab.table import BenchSettings

WITHOUT = "without dilatancy"

PAGE = Path(__file__).resolve().parents[2] / "docs" / "evidence" / "validation.md"


@pytest.fixture(scope="module")
def quick():
    """The first test of a series, both flow rules."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(shear, "SERIES", SERIES[:1])
        return [table.records() for table in run(BenchSettings(quick=True))]


@pytest.fixture(scope="module")
def tables():
    """Everything at one friction, without the slow answers without dilatancy."""
    with pytest.MonkeyPatch.context() as patch:
        sides = (NonassociativeResult(LimitStatus.FAILED, side) for side in ("left", "right"))
        nothing = NonassociativeResistance(*sides, shear.FRICTION)
        patch.setattr(shear, "FRICTION_BAND", (shear.FRICTION,))
        patch.setattr(shear, "nonassociative_resistance", lambda *_, **__: nothing)
        return [table.records() for table in run(BenchSettings())]


def weight_kn(series):
    volume = series.length * series.height * series.thickness
    return series.density_kg_m3 * volume * GRAVITY / 1e3


def test_a_level_beam_slides_and_a_turning_one_overturns_with_some_of_the_wall(quick, tables):
    """A level one by friction.  A turning one has no weight of its own, so its bounds are those of
    the beam alone, and of it and the whole wall about its toe.
    """
    by_name = {series.name: series for series in SERIES}
    for made, rule in ((tables, "associative"), (quick, "associative"), (quick, WITHOUT)):
        for row in made[0]:
            series, load = by_name[row["series"]], row["N kN"]
            arm = series.length / 2 / series.load_height
            assert row[f"beam level, {rule}"] == pytest.approx(0.62 * load, abs=0.051)
            assert row[f"beam turns, {rule}"] > load * arm + 0.5
            assert row[f"beam turns, {rule}"] <= (load + weight_kn(series)) * arm + 0.05
    for row in quick[0]:
        for beam in ("beam level", "beam turns"):
            assert row[f"{beam}, {WITHOUT}"] <= row[f"{beam}, associative"]


@pytest.mark.parametrize(("halves_first", "blocks", "lowest"), [(False, 49, 5), (True, 50, 6)])
def test_walls_are_in_running_bond_and_have_their_weight(halves_first, blocks, lowest):
    model, loads = shear_wall(SERIES[0], Loading(30.0, halves_first=halves_first))
    assert len(model.blocks) == blocks + 1
    assert [i.other for i in model.interfaces].count(0) == lowest
    assert model.blocks[-1].centroid[1] == pytest.approx(SERIES[0].load_height)
    assert -loads.dead[:-1, 1].sum() == pytest.approx(weight_kn(SERIES[0]))


def test_ratios_are_over_the_mean_of_both_sides_and_have_mean_and_scatter(tables):
    asked = (SERIES[2].name, 175.0)
    (predicted,) = [row for row in tables[0] if (row["series"], row["N kN"]) == asked]
    (test,) = [row for row in tables[1] if row["test"] == "WS2.175"]
    model = "beam turns, associative"
    assert test["measured kN"] == "64.5 / 71.3"
    assert test[model] == pytest.approx(predicted[model] / 67.9, abs=0.006)
    found = [row["beam turns, associative"] for row in tables[1] if row["test"].startswith("SW")]
    mean = sum(found) / 7
    deviation = (sum((ratio - mean) ** 2 for ratio in found) / 6) ** 0.5
    (row,) = [row for row in tables[2] if row["series"] == SERIES[0].name]
    printed = [float(word) for word in row["beam turns, associative"].split(" ± ")]
    assert printed == pytest.approx([mean, deviation], abs=0.011)
    # Answers that are missing stay out.
    for number, said in ((0, None), (1, None), (2, "-"), (3, "-")):
        assert {row["beam turns, without dilatancy"] for row in tables[number]} == {said}


def test_the_full_version_draws_and_varies_what_is_not_known(monkeypatch, tmp_path):
    asked = []

    def cheap(series, loading):
        asked.append((series.density_kg_m3, series.height, loading))
        return ShearForces(loading.mu * loading.vertical_kn, None)

    monkeypatch.setattr(shear, "predict", cheap)
    assert len(run(BenchSettings(output=tmp_path))) == 5
    with Image.open(tmp_path / "shear_tests.png") as picture:
        assert picture.width >= 800
    assert {loading.mu for *_, loading in asked} == {0.55, 0.62, 0.70}
    assert {loading.halves_first for *_, loading in asked} == {False, True}
    assert {density for density, *_ in asked} == {2000.0, 2400.0, 2650.0, 2800.0}
    assert len(asked) == len(set(asked))


def test_the_page_shows_these_numbers(quick, tables):
    lines = (line.strip("|").split("|") for line in PAGE.read_text("utf-8").splitlines())
    shown = {first.strip(): cells for first, *cells in lines}
    for row in (*tables[1], *quick[1]):
        for cell, model in zip(shown[row["test"]][2:], shear.MODELS, strict=True):
            if row[model] is not None:
                assert float(cell) == pytest.approx(row[model], abs=0.011)
