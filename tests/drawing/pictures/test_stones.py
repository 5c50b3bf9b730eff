"""Stones, label images and ways along joints."""

from dataclasses import replace

import numpy as np
import pytest
from matplotlib.colors import to_hex
from matplotlib.figure import Figure

from drystone.drawing import plot_joint_paths, plot_labels, plot_stones
from drystone.drawing.palette import PLAIN_COLOUR, cluster_colour, text_colour
from drystone.model.stone import Source, StoneSet
from tests.drawing import examples

CLUSTERS = examples.CLUSTERS | {examples.UNUSED: 3}


def patches(ax):
    return {patch.get_gid(): patch for patch in ax.patches}


def numbers(ax):
    return {text.get_text(): text for text in ax.texts}


def test_stones_have_the_colour_of_their_cluster():
    ax = plot_stones(examples.stone_set(), CLUSTERS)
    colours = {gid: to_hex(patch.get_facecolor()) for gid, patch in patches(ax).items()}
    assert colours == {f"stone-{i}": cluster_colour(c) for i, c in CLUSTERS.items()}
    legend = [text.get_text() for text in ax.get_legend().get_texts()]
    assert legend == ["cluster 1", "cluster 2", "cluster 3"]


def test_ids_are_written_at_the_centroids_in_a_readable_colour():
    stones = examples.stone_set()
    written = numbers(plot_stones(stones, CLUSTERS))
    assert set(written) == {str(stone.id) for stone in stones}
    for stone in stones:
        text = written[str(stone.id)]
        assert text.get_position() == pytest.approx(stone.centroid)
        assert text.get_color() == text_colour(cluster_colour(CLUSTERS[stone.id]))


def test_numbers_shrink_with_the_stone():
    written = numbers(plot_stones(examples.stone_set(), CLUSTERS))
    sizes = {number: text.get_size() for number, text in written.items()}
    assert sizes["40"] <= sizes["300"] <= sizes["3"]
    small = StoneSet(tuple(examples.stone_set()), Source(width_px=5000, height_px=500))
    assert numbers(plot_stones(small))["3"].get_size() < sizes["3"]


def test_stones_lie_where_they_lie_in_the_image():
    stones = examples.stone_set()
    ax = plot_stones(stones)
    for stone in stones:
        patch = patches(ax)[f"stone-{stone.id}"]
        corners = np.array([stone.left_px, stone.bottom_px])
        vertices = patch.get_path().vertices
        np.testing.assert_allclose(vertices.min(axis=0), corners, atol=0.51)
        assert to_hex(patch.get_facecolor()) == PLAIN_COLOUR
    assert ax.get_legend() is None


def test_stones_of_a_folder_do_not_cover_each_other():
    stones = tuple(replace(s, left_px=0, bottom_px=0) for s in examples.stone_set())
    ax = plot_stones(StoneSet(stones, Source(files=tuple(f"{s.id}.png" for s in stones))))
    boxes = [patch.get_path().get_extents() for patch in ax.patches]
    assert len(boxes) == len(stones)
    for index, box in enumerate(boxes):
        assert not any(box.overlaps(other) for other in boxes[:index])
        assert ax.dataLim.x0 >= 0
    assert ax.get_xlim()[1] > max(box.x1 for box in boxes)
    assert ax.get_ylim()[1] > max(box.y1 for box in boxes)


def test_given_axes_are_used():
    ax = Figure().subplots()
    assert plot_stones(examples.stone_set(), ax=ax) is ax
    assert len(ax.patches) == len(examples.stone_set())


def test_labels_are_drawn_with_their_ids():
    labels = np.array([[0, 70_000], [300, 70_000]], np.uint32)
    ax = plot_labels(labels, title="two")
    assert set(patches(ax)) == {"block-300", "block-70000"}
    written = numbers(ax)
    assert written["300"].get_position() == (0.5, 0.5)
    assert written["70000"].get_position() == (1.5, 1.0)
    assert len({to_hex(patch.get_facecolor()) for patch in ax.patches}) == 2
    assert ax.get_title(loc="left") == "two"


def test_paths_run_through_the_centres_of_their_pixels():
    labels = examples.wall().labels
    down = np.array([[-1, 13], [0, 13], [1, 14], [19, 14]])
    across = np.array([[11, 0], [11, 43]])
    ax = plot_joint_paths(labels, [down, across])
    lines = {line.get_gid(): line.get_segments()[0] for line in ax.collections}
    np.testing.assert_allclose(
        lines["path-1"], [[13.5, 20.5], [13.5, 19.5], [14.5, 18.5], [14.5, 0.5]]
    )
    np.testing.assert_allclose(lines["path-2"], [[0.5, 8.5], [43.5, 8.5]])
    assert set(patches(ax)) == {f"block-{i}" for i in np.unique(labels) if i}


def test_no_path_leaves_the_stones():
    ax = plot_joint_paths(examples.wall().labels, [])
    assert not ax.collections
    assert len(ax.patches) == 6
