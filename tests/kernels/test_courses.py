"""Courses against loops over columns, annealing against one that lays all anew."""

from itertools import product

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from drystone.kernels import course_types, courses
from drystone.kernels.backend import describe
from drystone.kernels.course_moves import Dice, changed
from drystone.kernels.course_types import (
    PIXEL_UNITS,
    STARTS,
    TERMS,
    Arrangement,
    Cooling,
    Ground,
    Rules,
    Weights,
)
from drystone.kernels.courses import anneal, evaluate, ways_up
from drystone.kernels.polygons import area_and_centroid, turn
from drystone.metrics import paths
from drystone.search.course_task import poses_of
from tests.naive.courses import all_terms, annealed
from tests.polygons import random_polygon
from tests.strategies import repeatable

QUARTERS = (0, 90, 180, 270)


def random_case(seed):
    """Some stones, in courses, on what may be there already."""
    rng = np.random.default_rng(seed)
    count = int(rng.integers(1, 13))
    size = float(rng.choice([0.7, 9.0, 30.0]))
    outlines = [random_polygon(rng, int(rng.integers(3, 9)), size) for _ in range(count)]
    corners = [turn(outline, quarter) for outline in outlines for quarter in QUARTERS]
    areas = np.array([area_and_centroid(outline)[0] for outline in outlines])
    poses = poses_of(corners, areas, 1.0)
    columns = int(np.diff(poses.first).max() + rng.integers(0, 80))
    width = max(int(poses.width.max()), 16 * columns - int(rng.integers(0, 16)))
    placed = int(rng.integers(1, count + 1))
    ends = np.sort(rng.choice(np.arange(1, placed), int(rng.integers(0, min(4, placed))), False))
    sizes = np.diff([0, *ends, placed]).astype(np.int32)
    gaps = np.array([rng.integers(-1 - n, n + 1) for n in sizes], np.int32)
    turns = rng.integers(0, 4, count, np.int32)
    plan = Arrangement(rng.permutation(count).astype(np.int32), turns, sizes, gaps)
    ground = random_ground(rng, columns, width)
    rules = Rules(
        Weights(*rng.uniform(0.0, 1.0, TERMS).tolist()),
        reach=int(rng.integers(1, 300)),
        margin=float(rng.uniform(0.0, 0.4)),
        steepest=int(rng.integers(0, 20000)),
        joint=int(rng.integers(0, 5)),
        courses=max(4, count),
        target=float(rng.uniform(0.0, 100.0)),
    )
    return poses, plan, ground, rules


def random_ground(rng, columns, width):
    """Bare, or with a course of some joints."""
    height = int(rng.integers(10, 1500))
    if rng.random() < 0.5:
        nothing = (np.zeros((0, size), np.int32) for size in (2, STARTS, 3))
        return Ground(np.zeros(columns, np.int32), *nothing, width, height)
    ends = np.sort(rng.integers(0, width, 2 * int(rng.integers(1, 4)), np.int32)).reshape(-1, 2)
    joints = [(int(a), int(b)) for a, b in ends]
    ways = ways_up(joints, [], np.zeros((0, STARTS), np.int32), width)
    beds = rng.integers(0, 100, (2, 3), np.int32)
    return Ground(rng.integers(0, 200, columns, np.int32), ends, ways, beds, width, height)


cases = st.integers(0, 10**6).map(random_case)


def bits(parts):
    return [(p.dtype.str, p.shape, p.tobytes()) if isinstance(p, np.ndarray) else p for p in parts]


@repeatable(120)
@given(case=cases)
def test_stones_lie_and_count_as_in_loops_over_columns(case):
    layout = evaluate(*case)
    places, level, joints, terms = all_terms(*case)
    assert list(zip(layout.x, layout.y, layout.slope, strict=True)) == places
    assert layout.tops.tolist() == level
    assert [tuple(joint) for joint in layout.joints.tolist()] == joints
    assert layout.terms == pytest.approx(np.array(terms), rel=1e-12, abs=1e-12)
    priced = layout.terms * np.array(case[3].weights)
    assert layout.cost == pytest.approx(priced.sum(), rel=1e-9)


@repeatable(25)
@given(
    case=cases,
    seed=st.integers(-(2**70), 2**70),
    hot=st.sampled_from([0.0, 5.0, 5000.0]),
    doubt=st.sampled_from([0.0, 50.0, np.inf]),
    narrow=st.booleans(),
)
def test_annealing_is_the_same_when_all_is_laid_anew(case, seed, hot, doubt, narrow):
    poses, _, ground, _ = case
    if narrow:  # courses too wide for the wall: their joints go to and fro
        case = (*case[:2], ground._replace(width=int(poses.width.max())), case[3])
    cooling = Cooling(150, hot, 0.99, seed, doubt)
    found, cost = anneal(*case, cooling)
    anew, same = annealed(*case, cooling)
    assert bits(found) == bits(anew)
    assert cost == same


@pytest.mark.skipif(describe() == "Python", reason="it takes a minute in Python")
def test_what_is_kept_of_old_courses_never_drifts():
    """After very many changes the cost is still that of the plan laid anew."""
    for case, hot, doubt in product(map(random_case, range(25)), (0.1, 300.0), (1.0, np.inf)):
        poses, _, ground, rules = case
        found, cost = anneal(*case, Cooling(3000, hot, 0.9995, 1, doubt))
        assert cost == evaluate(poses, found, ground, rules).cost


