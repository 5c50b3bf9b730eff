"""What a wall is worth, and which walls of a search are kept."""

import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from drystone.craft.bond import bond_faults
from drystone.craft.masonry import Masonry
from drystone.model.builder import BuilderErrors, put_down_with, stratified
from drystone.planner.build import Solves
from drystone.planner.search_settings import GoalSettings
from drystone.search.goal import (
    FoundWall,
    Rehearsals,
    WallFigures,
    figures_of,
    merit_of,
    possible_filling,
)
from drystone.search.packed import MOST, STEPS, PackedWall, archived, score_of
from drystone.search.rehearsal import groups_of, mean_size, put_up
from drystone.search.wedging import one_more_wedge
from drystone.search.yard import Yard
from tests.planner import scenes
from tests.strategies import repeatable

WALL = WallFigures(stones=8, F_SF=0.8, F_LR=0.5, F_AV=20.0, F_AH=2.0, T_LEVEL=0.2, E_FLUSH=0.1)
GOAL = GoalSettings()


@pytest.mark.parametrize(
    ("changes", "gain"),
    [
        ({"F_SF": 0.89}, 0.1 * GOAL.filling),
        ({"F_LR": 0.7}, 0.2 * GOAL.resistance),
        ({"F_LR": 1.7}, 0.5 * GOAL.resistance),
        ({"F_AV": 30.0}, 10 * GOAL.vertical),
        ({"F_AH": 3.0}, -GOAL.horizontal),
        ({"T_LEVEL": 0.3}, -0.1 * GOAL.level),
        ({"E_FLUSH": 0.3}, -0.2 * GOAL.flush),
        ({"bond": 0.5}, -0.5 * GOAL.bond),
        # Of both flow rules the smaller counts.
        ({"F_LR_coulomb": 0.2}, -0.3 * GOAL.resistance),
        ({"F_LR_coulomb": 0.9}, 0.0),
        ({"missing": 2}, -20.0),
        ({"fallen": 0.1}, -0.1 * GOAL.fallen),
    ],
)
def test_merit_rises_with_what_is_good_and_falls_with_what_is_bad(changes, gain):
    changed = replace(WALL, **changes)
    assert merit_of(changed, 0.9, GOAL) - merit_of(WALL, 0.9, GOAL) == pytest.approx(gain)
    assert merit_of(None, 0.9, GOAL) == -math.inf
    # Nothing else makes up for a pinned stone: a tenth more in the wall for each, and all that the
    # masons' walls have, is still worse.
    best = {"F_LR": 1.0, "F_AV": 60.0, "F_AH": 0.5, "T_LEVEL": 0.0, "E_FLUSH": 0.0}
    for missing in (1, 2):
        lacking = replace(WALL, F_SF=WALL.F_SF + 0.1 * missing, **best, missing=missing)
        assert merit_of(lacking, 1.0, GOAL) < merit_of(WALL, 1.0, GOAL)


