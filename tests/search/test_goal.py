"""What a wall is worth."""

import math
from dataclasses import replace

import numpy as np
import pytest

from drystone.craft.bond import bond_faults
from drystone.craft.masonry import Masonry
from drystone.planner.planner import Planner
from drystone.planner.search_settings import GoalSettings
from drystone.search.found import Found
from drystone.search.goal import MISSING, Figures, figures_of, merit_of, possible_filling
from tests.planner.scenes import RUBBLE_SITE, finish, greedy, rubble

WALL = Figures(stones=8, F_SF=0.8, F_LR=0.5, F_AV=20.0, F_AH=2.0, T_LEVEL=0.2, E_FLUSH=0.1)
GOAL = GoalSettings()
EXACT = {"geometry": "exact"}


def test_merit_rises_with_what_is_good_and_falls_with_what_is_bad() -> None:
    def gain(**changes: float) -> float:
        return merit_of(replace(WALL, **changes), 0.9, GOAL) - merit_of(WALL, 0.9, GOAL)

    assert gain(F_SF=0.89) == pytest.approx(0.1 * GOAL.filling)
    assert gain(F_LR=0.7) == pytest.approx(0.2 * GOAL.resistance)
    assert gain(F_LR=1.7) == pytest.approx(0.5 * GOAL.resistance)
    assert gain(F_AV=30.0) == pytest.approx(10 * GOAL.vertical)
    assert gain(F_AH=3.0) == pytest.approx(-GOAL.horizontal)
    assert gain(T_LEVEL=0.3) == pytest.approx(-0.1 * GOAL.level)
    assert gain(E_FLUSH=0.3) == pytest.approx(-0.2 * GOAL.flush)
    assert gain(bond=0.5) == pytest.approx(-0.5 * GOAL.bond)


def test_of_both_flow_rules_the_smaller_counts() -> None:
    def gain(without: float) -> float:
        return merit_of(replace(WALL, F_LR_coulomb=without), 0.9, GOAL) - merit_of(WALL, 0.9, GOAL)

    assert gain(0.2) == pytest.approx(-0.3 * GOAL.resistance)
    assert gain(0.9) == gain(0.5) == 0.0


def test_a_stack_bond_costs_more_than_the_bricks_that_a_bond_leaves_out() -> None:
    """Thirty bricks in stack bond, or two less in a bond: a mason leaves two out."""
    brick = np.array([[0.0, 0.0], [40.0, 0.0], [40.0, 20.0], [0.0, 20.0]])
    stack = {6 * y + x: brick + np.array([40 * x, 20 * y]) for x in range(6) for y in range(5)}
    bond = {i: corners + np.array([16 * (i // 6 % 2), 0]) for i, corners in stack.items()}
    faults = bond_faults(Masonry(stack)) - bond_faults(Masonry(bond))
    assert GOAL.bond * faults > GOAL.filling * 2 / 30


@pytest.mark.parametrize("seed", [0, 3])
def test_what_is_judged_carries_no_more(seed: int) -> None:
    """Without dilatancy a wall carries at most what it carries with it, and it is asked once."""
    planner = finish(Planner(rubble(), RUBBLE_SITE, seed=seed, settings=greedy(EXACT)))
    found = Found.of(planner)
    judged = found.judged(planner.workshop, planner.settings)
    assert found.figures is not None
    assert judged.figures is not None
    assert found.figures.F_LR_coulomb is None
    assert judged.figures.F_LR_coulomb is not None
    assert 0.0 <= judged.figures.F_LR_coulomb <= judged.figures.F_LR
    assert judged.merit <= found.merit
    assert judged.judged(planner.workshop, planner.settings) is judged


@pytest.mark.parametrize(
    ("figure", "short", "aim", "beyond", "weight"),
    [
        ("F_SF", 0.7, 0.75, 0.8, GOAL.filling),
        ("F_LR", 0.5, 0.6, 0.7, GOAL.resistance),
        ("F_AV", 20.0, 30.0, 35.0, GOAL.vertical),
        ("F_AH", 2.0, 1.5, 1.0, -GOAL.horizontal),
    ],
)
def test_nothing_is_gained_beyond_an_aim(
    figure: str, short: float, aim: float, beyond: float, weight: float
) -> None:
    goal = replace(GOAL, **{figure: aim})

    def merit(value: float) -> float:
        return merit_of(replace(WALL, **{figure: value}), 1.0, goal)

    assert merit(beyond) == merit(aim)
    assert merit(aim) - merit(short) == pytest.approx(goal.urgent * weight * (aim - short))
    assert merit(aim) > merit(short)


def test_an_empty_wall_is_the_worst() -> None:
    assert merit_of(None, 0.9, GOAL) == -math.inf


def test_figures_are_those_of_the_wall() -> None:
    planner = finish(Planner(rubble(), RUBBLE_SITE, settings=greedy()))
    figures = figures_of(planner.build)
    assert figures is not None
    assert figures.stones == len(planner.build.actions)
    assert figures.F_SF == planner.build.wall.filling
    assert figures.F_LR == planner.build.actions[-1].resistance.value
    assert figures.F_SF <= possible_filling(planner.workshop) <= 1.0
    empty = Planner(rubble(), RUBBLE_SITE, settings=greedy())
    assert figures_of(empty.build) is None


def test_a_pinned_stone_that_is_missing_counts_heavily() -> None:
    lacking = replace(WALL, missing=2)
    assert merit_of(WALL, 0.9, GOAL) - merit_of(lacking, 0.9, GOAL) == pytest.approx(2 * MISSING)
    planner = finish(Planner(rubble(), RUBBLE_SITE, settings=greedy()))
    placed = [action.stone_id for action in planner.build.actions]
    found = figures_of(planner.build, [*placed[:2], 98, 99])
    assert found is not None
    assert found.missing == 2


@pytest.mark.parametrize("missing", [1, 2])
def test_nothing_else_makes_up_for_a_pinned_stone(missing: int) -> None:
    """A tenth more in the wall for each, and all that the masons' walls have, is still worse."""
    best = {"F_LR": 1.0, "F_AV": 60.0, "F_AH": 0.5, "T_LEVEL": 0.0, "E_FLUSH": 0.0}
    lacking = replace(WALL, F_SF=WALL.F_SF + 0.1 * missing, **best, missing=missing)
    assert merit_of(lacking, 1.0, GOAL) < merit_of(WALL, 1.0, GOAL)


def test_banned_stones_can_fill_nothing() -> None:
    ban = [stone.id for stone in rubble()][:2]
    free = Planner(rubble(), RUBBLE_SITE, settings=greedy())
    without = Planner(rubble(), RUBBLE_SITE, settings=greedy({"ban": ban}))
    lost = sum(rubble().by_id(stone_id).area_px for stone_id in ban) / 3600
    assert possible_filling(free.workshop) - possible_filling(without.workshop) == pytest.approx(
        lost
    )