@given(case=cases, seed=st.integers(0, 99))
def test_changes_keep_every_stone_and_say_where_they_begin(case, seed):
    poses, plan, _, rules = case
    dice = Dice(seed)
    for _ in range(60):
        before = plan
        plan, lowest = changed(before, dice, rules.courses)
        assert sorted(plan.order) == list(range(poses.area.size))
        assert min(plan.sizes) >= 1
        assert sum(plan.sizes) <= len(plan.order)
        assert ((-1 - plan.sizes <= plan.gaps) & (plan.gaps <= plan.sizes)).all()
        assert len(plan.sizes) <= rules.courses
        if lowest < 0:
            assert bits(plan) == bits(before)
            continue
        assert 0 <= lowest < len(plan.sizes)
        below, kept = int(before.sizes[:lowest].sum()), slice(lowest)
        stones = before.order[:below]
        for now, then, same in zip(plan, before, (slice(below), stones, kept, kept), strict=True):
            assert (now[same] == then[same]).all()


def test_every_kind_of_change_happens():
    plan = Arrangement(*(np.array(p, np.int32) for p in ([*range(9)], [0] * 9, [3, 2], [1, 1])))
    dice = Dice(1)
    counts, placed, gaps = set(), set(), set()
    for _ in range(4000):
        plan, _ = changed(plan, dice, 4)
        counts.add(len(plan.sizes))
        placed.add(int(plan.sizes.sum()))
        gaps.add(tuple(plan.gaps.tolist()))
    assert counts == {1, 2, 3, 4}
    assert placed > {3, 5, 7, 9}
    assert len(gaps) > 9
    assert set(plan.turns.tolist()) == {0, 1, 2, 3}


def test_the_dice_are_splitmix64():
    dice = Dice(0)
    assert [dice.below(2**32) for _ in range(3)] == [0xE220A839, 0x6E789E6A, 0x06C45D18]
    assert Dice(2**64).below(2**32) == 0xE220A839
    numbers = [Dice(seed).below(3) for seed in range(300)]
    assert set(numbers) == {0, 1, 2}


def spoilt(case, **changes):
    def fitting(part):
        return part._replace(**{k: v for k, v in changes.items() if k in part._fields})

    return case[0], *map(fitting, case[1:])


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"order": np.zeros(8, np.int32)}, "every stone once"),
        ({"sizes": np.array([0, 1], np.int32), "gaps": np.ones(2, np.int32)}, "empty"),
        ({"gaps": np.array([9], np.int32), "sizes": np.array([1], np.int32)}, "gap"),
        ({"turns": np.full(8, 4, np.int32)}, "quarters"),
        ({"width": 1}, "wider"),
        ({"reach": 0}, "negative"),
        ({"joints": np.zeros((3, 2), np.int32)}, "way"),
    ],
)
def test_arrays_that_do_not_fit_are_refused(changes, message):
    case = next(case for case in map(random_case, range(999)) if case[1].order.size == 8)
    with pytest.raises(ValueError, match=message):
        evaluate(*spoilt(case, **changes))
    with pytest.raises(ValueError, match=message):
        anneal(*spoilt(case, **changes), Cooling(1, 1.0, 1.0, 0))


@pytest.mark.parametrize("evaluations", [0, 1, 4, 7, 8])
def test_a_look_is_taken_every_round_and_what_it_raises_ends_the_annealing(
    evaluations, monkeypatch
):
    case = random_case(0)
    cooling = Cooling(evaluations, 1.0, 0.98, 1)
    unseen, cost = anneal(*case, cooling)
    monkeypatch.setattr(courses, "ROUND", 4)
    looks = []

    def looked():
        looks.append(1)
        if len(looks) > 2:
            raise TimeoutError

    found, same_cost = anneal(*case, cooling, looked)
    assert len(looks) == -(-evaluations // 4)
    assert (bits(found), same_cost) == (bits(unseen), cost)
    with pytest.raises(TimeoutError):
        anneal(*case, cooling._replace(evaluations=12), looked)


def test_starts_are_those_of_the_metrics_and_there_is_room_for_all():
    assert (course_types.FIRST_PX, STARTS) == (paths.FIRST_PX, paths.STARTS)
    pads = paths.PAD_TOP + paths.PAD_BOTTOM, paths.PAD_LEFT + paths.PAD_RIGHT
    assert pads == 2 * (course_types.PADDING_PX,)
    # One more would be thrown away.
    for side in range(3000):
        rest = side + course_types.PADDING_PX - course_types.FIRST_PX
        # To a joint at the left end all paths go aside; 0 is beyond the starts.
        ways = ways_up([(0, 0)], [], np.zeros((0, STARTS), np.int32), side * PIXEL_UNITS)
        step = max(1, (side + course_types.PADDING_PX) // STARTS)
        starts = range(course_types.FIRST_PX, rest, step)
        assert np.count_nonzero(ways) == len(starts) <= STARTS
        assert starts or side <= 17