def test_a_stack_bond_costs_more_than_the_bricks_that_a_bond_leaves_out():
    """Thirty bricks in stack bond, or two less in a bond: a mason leaves two out."""
    brick = np.array([[0.0, 0.0], [40.0, 0.0], [40.0, 20.0], [0.0, 20.0]])
    stack = {6 * y + x: brick + np.array([40 * x, 20 * y]) for x in range(6) for y in range(5)}
    bond = {i: corners + np.array([16 * (i // 6 % 2), 0]) for i, corners in stack.items()}
    faults = bond_faults(Masonry(stack)) - bond_faults(Masonry(bond))
    assert GOAL.bond * faults > GOAL.filling * 2 / 30


@pytest.fixture(scope="module")
def careless():
    return scenes.careless(1)


def test_what_nearly_falls_in_a_rehearsal_counts_too(careless):
    blocks, settings = groups_of(careless.build.wall), careless.settings
    errors = BuilderErrors.of_precision(0.03, mean_size(blocks))
    put = []
    for group in blocks:
        seeds = ([8, 0, group[0][0], k] for k in range(len(group)))
        numbers = [stratified(np.random.default_rng(seed), 12, 1) for seed in seeds]
        put.append(put_down_with(errors, group, np.concatenate(numbers, axis=1)))
    runs = [
        put_up(blocks, run, settings.mu, settings.settle).stones for run in zip(*put, strict=True)
    ]
    near = [[1 if e.fallen else max(e.share / 0.25, abs(e.turn_deg) / 12) for e in r] for r in runs]
    assert min(map(max, near)) < max(map(max, near)) == 1.0
    lost = [14 * max(shares) ** 4 + shares.count(1) for shares in near]
    judged = FoundWall.of(careless).judged(Yard.of(careless))
    assert judged.figures.fallen == pytest.approx(np.mean(lost) / len(blocks))


def test_bad_luck_in_some_rehearsals_is_forgotten_in_others(careless):
    yard = Yard.of(careless)
    true = FoundWall.of(careless).judged(yard, rehearsals=Rehearsals(yard, 12, 5))
    figures = replace(true.figures, fallen=true.figures.fallen + 0.1)
    unlucky = replace(true, figures=figures, merit=true.merit - 0.1 * yard.settings.goal.fallen)
    for least, merit in [(true.merit - 0.01, true.merit), (true.merit + 0.01, -math.inf)]:
        again = unlucky.judged(yard, least=least, rehearsals=Rehearsals(yard, 12, 5))
        assert again.merit == pytest.approx(merit)


def test_walls_that_are_rehearsed_together_fall_as_each_alone(careless):
    """What is remembered of the first one, and the order of the runs, change nothing."""
    yard = Yard.of(careless)
    together = Rehearsals(yard, 8, 3)  # fewer than those in which `ENOUGH` fall
    before = together.falls(careless.build)
    others = [
        build for stone in before.first for build, _ in one_more_wedge(careless.build, stone, yard)
    ]
    assert others
    for build in others:
        assert len(build.wall.wedges) == len(careless.build.wall.wedges) + 1
        found = together.falls(build)
        assert found == Rehearsals(yard, 8, 3).falls(build) != Rehearsals(yard, 8, 4).falls(build)
        assert together.falls(build, found.share) == found
        assert together.falls(build, 0.99 * found.share) is None
    assert together.falls(careless.build) == before
    unwedged = replace(yard, settings=yard.settings.updated({"stabilise": {"method": "rotation"}}))
    assert not [*one_more_wedge(careless.build, next(iter(before.first)), unwedged)]


@pytest.mark.parametrize(
    ("figure", "short", "aim", "beyond", "weight"),
    [
        ("F_SF", 0.7, 0.75, 0.8, GOAL.filling),
        ("F_LR", 0.5, 0.6, 0.7, GOAL.resistance),
        ("F_AV", 20.0, 30.0, 35.0, GOAL.vertical),
        ("F_AH", 2.0, 1.5, 1.0, -GOAL.horizontal),
    ],
)
def test_nothing_is_gained_beyond_an_aim(figure, short, aim, beyond, weight):
    goal = replace(GOAL, **{figure: aim})
    walls = [replace(WALL, **{figure: value}) for value in (short, aim, beyond)]
    merits = [merit_of(wall, 1.0, goal) for wall in walls]
    assert merits[0] < merits[1] == merits[2]
    assert merits[1] - merits[0] == pytest.approx(goal.urgent * weight * (aim - short))


@pytest.mark.parametrize("seed", [0, 3])
def test_figures_are_those_of_the_wall_and_judged_it_carries_no_more(seed):
    """Without dilatancy a wall carries at most what it carries with it, and it is asked once."""
    planner = scenes.of_rubble(scenes.greedy(), seed=seed)
    placed = scenes.ids(planner)
    figures = figures_of(planner.build, [*placed[:2], 98, 99])
    assert (figures.stones, figures.missing) == (len(placed), 2)
    assert figures.F_SF == planner.build.wall.filling
    assert figures.F_LR == planner.build.actions[-1].resistance.value
    possible = possible_filling(planner.workshop)
    assert figures.F_SF <= possible == pytest.approx(scenes.rubble().total_area_px / 3600)
    found = FoundWall.of(planner)
    judged = found.judged(Yard.of(planner))
    assert found.figures.F_LR_coulomb is None
    assert 0.0 <= judged.figures.F_LR_coulomb <= judged.figures.F_LR
    assert judged.merit <= found.merit
    assert judged.judged(Yard.of(planner)) is judged
    assert figures_of(scenes.of_rubble(scenes.greedy(), 0).build) is None


def wall(merit=1.0, **changes):
    return PackedWall((), replace(WALL, **changes), merit, Solves(), None)


def test_an_empty_wall_goes_and_one_that_lacks_pinned_stones_is_beaten_by_any_that_does_not():
    assert archived((), [PackedWall((), None, 1.0, Solves(), None)]) == ()
    lacking, whole = wall(-9.0, missing=1), wall(0.5, F_SF=0.1, F_LR=0.0, F_AV=0.0, F_AH=9.0)
    assert archived((lacking,), [whole]) == (whole,)
    assert archived((), [lacking]) == (lacking,)


@pytest.mark.parametrize("figure", STEPS)
def test_one_better_figure_keeps_a_wall_as_far_as_it_counts(figure):
    name, step = "F_LR" if figure == "carried" else figure, STEPS[figure]
    better, alike, worse = (
        wall(0.5, **{name: getattr(WALL, name) + share * step}) for share in (1.0, 0.3, -1.0)
    )
    plain = wall()
    assert archived((plain,), [better, alike, worse]) == (plain, better)
    # One of more merit that is better in no figure beats neither.
    assert archived((better,), [plain]) == (plain, better)


some_walls = st.lists(
    st.builds(
        lambda merit, sf, lr, av, ah: wall(merit, F_SF=sf, F_LR=lr, F_AV=av, F_AH=ah),
        st.floats(0, 20), st.floats(0, 1), st.floats(0, 2), st.floats(0, 60), st.floats(0, 9),
    ),
    max_size=30,
)  # fmt: skip


def rank(wall):
    return wall.merit, score_of(wall.figures)


def beaten(one, by):
    (mine, scores), (yours, others) = rank(one), rank(by)
    return yours >= mine and all(a >= b for a, b in zip(others, scores, strict=True))


def naive(walls):
    """Those that none beats; of those that beat each other the first."""
    kept = []
    for k, wall in enumerate(walls):
        others = [one for j, one in enumerate(walls) if j < k or not beaten(one, wall)]
        if not any(beaten(wall, other) for other in others):
            kept.append(wall)
    return sorted(kept, key=rank, reverse=True)[:MOST]


@repeatable(60)
@given(some_walls)
def test_those_that_none_beats_are_kept_and_no_others(walls):
    kept = archived((), walls)
    assert list(kept) == naive(walls)
    assert archived(kept, []) == kept
