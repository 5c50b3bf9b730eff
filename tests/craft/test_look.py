"""All rules at once: walls of every kind, limits, and numbers without a scale."""

import json
import re
import tracemalloc
from dataclasses import replace

import numpy as np
import pytest
import shapely
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra import numpy as npst

from drystone.craft import RULES, CraftSettings, Limit, Masonry, look
from drystone.craft.joints import scan
from drystone.errors import InputError, UsageError
from drystone.io.walls import read_wall
from tests.craft.walls import box, courses, mirrored, painted, running_bond, stack_bond


def test_walls_of_next_to_nothing_are_judged():
    brick = box(0, 0, 2, 1)
    stones = map(Masonry, ({}, {3: brick}, {1: brick, 2: box(50, 30, 2, 1)}))
    for masonry in (*stones, Masonry({3: brick}, wedge_ids={3})):
        report = look(masonry)
        assert list(report.findings) == list(RULES)
        assert "NaN" not in json.dumps(report.report())
        if len(masonry.stones) < 2:
            assert report.broken == ()
            assert report.findings["running_joints"].verdict == "not judged"


@settings(max_examples=25)
@given(npst.arrays(np.uint8, st.tuples(st.integers(1, 9), st.integers(1, 12)),
                   elements=st.integers(0, 5)))  # fmt: skip
def test_any_picture_of_ids_can_be_looked_at(labels):
    """Stones of one pixel, in pieces, with holes, touching at corners."""
    ids = set(np.unique(labels).tolist()) - {0}
    report = look(Masonry.from_labels(labels.astype(np.uint32), wedge_ids=set(sorted(ids)[:1])))
    json.dumps(report.report(), allow_nan=False)
    for finding in report.findings.values():
        assert {stone for case in finding.cases for stone in case.stones} <= ids


def test_numbers_have_no_scale_and_a_mirrored_wall_is_named_alike_with_its_sides_swapped():
    rng, factor = np.random.default_rng(5), 1e4
    loops = {i: loop + rng.uniform(-0.12, 0.12, (4, 2)) for i, loop in running_bond().items()}
    one = look(Masonry(loops)).findings
    # Closed, and the other way round.
    moved = {i: loop[[3, 2, 1, 0, 3]] * factor + [3 * factor, 0] for i, loop in loops.items()}
    other, back = look(Masonry(moved)).findings, look(Masonry(mirrored(loops))).findings
    swapped = {"left": "right", "right": "left"}
    for name in RULES:
        found, scaled, reflected = one[name], other[name], back[name]
        assert found.number == pytest.approx(scaled.number, abs=1e-6), name
        assert found.number == pytest.approx(reflected.number, abs=1e-9), name
        assert found.verdict == scaled.verdict
        named = [[(case.stones, case.words) for case in each.cases] for each in (found, scaled)]
        assert named[0] == named[1]
        theirs = {
            (frozenset(case.stones), re.sub("left|right", lambda m: swapped[m[0]], case.words))
            for case in reflected.cases
        }
        assert {(frozenset(stones), words) for stones, words in named[0]} == theirs, name


def test_limits_are_settings():
    wall = Masonry(stack_bond(3, 2))
    assert look(wall).findings["running_joints"].verdict == "fair"
    strict = look(wall, {"running_joints": Limit(0, 1)})
    assert strict.findings["running_joints"].verdict == "broken"
    assert "running_joints" in strict.broken
    assert strict.report()["rules"]["running_joints"]["limits"] == {"good": 0, "fair": 1}
    nan = float("nan")
    for name, limit in [("no_rule", (0, 1)), ("laps", (0.3, 0.1)), ("one_over_two", (0.6, 0.8)),
                        ("laps", (nan, 0.1))]:  # fmt: skip
        with pytest.raises(UsageError, match="E190"):
            look(wall, {name: Limit(*limit)})
    with pytest.raises(UsageError, match="E191 wedges: the wall has no 12, 99"):
        Masonry(stack_bond(2, 2), wedge_ids={99, 12, 1})
    for name, value in (("joint", 0.0), ("lap", nan), ("sample", 0.2)):
        with pytest.raises(ValueError, match="must be"):
            CraftSettings(**{name: value})
    finding = RULES["running_joints"].find(Masonry(running_bond()))
    assert finding.amount == "1 course"
    assert replace(finding, number=3.0).amount == "3 courses"
    assert replace(finding, number=None).amount == ""


