"""What each side sees grows with the wall, and is the same as seen at once."""

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from drystone.kernels.polygons import Polygons, no_polygons
from drystone.kernels.profiles import bare, raised
from drystone.model.site import Site
from drystone.planner.views import SideView, Views
from drystone.settle.rest import SettlingScene
from tests.polygons import random_polygon
from tests.strategies import repeatable

SITE = Site.from_source(60.3, 30, 0.5)


def heap(seed, count):
    rng = np.random.default_rng(seed)
    at = rng.uniform([5.0, 8.0], [55.0, 20.0], (count, 2))
    return [random_polygon(rng, 7, 10.0) + at[k] for k in range(count)]


def bits(view):
    return [part.tobytes() for part in (*view.scene.polygons, *view.profile)]


def at_once(built, side):
    scene = SettlingScene.of(built, SITE.extent_px[0], side, 0.58)
    profile = bare(SITE.width_px)
    for index in range(len(scene.polygons)):
        profile = raised(profile, scene.polygons.polygon(index), index, 1.0 / SITE.scale)
    return SideView(scene, profile, 1.0 / SITE.scale)


@repeatable(40)
@given(
    seed=st.integers(0, 2**32 - 1),
    asked=st.lists(st.tuples(st.booleans(), st.integers(0, 5), st.booleans()), max_size=6),
)
def test_a_view_does_not_depend_on_what_was_asked_for_before(seed, asked):
    """Of two walls that differ from the third stone on."""
    one, other = heap(seed, 5), heap(seed + 1, 5)
    found = Views(SITE)
    for first, count, from_left in asked:
        polygons = one if first else [*one[:2], *other[2:]]
        built = no_polygons().added(polygons[:count])
        side = "left" if from_left else "right"
        assert bits(found.of(built, side, 0.58)) == bits(at_once(built, side))


def test_a_wall_that_differs_in_the_last_bit_of_a_corner_is_another_one():
    polygons = heap(5, 2)
    found = Views(SITE)
    found.of(no_polygons().added(polygons), "left", 0.58)
    moved = polygons[0].copy()
    moved[0, 0] = np.nextafter(moved[0, 0], 99.0)
    built = no_polygons().added([moved, polygons[1]])
    assert bits(found.of(built, "left", 0.58)) == bits(at_once(built, "left"))
    split = Polygons(built.corners, np.array([0, 4, 14], np.int32), built.boxes, built.edges)
    assert found.of(split, "left", 0.58).scene.polygons.first.tolist() == [0, 4, 14]
