"""Stones, label images, ways along joints, planned walls and walls to choose from."""

from dataclasses import replace
from itertools import combinations

import numpy as np
import pytest
from matplotlib.colors import to_hex
from matplotlib.figure import Figure

from drystone.drawing import plot_choice, plot_joint_paths, plot_labels, plot_stones, plot_wall
from drystone.drawing.outlines import label_regions
from drystone.drawing.palette import PLAIN_COLOUR, WEDGE_COLOUR, cluster_colour, text_colour
from drystone.drawing.pictures.wall import COLUMNS
from drystone.model.site import Site
from drystone.model.stone import Source, StoneSet
from drystone.model.wall import Wall
from tests.drawing import examples
from tests.verify.exact_examples import exact_example
from tests.verify.examples import example, stone_set

CLUSTERS = examples.CLUSTERS | {examples.UNUSED: 3}


def patches(ax):
    return {patch.get_gid(): patch for patch in ax.patches}


def numbers(ax):
    return {text.get_text(): text for text in ax.texts}


def test_stones_lie_as_in_the_image_with_their_id_in_a_readable_colour():
    stones, where = stone_set(), Figure().subplots()
    ax = plot_stones(stones, CLUSTERS, where)
    assert ax is where
    colours = {gid: to_hex(patch.get_facecolor()) for gid, patch in patches(ax).items()}
    assert colours == {f"stone-{i}": cluster_colour(c) for i, c in CLUSTERS.items()}
    legend = [text.get_text() for text in ax.get_legend().get_texts()]
    assert legend == ["cluster 1", "cluster 2", "cluster 3"]
    written = numbers(ax)
    assert set(written) == {str(stone.id) for stone in stones}
    for stone in stones:
        text = written[str(stone.id)]
        assert text.get_position() == pytest.approx(stone.centroid)
        assert text.get_color() == text_colour(cluster_colour(CLUSTERS[stone.id]))
        corner = patches(ax)[f"stone-{stone.id}"].get_path().vertices.min(axis=0)
        np.testing.assert_allclose(corner, [stone.left_px, stone.bottom_px], atol=0.51)
    plain = plot_stones(stones)
    assert {to_hex(patch.get_facecolor()) for patch in plain.patches} == {PLAIN_COLOUR}
    assert plain.get_legend() is None


def test_stones_of_a_folder_do_not_cover_each_other():
    stones = tuple(replace(s, left_px=0, bottom_px=0) for s in stone_set())
    ax = plot_stones(StoneSet(stones, Source(files=tuple(f"{s.id}.png" for s in stones))))
    boxes = [patch.get_path().get_extents() for patch in ax.patches]
    assert len(boxes) == len(stones)
    assert not any(one.overlaps(other) for one, other in combinations(boxes, 2))
    assert ax.get_xlim()[1] > max(box.x1 for box in boxes)
    assert ax.get_ylim()[1] > max(box.y1 for box in boxes)


def test_blocks_have_their_ids_and_paths_run_through_the_centres_of_pixels():
    labels = examples.wall().labels
    down = np.array([[-1, 13], [0, 13], [1, 14], [29, 14]])
    across = np.array([[11, 0], [11, 83]])
    ax = plot_joint_paths(labels, [down, across])
    lines = {line.get_gid(): line.get_segments()[0].tolist() for line in ax.collections}
    assert lines["path-1"] == [[13.5, 30.5], [13.5, 29.5], [14.5, 28.5], [14.5, 0.5]]
    assert lines["path-2"] == [[0.5, 18.5], [83.5, 18.5]]
    assert set(patches(ax)) == {f"block-{i}" for i in np.unique(labels) if i}
    ax = plot_labels(np.array([[0, 70_000], [300, 70_000]], np.uint32))
    assert set(patches(ax)) == {"block-300", "block-70000"}
    written = {number: text.get_position() for number, text in numbers(ax).items()}
    assert written == {"300": (0.5, 0.5), "70000": (1.5, 1.0)}
    assert len({to_hex(patch.get_facecolor()) for patch in ax.patches}) == 2


