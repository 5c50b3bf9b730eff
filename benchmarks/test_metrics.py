"""Shortest ways along the joints (F_AV and F_AH)."""

import pytest
from tests.naive import metrics as naive

from benchmarks.conftest import Row, Timer
from benchmarks.scenes import Scene
from drystone.metrics.frame import frame_wall
from drystone.metrics.measure import measure_labels
from drystone.metrics.paths import horizontal_lengths, horizontal_paths, joint_mask, vertical_paths

PATHS = "joint paths, F_AV and F_AH"


def test_paths(timer: Timer, scene: Scene) -> None:
    """Both directions."""
    joint = joint_mask(frame_wall(scene.wall.labels).labels)
    # Ten starts each way, and every one may reach all pixels of the joints.
    each = 20.0 * int(joint.sum())
    item = "pixels of the joints, for each of 20 starts"
    row = Row(PATHS, scene.name, scene.pixels, items=each, item=item)
    timer.often(row, lambda: (horizontal_lengths(joint.T), horizontal_lengths(joint)))


def test_traced_paths(timer: Timer, scene: Scene) -> None:
    """The same with every path followed, as pictures show them."""
    joint = joint_mask(frame_wall(scene.wall.labels).labels)
    row = Row("the same, traced for pictures", scene.name, scene.pixels)
    timer.often(row, lambda: (vertical_paths(joint), horizontal_paths(joint)))


@pytest.mark.slow
def test_paths_slowly(timer: Timer, scene: Scene) -> None:
    """The same by a heap, step by step."""
    if scene.pixels > 10**6:
        pytest.skip("takes longer than everything else together")
    joint = joint_mask(frame_wall(scene.wall.labels).labels)
    row = Row(PATHS, scene.name, scene.pixels, "Dijkstra in Python")
    timer.times(1, row, lambda: [naive.vertical_arrangement(each) for each in (joint, joint.T)])


def test_measures(timer: Timer, scene: Scene) -> None:
    """All figures of merit but the resistance."""
    row = Row("all metrics but F_LR", scene.name, scene.pixels)
    timer.often(row, lambda: measure_labels(scene.wall.labels))
