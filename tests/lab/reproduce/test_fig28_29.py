"""Times of steps and of resolutions: computed from made times; small walls for the rest."""

import pytest

from drystone.model.site import Site
from drystone.planner.profile import StepTime
from drystone_lab.reproduce import fig28, fig29
from drystone_lab.time_tables import PAPER_STEP_S, PAPER_WALL_S
from drystone_lab.timed_walls import Planned
from tests.lab.reproduce.small_walls import RUBBLE, context, rows


def step(stones=0, candidates=1, seconds=1.0, **parts):
    named = {name.replace("_", " "): value for name, value in parts.items()}
    return StepTime(stones, candidates, seconds, named)


def wall(*steps, width=280, height=80):
    return Planned(Site(width, height), 0.5, steps)


def held(findings, word):
    (found,) = [one for one in findings if word in one.claim]
    return found.holds


def test_selection_is_contacts_limit_analysis_and_indices():
    steps = [step(placement=5.0, stabilisation=1.0, contacts=1.0, limit_analysis=2.0, indices=1.0)]
    assert fig28.shares(steps) == {"placement": 0.5, "stabilisation": 0.1, "selection": 0.4}


def test_claims_about_parts_need_both_samplings():
    papers = step(placement=6.0, stabilisation=0.1, contacts=3.0)
    ours = step(placement=1.0, stabilisation=2.0, contacts=7.0)
    as_said = fig28.findings({"variant": wall(papers), "full": wall(papers)})
    assert held(as_said, "Placement takes most") is True
    assert held(as_said, "negligible") is True
    mixed = fig28.findings({"variant": wall(papers), "full": wall(ours)})
    assert held(mixed, "Placement takes most") is False
    assert held(mixed, "negligible") is False


def test_steps_of_the_last_quarter_are_compared_with_the_first():
    assert fig28.late_over_early([1.0, 3.0, 9.0, 9.0, 9.0, 9.0, 4.0, 8.0]) == 3.0
    growing = wall(*(step(n, 4, 1.0 + n, contacts=1.0 + n) for n in range(8)))
    falling = wall(*(step(n, 9 - n, 9.0 - n, contacts=1.0) for n in range(8)))
    found = fig28.findings({"variant": growing, "full": falling})
    assert held(found, "almost stable") is False
    assert held(found, "Selection grows") is True
    assert held(found, "full batch") is True
    other = fig28.findings({"variant": falling, "full": growing})
    assert held(other, "Selection grows") is False
    assert held(other, "full batch") is False


def test_two_walls_are_timed_step_by_step(tmp_path):
    output = fig28.make(context(tmp_path), RUBBLE)
    candidates = rows(output, "candidates")
    variant = [row for row in candidates if row["sampling"] == "variant"]
    full = [row for row in candidates if row["sampling"] == "full"]
    assert [row["stones placed"] for row in variant] == list(range(len(variant)))
    # All stones are candidates of the first step.
    assert full[0]["candidates"] == len(RUBBLE.source.stones(None))
    assert variant[0]["candidates"] < full[0]["candidates"]
    assert str(sum(row["candidates"] for row in full)) in output.ours[0]
    assert {name for name, _ in output.times} == {"claims", "procedures", "steps"}
    shares = dict(output.times)["procedures"].records()
    for row in shares:
        assert sum(row[f"{name}, share"] for name in fig28.PROCEDURES) == pytest.approx(1, abs=2e-3)


def test_growth_is_quadratic_when_four_times_the_time_goes_with_twice_the_scale():
    def timed(power):
        return {s: wall(step(seconds=s**power)) for s in (4.0, 8.0)}

    # Preparation of half a second counts with the wall, hardly.
    assert held(fig29.findings(timed(2.0)), "whole wall") is True
    assert held(fig29.findings(timed(2.0)), "longest step is quadratic") is True
    assert held(fig29.findings(timed(1.0)), "longest step is quadratic") is False
    assert held(fig29.findings(timed(3.0)), "longest step is quadratic") is False
    assert held(fig29.findings({1.0: wall(step())}), "longest step is quadratic") is None


def test_the_papers_seconds_are_compared_at_its_sizes():
    assert PAPER_WALL_S == {5600: pytest.approx(10.8)}
    assert PAPER_STEP_S == {89600: 25.0}
    small = wall(step(seconds=10.2), step(seconds=0.2), width=140, height=40)
    large = wall(step(seconds=24.0), step(seconds=1.0), width=560, height=160)
    found = fig29.findings({0.5: small, 2.0: large})
    assert held(found, "140 x 40") is False  # 10.4 s of steps and .5 s of preparation
    assert held(found, "560 x 160") is True


def test_a_stone_has_one_colour_at_all_resolutions(tmp_path):
    output = fig29.make(context(tmp_path), RUBBLE, (0.5, 1.0))
    first, second = output.pictures[0].figure.axes
    colours = [
        {p.get_gid(): p.get_facecolor() for p in ax.patches if str(p.get_gid()).startswith("stone")}
        for ax in (first, second)
    ]
    shared = {*colours[0]} & {*colours[1]}
    assert len(shared) > 5
    assert all(colours[0][gid] == colours[1][gid] for gid in shared)
    assert len({*colours[0].values()}) == len(colours[0])
    starts = {tuple(c.clusters)[:4] for c in context(tmp_path).run(output.runs)}
    assert f"{len(starts)} different beginnings of 2 walls" in output.ours[0]
    sizes = [row["wall, px"] for row in rows(output, "walls")]
    assert sizes == ["85 x 32", "170 x 64"]
    assert [run.scale for run in output.runs] == [0.5, 1.0]
