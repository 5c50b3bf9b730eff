"""§6.2: exponents of counts and of times, from made walls and small ones."""

import pytest

from drystone.model.site import Site
from drystone.planner.profile import StepTime
from drystone_lab.reproduce.growth import Grown, Sizes, counts, make, times
from drystone_lab.timed_walls import Planned
from tests.lab.reproduce.small_walls import context, rows


def grown(sampling, Q, K, each, seconds_each=1e-3):  # noqa: N803 - the paper's names
    steps = tuple(StepTime(n, each(n), each(n) * seconds_each, {}) for n in range(Q))
    return Grown(sampling, 0.2, Q, K, Planned(Site(10, 10), 1e-3 * Q, steps))


def held(findings):
    return {one.claim: one.holds for one in findings}


def test_candidates_of_ideal_walls_grow_as_the_paper_derives():
    variant = [grown("variant", q, k, lambda _, k=k: k)
               for q, k in ((10, 3), (40, 3), (40, 9), (40, 18))]  # fmt: skip
    full = [grown("full", q, 3, lambda n, q=q: q - n) for q in (10, 40, 160)]
    first, second = counts([*variant, *full])
    assert "1.00, of 4 walls" in first.found
    assert "1.97, of 3 walls" in second.found  # Q (Q + 1) / 2
    assert held(times([*variant, *full])) == dict.fromkeys(held(times([*variant, *full])), True)


def test_other_growth_does_not_agree():
    variant = [grown("variant", q, 3, lambda _, q=q: q) for q in (10, 40)]
    full = [grown("full", q, 3, lambda _: 3, q * 1e-3) for q in (10, 40)]
    assert [one.holds for one in counts([*variant, *full])] == [False, False]
    assert held(times([*variant, *full]))["A candidate costs the same whatever Q is."] is False


def test_one_size_has_no_exponent():
    assert counts([grown("variant", 10, 3, lambda _: 3)])[0].holds is None


def test_walls_are_planned_over_stones_and_over_clusters(tmp_path):
    output = make(context(tmp_path), Sizes((8, 16), (0.05, 1.0)))
    walls = rows(output, "walls")
    assert [(row["sampling"], row["Q"]) for row in walls] == [
        ("variant", 8), ("variant", 16), ("full", 8), ("full", 16), ("variant", 16),
        ("variant", 16),
    ]  # fmt: skip
    # A low threshold leaves many clusters, a high one few.  A step has a candidate of each, and
    # now and then others when none of these can be placed.
    assert walls[4]["K"] > walls[1]["K"] > walls[5]["K"]
    for row in walls:
        most = row["Q"] if row["sampling"] == "full" else row["K"]
        assert row["candidates a step"] < most + 1
        assert row["candidates"] == pytest.approx(
            row["candidates a step"] * row["placed"], rel=0.01
        )
    assert {name for name, _ in output.times} == {"time-claims", "seconds"}
    assert len(output.pictures[0].figure.axes) == 2
