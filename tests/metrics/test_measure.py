import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from PIL import Image

from drystone.errors import LabelImageError, UsageError
from drystone.metrics.frame import reduce_labels
from drystone.metrics.measure import measure_labels
from tests.metrics.walls import bricks, walls
from tests.strategies import repeatable


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


def test_a_full_wall():
    metrics = measure_labels(bricks(4, 5, 12, 30), lateral_resistance=0.7)
    assert (metrics.F_SF, metrics.F_LR, metrics.stones) == (1.0, 0.7, 22)
    assert (metrics.width, metrics.height) == (150.0, 48.0)
    assert (metrics.T_LEVEL, metrics.E_FLUSH) == (0.0, 0.0)
    better_known = measure_labels(bricks(4, 5, 12, 30), stone_area_px=7000.0)
    assert abs(better_known.F_SF - 7000 / 7200) < 1e-12
    planned = measure_labels(bricks(4, 5, 12, 30), wall_px=(200.0, 60.0))
    assert abs(planned.F_SF - 150 * 48 / (200 * 60)) < 1e-12
    assert (planned.width, planned.height) == (200.0, 60.0)
    assert abs(planned.E_FLUSH - 25 / np.mean([30] * 18 + [15] * 4)) < 1e-12


def test_wedges_are_no_stones_but_joints_run_around_them():
    labels = bricks(4, 5, 12, 30)
    wedged = labels.copy()
    wedged[40:44, 60:70] = 99
    plain, metrics = measure_labels(labels), measure_labels(wedged, wedge_ids={99})
    assert metrics.stones == plain.stones
    assert abs(metrics.F_SF - (7200 - 40) / 7200) < 1e-12
    assert metrics.T_LEVEL == 0.0


@repeatable()
@given(walls(max_px=40), st.integers(0, 9), st.integers(0, 9))
def test_empty_space_around_the_wall_and_numbers_of_stones_change_nothing(labels, rows, cols):
    padded = np.pad(labels, ((rows, 9 - rows), (cols, 9 - cols)))
    assert measure_labels(padded) == measure_labels(labels)
    ids, numbers = np.unique(labels, return_inverse=True)
    shift = 0 if ids[0] == 0 else 1
    renumbered = (numbers.reshape(labels.shape) + shift).astype(np.uint8)
    assert measure_labels(renumbered) == measure_labels(labels)


def test_a_wall_without_room_without_stones_and_with_too_few_for_paths():
    for size in ((0.0, 80.0), (280.0, -1.0), (np.nan, 80.0), (280.0, np.inf), (1e9, 80.0)):
        with pytest.raises(UsageError, match="E121"):
            measure_labels(bricks(2, 2, 5, 8), wall_px=size)
    metrics = measure_labels(np.ones((6, 6), np.uint32))
    assert (metrics.F_AV, metrics.F_AH) == (None, None)
    with pytest.raises(LabelImageError, match="E104"):
        measure_labels(np.zeros((10, 10), np.uint32))


@pytest.mark.parametrize(
    "labels",
    [
        bricks(2, 2, 5, 8).astype(float),
        bricks(2, 2, 5, 8) > 1,
        -bricks(2, 2, 5, 8).astype(int),
        np.ones((9, 9, 3), int),
        np.ones(9, int),
    ],
    ids=["floats", "a mask", "below 0", "colours", "a line"],
)
def test_what_is_no_picture_of_ids(labels):
    with pytest.raises(LabelImageError, match=r"E301 labels: .* is not a picture of ids"):
        measure_labels(labels)
