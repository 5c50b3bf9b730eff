from pathlib import Path

import pytest
from PIL import Image

from drystone.statics.flow.nonassociative import (
    NonassociativeResistance,
    NonassociativeResult,
)
from drystone.statics.limit import lateral_resistance
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


BY_NAME = {series.name: series for series in SERIES}


def weight_kn(series):
    volume = series.length * series.height * series.thickness
    return series.density_kg_m3 * volume * GRAVITY / 1e3


def rows_of(tables, number, **wanted):
    return [row for row in tables[number] if all(row[k] == v for k, v in wanted.items())]


@pytest.mark.parametrize("beam", ["beam level", "beam turns"])
def test_a_level_beam_slides_and_a_turning_one_overturns_with_some_of_the_wall(quick, tables, beam):
    """A level one by friction.  A turning one has no weight of its own, so its bounds are those of
    the beam alone, and of it and the whole wall about its toe.
    """
    for made, rule in ((tables, "associative"), (quick, "associative"), (quick, WITHOUT)):
        for row in made[0]:
            found, series = row[f"{beam}, {rule}"], BY_NAME[row["series"]]
            if beam == "beam level":
                assert found == pytest.approx(0.62 * row["N kN"], abs=0.051)
                continue
            arm = series.length / 2 / series.load_height
            assert row["N kN"] * arm + 0.5 < found
            assert found <= (row["N kN"] + weight_kn(series)) * arm + 0.05
    for row in quick[0]:
        assert row[f"{beam}, {WITHOUT}"] <= row[f"{beam}, associative"]


@pytest.mark.parametrize("series", SERIES[:2], ids=lambda series: series.name)
def test_each_kilonewton_on_a_turning_beam_adds_its_arm(series):
    walls = [shear_wall(series, Loading(kn)) for kn in (30.0, 130.0)]
    low, high = (lateral_resistance(*wall).right.alpha for wall in walls)
    assert high - low == pytest.approx(100.0 * series.length / 2 / series.load_height)


@pytest.mark.parametrize(("series", "courses"), [(SERIES[0], 9), (SERIES[1], 8)])
@pytest.mark.parametrize("halves_first", [False, True])
def test_walls_are_in_running_bond(series, courses, halves_first):
    model, loads = shear_wall(series, Loading(30.0, halves_first=halves_first))
    assert series.course_count == courses
    whole = (courses + (not halves_first)) // 2
    assert len(model.blocks) == 5 * whole + 6 * (courses - whole) + 1
    assert [i.other for i in model.interfaces].count(0) == (6 if halves_first else 5)
    assert -loads.dead[:-1, 1].sum() == pytest.approx(weight_kn(series))
    assert loads.dead[-1].tolist() == [0.0, -30.0, 0.0]
    assert model.blocks[-1].centroid[1] == pytest.approx(series.load_height)
    assert loads.live[-1].tolist() == pytest.approx([1.0, 0.0, 0.0])
    assert not loads.live[:-1].any()


def test_ratios_are_over_the_mean_of_both_sides_and_have_mean_and_scatter(tables):
    (predicted,) = rows_of(tables, 0, series=SERIES[2].name, **{"N kN": 175.0})
    (test,) = rows_of(tables, 1, test="WS2.175")
    model = "beam turns, associative"
    assert test["measured kN"] == "64.5 / 71.3"
    assert test[model] == pytest.approx(predicted[model] / 67.9, abs=0.006)
    found = [row["beam turns, associative"] for row in tables[1] if row["test"].startswith("SW")]
    mean = sum(found) / 7
    deviation = (sum((ratio - mean) ** 2 for ratio in found) / 6) ** 0.5
    (row,) = rows_of(tables, 2, series=SERIES[0].name)
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
