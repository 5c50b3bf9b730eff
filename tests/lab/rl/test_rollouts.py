"""Walls finished from each place of a stone, on walls of which the best place is known."""

import numpy as np
import pytest

from drystone.model.site import Site
from drystone.selection.policies.learned import FEATURES
from drystone_lab.rl.draw import draw_wall
from drystone_lab.rl.episode import Episode, prepared
from drystone_lab.rl.train import Branching, at_random, branching, finished, fitted, spread_of
from tests.lab.rl.walls import SMALL, bricks


def made(count: int, weights: list[float], noise: float = 0.0) -> list[Branching]:
    """Return branchings whose merits are weighted sums of features, and a sum of their own."""
    rng = np.random.default_rng(5)
    found = []
    for _ in range(count):
        features = rng.normal(size=(4, len(weights)))
        merits = features @ np.array(weights) + rng.normal() + noise * rng.normal(size=4)
        found.append(Branching(features, merits))
    return found


def test_fit_finds_the_weights_whatever_the_walls_are_worth() -> None:
    weights = [1.0, -2.0, 0.0]
    ones = np.ones(3)
    assert fitted(made(50, weights), ones, 1e-9) == pytest.approx(weights, abs=1e-6)
    noisy = fitted(made(2000, weights, noise=1.0), ones, 1e-9)
    assert noisy == pytest.approx(weights, abs=0.06)


def test_fit_is_of_features_over_their_scale() -> None:
    scale = np.array([2.0, 0.5, 1.0])
    found = fitted(made(50, [1.0, -2.0, 0.0]), scale, 1e-9)
    assert found / scale == pytest.approx([1.0, -2.0, 0.0], abs=1e-6)


def test_fit_is_drawn_to_zero() -> None:
    data = made(50, [1.0, -2.0, 0.0])
    assert fitted(data, np.ones(3), 1e9) == pytest.approx(np.zeros(3), abs=1e-4)
    # 50 times 4 places less their mean: as many zeros halve them.
    assert fitted(data, np.ones(3), 150.0)[1] == pytest.approx(-1.0, abs=0.2)


def test_spread_is_within_branchings() -> None:
    rows = np.array([[1.0, 5.0], [3.0, 5.0]])
    two = [Branching(rows, np.zeros(2)), Branching(rows + 10.0, np.zeros(2))]
    assert spread_of(two).tolist() == [1.0, 1.0]
    assert spread_of([Branching(2 * rows, np.zeros(2))]).tolist() == [2.0, 1.0]


def test_branching_finishes_the_wall_from_every_place() -> None:
    workshop = prepared(*draw_wall(SMALL, np.random.default_rng(2)))
    one = branching(workshop, at_random, (1, 2))
    again = branching(workshop, at_random, (1, 2))
    assert one is not None
    assert again is not None
    assert one.features.shape == (len(one.merits), len(FEATURES))
    assert len(one.merits) > 1
    assert one.merits.tolist() == again.merits.tolist()
    assert (one.merits > 0).all()


def test_no_branching_where_no_stone_fits() -> None:
    stones, _ = bricks(3)
    workshop = prepared(stones, Site(5, 5))
    assert branching(workshop, at_random, (1,)) is None
    assert finished(Episode(workshop), at_random, np.random.default_rng(0)) == 0.0
