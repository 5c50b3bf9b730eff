"""How time grows; no time is asserted, only what is computed from times."""

from pathlib import Path
from types import SimpleNamespace

import pytest

from benchmarks import growth
from drystone.model.site import Site
from drystone.planner.profile import StepTime
from drystone.planner.settings import method_settings
from drystone_lab import timed_walls
from drystone_lab.pictures.growth import PowerLaw
from drystone_lab.table import BenchSettings
from drystone_lab.timed_walls import TimedWall, fitted, pixels_table, planned, rubble, steps_table
from drystone_lab.walls import PR


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return tmp_path_factory.mktemp("growth")


@pytest.fixture(scope="module")
def tables(folder):
    return growth.run(BenchSettings(quick=True, output=folder))


def step(stones, candidates=2, seconds=0.01, **parts):
    return StepTime(stones, candidates, seconds, {"placement": 0.004, **parts})


def wall(width, height, *steps):
    return TimedWall(Site(width, height), 0.5, steps)


def test_the_quick_suite_plans_every_wall(tables, folder):
    pixels, steps, walls = tables
    assert [row["wall, px"] for row in pixels.records()] == [
        "70 x 20",
        "140 x 40",
        "exponent over pixels",
    ]
    assert {row["sampling"] for row in steps.records()} == {"variant", "full"}
    assert [row["stones"] for row in walls.records()] == ["8", "16", "exponent"]
    for table in tables:
        measured = [row for row in table.records() if "exponent" not in str(list(row.values()))]
        assert measured
        assert all(row["all"] > 0 for row in measured)
    assert (folder / growth.STEPS_PICTURE).is_file()
    assert (folder / growth.PIXELS_PICTURE).is_file()


def test_generated_stones_are_not_compared_with_the_paper(tables):
    for row in tables[0].records():
        assert row["paper: wall, s"] is row["paper: longest step below, s"] is None


def test_a_full_batch_has_more_candidates_than_one_of_each_cluster(tables):
    of = {row["sampling"]: row["candidates a step"] for row in reversed(tables[1].records())}
    assert of["full"] > of["variant"]


def test_times_against_pixels_and_the_numbers_of_the_paper():
    walls = {
        0.5: wall(140, 40, step(0, seconds=0.01), step(1, seconds=0.03)),
        2.0: wall(560, 160, step(0, seconds=0.32), step(1, seconds=0.32)),
    }
    small, large, exponents = pixels_table("PR", walls).records()
    assert (small["wall, s"], small["longest step, s"], small["all"]) == (0.54, 0.03, 20.0)
    assert small["placement"] == 4.0
    assert small["rest"] == 16.0
    assert (small["paper: wall, s"], small["paper: longest step below, s"]) == (10.8, None)
    assert (large["paper: wall, s"], large["paper: longest step below, s"]) == (None, 25.0)
    # 16 times the pixels take 16 times as long a step.
    assert exponents["all"] == pytest.approx(1.0)
    assert exponents["placement"] == pytest.approx(0.0, abs=1e-9)
    # What took no time has no exponent.
    assert exponents["contacts"] is None


def test_times_against_stones_are_those_of_eight_steps_and_grow_by_the_candidate():
    steps = [step(n, candidates=n or 1, seconds=0.001 * (n or 1) ** 3) for n in range(12)]
    rows = steps_table("PR", {"variant": wall(280, 80, *steps)}).records()
    assert [row["stones placed"] for row in rows] == ["0 to 7", "8 to 11", "exponent a candidate"]
    assert rows[1]["candidates a step"] == 9.5
    assert rows[1]["all"] == pytest.approx((512 + 729 + 1000 + 1331) / 4)
    assert rows[1]["ms a candidate"] == pytest.approx(rows[1]["all"] / 9.5, abs=0.05)
    assert rows[2]["all"] == pytest.approx(2.0)


def test_larger_walls_have_exponents_over_their_stones():
    walls = {32: wall(280, 80, step(0)), 128: wall(560, 160, step(0), step(1))}
    *rows, exponents = growth._walls_table(walls).records()
    assert [row["preparation, ms a stone"] for row in rows] == [15.6, 3.91]
    assert exponents["preparation, ms a stone"] == pytest.approx(-1.0)


def test_a_power_law_needs_two_sizes_and_times_above_0():
    assert fitted([(1.0, 2.0)]) is None
    assert fitted([(2.0, 2.0), (2.0, 3.0)]) is None
    assert fitted([(1.0, 0.0), (2.0, 3.0)]) is None
    law = fitted([(1.0, 2.0), (10.0, 200.0)])
    assert law is not None
    assert (law.factor, law.exponent) == (pytest.approx(2.0), pytest.approx(2.0))
    assert PowerLaw(2.0, 2.0)(3.0) == 18.0


def test_the_median_repetition_of_every_step_counts(monkeypatch: pytest.MonkeyPatch):
    runs = iter([(1.0, 5.0, 3.0), (2.0, 4.0, 6.0), (9.0, 9.0, 1.0)])

    def planner(*_args, **_options):
        preparation, *seconds = next(runs)
        profile = SimpleNamespace(
            steps=[step(n, seconds=s) for n, s in enumerate(seconds)],
            total=lambda part: preparation if part == "preparation" else 0.0,
        )
        return SimpleNamespace(profile=profile, steps=lambda: iter(()))

    monkeypatch.setattr(timed_walls, "Planner", planner)
    wall = rubble(8, 0, (140, 40))
    found = planned(wall, None, method_settings("paper"), seed=0, repeats=3)
    assert [s.seconds for s in found.steps] == [5.0, 3.0]
    assert found.seconds == 10.0
    assert found.longest == 5.0


def test_the_published_stones_are_used_when_they_are_there(data_dir):
    assert growth._wall(BenchSettings(data=data_dir), None) == PR
    assert growth._wall(BenchSettings(), None).name == "32 generated stones"
