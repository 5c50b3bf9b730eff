"""How time grows; no time is asserted, only what is computed from times."""

from types import SimpleNamespace

import pytest

from benchmarks import growth
from drystone.model.site import Site
from drystone.planner.profile import StepTime
from drystone.planner.settings import method_settings
from drystone_lab import timed_walls
from drystone_lab.reproduce.times import pixel_rows, step_rows
from drystone_lab.timed_walls import TimedWall, fitted, planned, rubble


def step(stones, candidates=2, seconds=0.01, **parts):
    return StepTime(stones, candidates, seconds, {"placement": 0.004, **parts})


def wall(width, height, *steps):
    return TimedWall(Site(width, height), 0.5, steps)


def test_every_larger_wall_is_planned_and_they_have_exponents_over_their_stones():
    *rows, exponents = growth.larger_walls(0, (8, 16)).records()
    assert [row["stones"] for row in (*rows, exponents)] == ["8", "16", "exponent"]
    assert all(row["all"] > 0 for row in rows)
    walls = {32: wall(280, 80, step(0)), 128: wall(560, 160, step(0), step(1))}
    *rows, exponents = growth.growth_table(walls).records()
    assert [row["preparation, ms a stone"] for row in rows] == [15.6, 3.91]
    assert exponents["preparation, ms a stone"] == pytest.approx(-1.0)


def test_times_against_pixels_and_the_numbers_of_the_paper():
    walls = {
        0.5: wall(140, 40, step(0, seconds=0.01), step(1, seconds=0.03)),
        2.0: wall(560, 160, step(0, seconds=0.32), step(1, seconds=0.32)),
    }
    small, large, exponents = pixel_rows(walls)
    assert small[:4] == ("140 x 40", 2, 2.0, 4.0)
    # The rest of a step, all of it, whole walls here and in the paper, longest steps.
    assert small[-6:] == (16.0, 20.0, 0.54, 10.8, 0.03, None)
    assert (large[-3], large[-1]) == (None, 25.0)
    # 16 times the pixels take 16 times as long a step; what took no time has no exponent.
    assert exponents[9] == pytest.approx(1.0)
    assert exponents[3] == pytest.approx(0.0, abs=1e-9)
    assert exponents[5] is None


def test_times_against_stones_are_those_of_eight_steps_and_grow_by_the_candidate():
    steps = [step(n, candidates=n or 1, seconds=0.001 * (n or 1) ** 3) for n in range(12)]
    rows = list(step_rows({"variant": wall(280, 80, *steps)}))
    assert [row[1] for row in rows] == ["0 to 7", "8 to 11", "exponent a candidate"]
    assert rows[1][2] == 9.5
    assert rows[1][-2] == pytest.approx((512 + 729 + 1000 + 1331) / 4, abs=5)
    assert rows[1][-1] == pytest.approx(rows[1][-2] / 9.5, abs=0.5)
    assert rows[2][-2] == pytest.approx(2.0)


def test_a_power_law_needs_two_sizes_and_times_above_0():
    for points in ([(1.0, 2.0)], [(2.0, 2.0), (2.0, 3.0)], [(1.0, 0.0), (2.0, 3.0)]):
        assert fitted(points) is None


def test_the_median_repetition_of_every_step_counts(monkeypatch):
    runs = iter([(1.0, 5.0, 3.0), (2.0, 4.0, 6.0), (9.0, 9.0, 1.0)])

    def planner(*_args, **_options):
        preparation, *seconds = next(runs)
        profile = SimpleNamespace(
            steps=[step(n, seconds=s) for n, s in enumerate(seconds)],
            total=lambda part: preparation if part == "preparation" else 0.0,
        )
        return SimpleNamespace(profile=profile, steps=lambda: iter(()))

    monkeypatch.setattr(timed_walls, "Planner", planner)
    found = planned(rubble(8, 0, (140, 40)), None, method_settings("paper"), seed=0, repeats=3)
    assert [s.seconds for s in found.steps] == [5.0, 3.0]
    assert (found.seconds, found.longest) == (10.0, 5.0)
