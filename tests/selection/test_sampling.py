"""Candidate sets (§3.4, §5.1)."""

import numpy as np
import pytest

from drystone.selection.sampling import sample_stones, second_fold

CLUSTERS = {1: 1, 2: 1, 3: 1, 5: 2, 8: 2, 9: 3, 70_000: 4}
ALL = tuple(CLUSTERS)


def sampled(sampling, remaining, seed=0):
    return sample_stones(sampling, remaining, CLUSTERS, np.random.default_rng(seed))


@pytest.mark.parametrize("sampling", ["variant", "twofold", "shrinking"])
def test_variant_takes_one_stone_of_each_cluster_that_is_left(sampling):
    some, few = (1, 2, 3, 8, 70_000), (2, 3, 70_000)
    for remaining, clusters in ((ALL, [1, 2, 3, 4]), (some, [1, 2, 4]), (few, [1, 4])):
        samples = [sampled(sampling, remaining, seed) for seed in range(60)]
        # Topped up to the number of clusters at first, as far as there are stones.
        count = len(clusters) if sampling == "shrinking" else min(4, len(remaining))
        assert all(len({*sample}) == count for sample in samples)
        assert all(list(sample) == sorted(sample) for sample in samples)
        assert all(sorted({CLUSTERS[i] for i in sample}) == clusters for sample in samples)
        assert {i for sample in samples for i in sample} == set(remaining)


def test_uniform_takes_as_many_as_there_were_clusters_and_ignores_them():
    samples = [sampled("uniform", ALL, seed) for seed in range(40)]
    for seed, sample in enumerate(samples):
        assert len(set(sample)) == 4
        assert list(sample) == sorted(sample)
        assert sampled("uniform", (2, 3), seed) == (2, 3)
        assert len(sampled("uniform", (1, 2, 3, 5, 8), seed)) == 4
    assert any(len({CLUSTERS[i] for i in sample}) < 4 for sample in samples)


def test_full_takes_all_and_the_second_fold_the_cluster_of_the_winner():
    assert sampled("full", (3, 9)) == (3, 9)
    rng = np.random.default_rng(3)
    sample_stones("full", ALL, CLUSTERS, rng)
    assert rng.random() == np.random.default_rng(3).random()  # it does not draw
    assert second_fold(2, (2, 3, 5, 9), CLUSTERS) == (2, 3)
    assert second_fold(9, ALL, CLUSTERS) == (9,)


@pytest.mark.parametrize("sampling", ["variant", "shrinking", "uniform", "twofold", "full"])
def test_the_generator_decides_and_nothing_is_nothing(sampling):
    assert sampled(sampling, ALL, 7) == sampled(sampling, ALL, 7)
    assert sampled(sampling, ()) == ()