def test_json_names_stones_steps_and_lines():
    steps = {i: 100 + i for i in stack_bond()}
    report = look(Masonry(stack_bond(), steps=steps)).report()
    assert json.loads(json.dumps(report)) == report
    case = report["rules"]["cross_joints"]["cases"][0]
    assert case["steps"] == [100 + i for i in case["stones"]]
    assert len(case["lines"]) == 2
    assert (report["stones"], "traced" in report["unseen"]) == (20, True)
    # There are no steps without a plan.  The foot is the lowest stone of a picture.
    labels = painted(stack_bond())
    without = look(Masonry.from_labels(labels)).report()
    assert "steps" not in without["rules"]["cross_joints"]["cases"][0]
    lower = np.vstack([labels, np.zeros((40, labels.shape[1]), np.uint32)])
    assert look(Masonry.from_labels(lower)).report() == without


def test_the_masons_regular_wall_keeps_its_bond(data_dir):
    """Independent of our outlines: courses of R are level and every joint is crossed."""
    found = look(Masonry.from_labels(read_wall(data_dir / "almeida" / "R.png").labels)).findings
    assert found["running_joints"].number == 1.0
    assert found["one_over_two"].number == 1.0
    assert found["level_beds"].number < 0.1


@pytest.mark.parametrize("axis", [0, 1])
def test_runs_are_what_the_lines_have_of_the_outlines(axis):
    angles = np.linspace(0.0, 2.0 * np.pi, 60, endpoint=False)
    for seed in range(3):
        radii = np.random.default_rng(seed).uniform(0.3, 3.0, (60, 1))
        star = radii * np.column_stack([np.cos(angles), np.sin(angles)])
        outlines = {4: star, 7: star + np.array([5.0, 1.0])}
        found = scan(outlines, axis, 0.07)
        for place, runs in zip(found.places.tolist(), found.runs, strict=True):
            for block, loop in outlines.items():
                ends = np.array([[-9.0, place], [99.0, place]])[:, :: 1 - 2 * axis]
                cut = shapely.intersection(shapely.Polygon(loop), shapely.LineString(ends))
                pieces = [np.sort(part.xy[axis]) for part in shapely.get_parts(cut)]
                mine = [(run.begin, run.end) for run in runs if run.id == block]
                np.testing.assert_allclose(
                    np.reshape(mine, (-1, 2)), np.reshape(sorted(map(tuple, pieces)), (-1, 2)),
                    atol=1e-9,
                )  # fmt: skip


def test_the_memory_does_not_grow_with_the_square_of_the_joints():
    wall = Masonry(courses([[1.0] * 600] * 2))
    assert len(wall.heads) == 2 * 599
    assert wall.shapes
    tracemalloc.start()
    assert {chain.courses for chain in wall.chains} == {2}
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert peak < 1e6


COMB = [(4 + tip, 100 if tip % 2 else 1) for tip in range(40_000)]
"""An outline that every level line cuts many times, but for its foot."""


@pytest.mark.parametrize(
    "last",
    [box(1e9, 0, 2, 1), box(0, 1e9, 2, 1), box(4, 0, 1e5, 1), np.array([*COMB, (4, 0)], float)],
    ids=["far aside", "far up", "wide", "comb"],
)
def test_a_wall_that_reaches_too_far_is_refused(last):
    with pytest.raises(InputError, match=r"E192 wall: it reaches over .* mean heights"):
        look(Masonry({1: box(0, 0, 2, 1), 2: box(2, 0, 2, 1), 3: last}))
