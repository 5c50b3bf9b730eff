"""What is measured of an image: the wall in it, ways along its joints, stones, top and ends."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from PIL import Image

from drystone.errors import LabelImageError, UsageError
from drystone.metrics import paths
from drystone.metrics.frame import frame_wall, reduce_labels
from drystone.metrics.measure import measure_labels
from drystone.metrics.paths import joint_mask
from drystone.metrics.shape import flush_deviation, level_deviation, stone_sizes
from tests.metrics.walls import bricks, walls
from tests.naive import metrics as naive
from tests.strategies import repeatable


@pytest.mark.parametrize(
    ("left", "width", "width_px", "ends", "stone"),
    [
        (7, 6, None, (0.0, 6.0), range(6)),
        # An image as wide as the wall keeps its columns; in another the stones are in the middle.
        (7, 6, 30.4, (0.0, 30.0), range(7, 13)),
        (20, 6, 11, (0.0, 11.0), range(2, 8)),
        # Stones wider than the wall stick out on both sides.
        (20, 9, 6, (1.5, 7.5), range(9)),
    ],
)
def test_end_lines(left, width, width_px, ends, stone):
    labels = np.zeros((20, 30), np.uint32)
    labels[5:9, left : left + width] = 3
    frame = frame_wall(labels, width_px)
    assert (frame.left_px, frame.right_px) == ends
    assert len(frame.labels) == 4
    assert frame.labels.shape[1] == max(len(stone), ends[1] - ends[0])
    assert np.flatnonzero(frame.labels[0]).tolist() == list(stone)


@repeatable()
@given(walls(), st.floats(0.05, 2.5) | st.sampled_from([0.5, 1.0]))
def test_reduced_is_its_slow_twin_and_a_copy(labels, scale):
    reduced = reduce_labels(labels, scale)
    assert np.array_equal(reduced, naive.reduce_labels(labels, scale))
    assert reduced.dtype == labels.dtype
    assert not np.shares_memory(reduced, labels)
    with pytest.raises(ValueError, match="scale must be positive"):
        reduce_labels(labels, 0.0)


@repeatable()
@given(walls(), st.data())
def test_sizes_are_those_of_the_slow_twin(labels, data):
    ids = sorted({int(value) for value in labels.ravel()} - {0})
    wedges = data.draw(st.sets(st.sampled_from(ids), max_size=len(ids) - 1))
    sizes = stone_sizes(labels, wedges)
    assert sizes.count == len(ids) - len(wedges)
    assert sizes.area_px == sum(int((labels == i).sum()) for i in ids if i not in wedges)
    means = sizes.mean_height_px, sizes.mean_width_px
    assert means == pytest.approx(naive.mean_sizes(labels, wedges))


@repeatable()
@given(walls(), st.floats(1, 50), st.floats(1, 50))
def test_level_and_flush_are_their_slow_twins(labels, wall_width, stone_px):
    expected = naive.level_deviation(labels, stone_px)
    assert level_deviation(labels, stone_px) == pytest.approx(expected, abs=1e-12)
    frame = frame_wall(labels, wall_width)
    expected = naive.flush_deviation(frame.labels, frame.left_px, frame.right_px, stone_px)
    assert flush_deviation(frame, stone_px) == pytest.approx(expected, abs=1e-12)


@repeatable()
@given(walls())
def test_pixels_lead_along_the_joints_from_top_to_bottom(labels):
    joint = joint_mask(labels)
    for path in paths.vertical_paths(joint):
        rows, cols = path.pixels.T
        assert joint[rows, cols].all()
        assert (rows[0], rows[-1]) == (0, joint.shape[0] - 1)
        assert cols[0] == cols[-1]
        steps = np.abs(np.diff(path.pixels, axis=0))
        assert (steps.max(axis=1) == 1).all()
        assert path.length_px == pytest.approx(np.hypot(*steps.T).sum())
    turned = paths.horizontal_paths(joint.T)
    assert paths.horizontal_lengths(joint.T) == tuple(path.length_px for path in turned)
    upright = [path.pixels.tolist() for path in paths.vertical_paths(joint)]
    assert [path.pixels[:, ::-1].tolist() for path in turned] == upright


def test_starts_stand_ten_pixels_from_the_ends_and_a_tenth_of_the_width_apart():
    columns = [path.pixels[0, 1] for path in paths.vertical_paths(np.ones((5, 57), bool))]
    assert columns == [10, 15, 20, 25, 30, 35, 40, 45]
    assert paths.vertical_paths(np.ones((5, 20), bool)) == ()


@pytest.mark.parametrize("stone", [(2, slice(None)), (0, 10)], ids=["across", "at the start"])
def test_where_a_stone_is_in_the_way_there_is_no_path(stone):
    joint = np.ones((5, 21), bool)
    joint[stone] = False
    assert paths.vertical_paths(joint) == paths.horizontal_paths(joint.T) == ()
    assert paths.vertical_arrangement(joint) is None


@repeatable(60)
@given(walls(max_px=36))
def test_joints_and_arrangements_are_their_slow_twins(labels):
    joint = joint_mask(labels)
    assert np.array_equal(joint, naive.joint_mask(labels))
    found = paths.vertical_arrangement(joint), paths.horizontal_arrangement(joint)
    for each, way in zip(found, (joint, joint.T), strict=True):
        assert each == pytest.approx(naive.vertical_arrangement(way), abs=1e-9)


@pytest.mark.parametrize(
    ("name", "scale", "stones", "expected"),
    [
        ("R", 0.2, 34, (0.846, 33.95, 0.59)),
        ("PR", 0.5, 32, (0.808, 29.50, 1.50)),
        ("IR", 0.3, 61, (0.850, 23.77, 3.69)),
    ],
)
def test_walls_of_the_masons(data_dir, name, scale, stones, expected):
    """F_SF, F_AV and F_AH measured when the definition was fixed, to their rounding."""
    with Image.open(data_dir / "almeida" / f"{name}.png") as picture:
        pixels = np.asarray(picture)
    ids = pixels if pixels.ndim == 2 else pixels[..., 0]
    metrics = measure_labels(reduce_labels(ids, scale))
    assert metrics.stones == stones
    assert (round(metrics.F_SF, 3), round(metrics.F_AV, 2), round(metrics.F_AH, 2)) == expected


def test_a_full_wall_and_one_whose_wedges_are_no_stones():
    labels = bricks(4, 5, 12, 30)
    metrics = measure_labels(labels, lateral_resistance=0.7)
    assert (metrics.F_SF, metrics.F_LR, metrics.stones) == (1.0, 0.7, 22)
    assert (metrics.width, metrics.height) == (150.0, 48.0)
    assert (metrics.T_LEVEL, metrics.E_FLUSH) == (0.0, 0.0)
    better_known = measure_labels(labels, stone_area_px=7000.0)
    assert abs(better_known.F_SF - 7000 / 7200) < 1e-12
    planned = measure_labels(labels, wall_px=(200.0, 60.0))
    assert abs(planned.F_SF - 150 * 48 / (200 * 60)) < 1e-12
    assert (planned.width, planned.height) == (200.0, 60.0)
    assert abs(planned.E_FLUSH - 25 / np.mean([30] * 18 + [15] * 4)) < 1e-12
    labels[40:44, 60:70] = 99
    wedged = measure_labels(labels, wedge_ids={99})
    assert (wedged.stones, wedged.T_LEVEL) == (22, 0.0)
    assert abs(wedged.F_SF - (7200 - 40) / 7200) < 1e-12


@repeatable()
@given(walls(max_px=40), st.integers(0, 9), st.integers(0, 9))
def test_empty_space_around_the_wall_and_numbers_of_stones_change_nothing(labels, rows, cols):
    padded = np.pad(labels, ((rows, 9 - rows), (cols, 9 - cols)))
    assert measure_labels(padded) == measure_labels(labels)
    # So do wedges without a pixel, and what is masked.
    nowhere = np.ma.masked_equal(np.where(padded > 0, padded, 999), 999)
    assert measure_labels(nowhere, wedge_ids={999}) == measure_labels(labels)
    ids, numbers = np.unique(labels, return_inverse=True)
    shift = 0 if ids[0] == 0 else 1
    renumbered = (numbers.reshape(labels.shape) + shift).astype(np.uint8)
    assert measure_labels(renumbered) == measure_labels(labels)


def test_no_room_no_stones_no_ids_and_too_few_pixels_for_paths():
    odd = (5,), (), (1, 2, 3)
    for size in (*odd, (0.0, 80.0), (280.0, -1.0), (np.nan, 80.0), (280.0, np.inf), (1e9, 80.0)):
        with pytest.raises(UsageError, match="E121"):
            measure_labels(bricks(2, 2, 5, 8), wall_px=size)
    for wrong in (-3, np.nan, np.inf):
        for name in ("stone_area_px", "lateral_resistance"):
            with pytest.raises(UsageError, match=f"E138 {name}: it must be finite and 0 or more"):
                measure_labels(bricks(2, 2, 5, 8), **{name: wrong})
    metrics = measure_labels(np.ones((6, 6), np.uint32))
    assert (metrics.F_AV, metrics.F_AH) == (None, None)
    with pytest.raises(LabelImageError, match=r"E104 .*30x20 px are 0"):
        measure_labels(np.zeros((20, 30), np.uint32))
    with pytest.raises(LabelImageError, match=r"E104 .*background or wedges"):
        measure_labels(np.full((4, 4), 9, np.uint32), wedge_ids={9})
    with pytest.raises(LabelImageError, match=r"E301 labels: .* is not a picture of ids"):
        measure_labels(bricks(2, 2, 5, 8) > 1)
