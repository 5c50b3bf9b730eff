"""Images of walls beside their plans."""

import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import drystone as ds
from drystone.errors import InputError
from drystone.io.wall_image import write_labels, write_wall_image
from drystone.io.walls import _seen, read_wall, shows
from drystone.poses import PoseBook
from tests.strategies import repeatable, stones
from tests.verify.examples import L_STONE, SLAB, WEDGE, example
from tests.verify.tampering import moved, reshaped, swapped

PLANNED = [3, 5, SLAB, L_STONE, 300, WEDGE]


@pytest.mark.parametrize(
    ("seen", "raster", "exact"),
    [
        (PLANNED, True, True),
        (PLANNED[:-1], False, True),  # a wedge that fills no pixel
        (PLANNED[1:], False, False),
        ([*PLANNED[:-1], 8], False, False),
        ([*PLANNED, 8], False, False),
    ],
)
def test_an_image_shows_what_is_in_the_plan(seen, raster, exact):
    labels, plan = np.array([[0, *seen]], np.uint32), example().plan
    assert shows(labels, plan) is raster
    assert shows(labels, replace(plan, settings={"geometry": "exact"})) is exact


def written(made, plan, folder):
    """A plan on pixels with the image of a wall that may be another."""
    ds.write_plan(plan, folder / "plan.json")
    write_wall_image(made.wall.labels, folder)
    return folder


@pytest.mark.parametrize(
    ("scale", "px_per_m"), [(1.0, None), (1.0, 137.0), (0.5, None), (0.5, 200.0)]
)
def test_a_plan_on_pixels_has_its_stones_where_they_are_seen(scale, px_per_m, tmp_path):
    made = example(scale, px_per_m)
    assert read_wall(written(made, made.plan, tmp_path)).plan == made.plan
    off = moved(made.plan, L_STONE, 2.5 / (scale * (px_per_m or 1.0)), 0)
    with pytest.raises(InputError, match=f"shows {L_STONE} in another place") as caught:
        read_wall(written(made, off, tmp_path))
    assert caught.value.code == "E133"


ELSEWHERE = {
    "ids swapped": lambda p: swapped(p, 3, 300),
    "stone lifted": lambda p: moved(p, 3, 0, 10),
    "wedge elsewhere": lambda p: reshaped(p, lambda w: w - (3, 0)),
    "wedge without an area": lambda p: reshaped(p, lambda w: w * (1, 0)),
}


@pytest.mark.parametrize("name", ELSEWHERE)
def test_other_places_are_refused(name, tmp_path):
    made = example()
    with pytest.raises(InputError, match="E133"):
        read_wall(written(made, ELSEWHERE[name](made.plan), tmp_path))


def test_an_image_that_is_far_too_large_for_the_plan_is_not_decoded(tmp_path):
    made = example()
    folder = written(made, made.plan, tmp_path)
    write_labels(np.ones((1001, 1000), np.uint8), next(folder.glob("wall.*")))
    with pytest.raises(InputError, match=r"E110 wall.png: .* the limit is 1 million"):
        read_wall(folder)


def test_half_a_px_is_no_other_place(tmp_path):
    made = example()
    plan = moved(made.plan, L_STONE, 0.5, -0.5)
    assert read_wall(written(made, plan, tmp_path)).plan == plan


@repeatable(150)
@given(
    stones(stone_id=6, max_px=30),
    st.floats(-180.0, 179.9),
    st.sampled_from([1.0, 0.7, 0.3, 0.1, 0.04]),
)
def test_no_pose_of_the_planner_is_in_another_place(stone, angle_deg, scale):
    posed = PoseBook(scale).pose(stone, angle_deg)
    labels = np.pad(posed.mask.astype(np.uint32) * 6, ((2, 3), (4, 1)))
    (found, (centroid, allowed)) = next(iter(_seen(labels).items()))
    assert found == 6
    off = math.dist(centroid, (posed.anchor[0] + 4, posed.anchor[1] + 3))
    assert off <= allowed


def test_centroids_are_those_of_pixel_squares():
    labels = np.array([[0, 5, 5, 0], [9, 5, 5, 5], [9, 0, 0, 2**32 - 1]], np.uint32)
    seen = {block: place for block, (place, _) in _seen(labels).items()}
    assert seen[5] == pytest.approx((11.5 / 5, 9.5 / 5))
    assert seen[9] == pytest.approx((0.5, 1.0))
    assert seen[2**32 - 1] == pytest.approx((3.5, 0.5))
    assert _seen(np.zeros((3, 4), np.uint32)) == {}
    square = np.zeros((40, 50), np.uint32)
    square[5:25, 8:28] = 1
    assert _seen(square)[1][1] == pytest.approx(0.5 + 4 / 6)