def test_every_stone_wedge_frame_and_ground_is_drawn_once():
    ax = plot_wall(examples.wall(), examples.CLUSTERS)
    stones = {f"stone-{i}" for i in examples.CLUSTERS}
    drawn = {gid: to_hex(patch.get_facecolor()) for gid, patch in patches(ax).items()}
    assert set(drawn) == stones | {f"wedge-{examples.WEDGE}", "frame", "ground"}
    assert len(ax.patches) == len(stones) + 3
    for stone, cluster in examples.CLUSTERS.items():
        assert drawn[f"stone-{stone}"] == cluster_colour(cluster)
    assert drawn[f"wedge-{examples.WEDGE}"] == WEDGE_COLOUR
    plain = patches(plot_wall(examples.wall()))
    assert to_hex(plain["stone-3"].get_facecolor()) == PLAIN_COLOUR
    # The frame is that of the wall, not of its working px.
    empty = plot_wall(Wall.empty(Site.from_source(31, 9, scale=0.1)), {}, title="nothing yet")
    assert set(patches(empty)) == {"frame", "ground"}
    assert patches(empty)["frame"].get_path().get_extents().bounds == (0.0, 0.0, 31.0, 9.0)
    assert empty.get_title(loc="left") == "nothing yet"
    assert not empty.texts


WALLS = (example(1.0), example(1.0, 50.0), exact_example(1.0), exact_example(0.5, 50.0))


@pytest.mark.parametrize("made", WALLS, ids=["pixels", "pixels, m", "outlines", "outlines, m"])
def test_stones_and_wedges_stand_at_their_place_with_the_steps_of_the_plan_as_numbers(made):
    ax, px_per_m = plot_wall(made.wall), made.plan.px_per_m
    written = {number: text.get_position() for number, text in numbers(ax).items()}
    steps = {str(step.step): pytest.approx(step.centroid) for step in made.plan.stone_steps}
    assert written == steps
    drawn, wedges = patches(ax), {step.id for step in made.plan.wedge_steps}
    if made.wall.outlines is None:
        blocks = [(one.id, one.loops[0]) for one in label_regions(made.wall.labels)]
    else:
        blocks = made.wall.outlines.blocks
    for block, corners_px in blocks:
        path = drawn[f"{'wedge' if block in wedges else 'stone'}-{block}"].get_path()
        np.testing.assert_allclose(path.vertices[:-1] * (px_per_m or 1.0), corners_px)
    assert ax.get_xlabel() == ("px" if px_per_m is None else "m")
    frame = drawn["frame"].get_path().get_extents().get_points().ravel()
    assert frame * (px_per_m or 1.0) == pytest.approx([0, 0, 84, 30])


@pytest.mark.parametrize("count", [1, COLUMNS, COLUMNS + 1])
def test_every_wall_has_its_picture_and_its_points(count):
    wall = examples.wall()
    usual = {"F_AV": 20.0, "F_AH": 2.0, "F_LR": 0.5}
    values = [{"F_SF": 0.8 + 0.01 * k, **usual} for k in range(count)]
    figure = plot_choice([wall] * count, [*values[:-1], {**values[-1], "F_AV": None}])
    *walls, one, two = figure.axes
    blocks = len(wall.placements) + len(wall.wedges)
    assert [len(ax.patches) for ax in walls] == [blocks + 1] * count
    title = f"{count:02}  F_SF {0.79 + 0.01 * count:.3f}  F_AV -  F_AH 2.00  F_LR 0.50"
    assert walls[-1].get_title(loc="left") == title
    assert (one.get_xlabel(), one.get_ylabel()) == ("F_SF", "F_LR")
    assert (two.get_xlabel(), two.get_ylabel()) == ("F_AV", "F_AH")
    assert [line.get_xdata()[0] for line in one.lines] == [v["F_SF"] for v in values]
    assert [text.get_text() for text in one.texts] == [f"{k:02}" for k in range(1, count + 1)]
    assert len(two.lines) == count - 1  # what is not defined is left out
