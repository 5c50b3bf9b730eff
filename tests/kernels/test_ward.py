"""Ward clusters without the distances of all pairs, against SciPy, which writes them down."""

from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.typing import NDArray
from scipy.cluster.hierarchy import fcluster, ward

from drystone.kernels import ward as module
from drystone.kernels.ward import ward_clusters
from tests.strategies import repeatable

Points = NDArray[np.float64]


@st.composite
def points(draw: st.DrawFn) -> Points:
    """Points as stones' features are: spread, in heaps, or with equal ones among them."""
    rng = np.random.default_rng(draw(st.integers(0, 10**6)))
    count = draw(st.integers(2, 120))
    kind = draw(st.sampled_from(["even", "skew", "heaps", "equal"]))
    if kind == "skew":
        return np.column_stack([rng.beta(5, 3, count), rng.random(count) ** 3])
    if kind == "heaps":
        return rng.integers(0, 5, (count, 1)) / 5 + rng.normal(0, 0.03, (count, 2))
    found = rng.random((count, 2))
    if kind == "equal":
        found = found[rng.integers(0, max(1, count // 3), count)]
    return found


def same_parts(one: NDArray[np.integer], other: NDArray[np.integer]) -> bool:
    pairs = set(zip(one.tolist(), other.tolist(), strict=True))
    return len(pairs) == len(set(one.tolist())) == len(set(other.tolist()))


distances = st.sampled_from([1e-6, 0.02, 0.2, 0.2, 0.7, 3.0])


@repeatable(250)
@given(points(), distances)
def test_clusters_are_those_of_scipy(found: Points, distance: float) -> None:
    expected = fcluster(ward(found), distance, criterion="distance")
    assert same_parts(ward_clusters(found, distance), expected)


@pytest.mark.parametrize(("neighbours", "block"), [(1, 1), (2, 3), (3, 50)])
def test_how_many_are_looked_at_changes_nothing(
    neighbours: int, block: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    rng = np.random.default_rng(7)
    found = np.concatenate([rng.random((80, 2)), rng.normal(0.5, 0.01, (80, 2))])
    expected = ward_clusters(found, 0.2).tolist()
    monkeypatch.setattr(module, "NEIGHBOURS", neighbours)
    monkeypatch.setattr(module, "BLOCK", block)
    assert ward_clusters(found, 0.2).tolist() == expected


@repeatable(60)
@given(st.integers(0, 10**6), st.integers(2, 60), st.integers(1, 4), st.sampled_from([1.0, 2, 5]))
def test_equal_distances_end_with_clusters_that_stay_apart(
    seed: int, count: int, side: int, distance: float
) -> None:
    """Of equally near points of a lattice SciPy may join others, so the rule itself is tested."""
    found = np.random.default_rng(seed).integers(0, side + 1, (count, 2)).astype(float)
    clusters = ward_clusters(found, distance)
    names = np.unique(clusters)
    centres = np.array([found[clusters == name].mean(axis=0) for name in names])
    sizes = np.array([np.count_nonzero(clusters == name) for name in names])
    for k in range(len(names)):
        apart2 = ((centres - centres[k]) ** 2).sum(axis=1)
        ward2 = 2 * sizes * sizes[k] / (sizes + sizes[k]) * apart2
        assert (np.delete(ward2, k) > distance**2 * (1 - 1e-12)).all()
    assert ward_clusters(found, distance).tolist() == clusters.tolist()


def test_a_circle_of_nearest_ones_is_looked_at_anew(monkeypatch: pytest.MonkeyPatch) -> None:
    found = np.array([[0.0, 0.0], [1.0, 0.0], [5.0, 0.0], [5.5, 0.0]])
    real, calls = module._nearest, []

    def first_a_circle(*arguments: Any) -> NDArray[np.intp]:
        calls.append(arguments)
        return np.array([1, 2, 3, 0]) if len(calls) == 1 else real(*arguments)

    monkeypatch.setattr(module, "_nearest", first_a_circle)
    assert ward_clusters(found, 1.0).tolist() == [0, 0, 1, 1]
    assert len(calls) > 1


def test_numbers_are_in_the_order_of_the_first_points() -> None:
    found = np.random.default_rng(3).random((300, 2))
    clusters = ward_clusters(found, 0.2)
    first = [clusters.tolist().index(name) for name in range(clusters.max() + 1)]
    assert first == sorted(first)
    assert first[0] == 0


def test_one_point_equal_points_and_points_far_apart() -> None:
    assert ward_clusters(np.zeros((1, 2)), 0.2).tolist() == [0]
    assert ward_clusters(np.full((5, 2), 0.3), 1e-12).tolist() == [0] * 5
    assert ward_clusters(np.array([[0.0, 0], [9, 0], [0, 0], [9, 9]]), 1.0).tolist() == [0, 1, 0, 2]


def test_a_pair_at_the_distance_itself_is_joined() -> None:
    pair = np.array([[0.0, 0.0], [0.5, 0.0]])
    assert ward_clusters(pair, 0.5).tolist() == [0, 0]
    assert ward_clusters(pair, 0.4999).tolist() == [0, 1]
