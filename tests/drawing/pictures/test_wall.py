import numpy as np
import pytest
from matplotlib.colors import to_hex

from drystone.drawing import plot_wall, wall_outlines
from drystone.drawing.palette import PLAIN_COLOUR, WEDGE_COLOUR, cluster_colour
from drystone.model.site import Site
from drystone.model.wall import Wall
from tests.drawing import examples
from tests.drawing.pictures.test_stones import numbers, patches
from tests.verify.exact_examples import exact_example


def test_every_stone_wedge_frame_and_ground_is_drawn_once():
    ax = plot_wall(examples.wall(), examples.CLUSTERS)
    stones = {f"stone-{i}" for i in examples.CLUSTERS}
    drawn, plain = patches(ax), patches(plot_wall(examples.wall()))
    assert set(drawn) == set(plain) == stones | {f"wedge-{examples.WEDGE}", "frame", "ground"}
    assert len(ax.patches) == len(stones) + 3
    for stone, cluster in examples.CLUSTERS.items():
        assert to_hex(drawn[f"stone-{stone}"].get_facecolor()) == cluster_colour(cluster)
        assert to_hex(plain[f"stone-{stone}"].get_facecolor()) == PLAIN_COLOUR
    assert to_hex(drawn[f"wedge-{examples.WEDGE}"].get_facecolor()) == WEDGE_COLOUR


@pytest.mark.parametrize("px_per_m", [None, 50.0])
def test_numbers_are_steps_of_the_plan_at_the_centroids(px_per_m):
    wall = examples.wall(px_per_m)
    ax = plot_wall(wall, examples.CLUSTERS)
    written = numbers(ax)
    plan = examples.plan(wall)
    assert set(written) == {str(step.step) for step in plan.stone_steps}
    for step in plan.stone_steps:
        assert written[str(step.step)].get_position() == pytest.approx(step.centroid)
    assert ax.get_xlabel() == ("px" if px_per_m is None else "m")


def test_a_step_is_counted_for_each_wedge():
    wall = examples.wall()
    groups = (wall.groups[-1], *wall.groups[:-1])
    written = numbers(plot_wall(Wall(wall.site, wall.labels.copy(), groups)))
    assert set(written) == {"1", "3", "4", "5", "6"}


def test_stones_stand_at_their_place_inside_the_frame():
    wall = examples.wall(px_per_m=50.0)
    drawn = patches(plot_wall(wall))
    units = wall.site.units_per_px
    corners = drawn["stone-12"].get_path().vertices
    l_shape = np.array([[0, 8], [12, 8], [12, 12], [6, 12], [6, 16], [0, 16], [0, 8]]) * units
    np.testing.assert_allclose(corners, l_shape)
    frame = drawn["frame"].get_path().get_extents()
    assert (frame.x0, frame.y0) == (0, 0)
    assert (frame.x1, frame.y1) == pytest.approx((44 * units, 20 * units))
    assert drawn["frame"].get_linestyle() not in ("-", "solid")


def test_outlines_replace_pixels():
    wall = examples.wall()
    outlines = wall_outlines(wall)
    outlines[3] = np.array([[0, 0], [14, 0], [7, 8]], float)
    drawn = patches(plot_wall(wall, outlines=outlines))
    vertices = drawn["stone-3"].get_path().vertices
    np.testing.assert_allclose(vertices, [[0, 0], [14, 0], [7, 8], [0, 0]])


def test_an_empty_wall_is_a_frame_on_the_ground():
    ax = plot_wall(Wall.empty(Site(30, 10)), {}, title="nothing yet")
    assert set(patches(ax)) == {"frame", "ground"}
    assert ax.get_title(loc="left") == "nothing yet"
    assert not ax.texts


@pytest.mark.parametrize(("scale", "px_per_m"), [(1.0, None), (0.5, None), (0.5, 50.0)])
def test_a_wall_of_outlines_is_drawn_by_its_outlines(scale, px_per_m):
    made = exact_example(scale, px_per_m)
    units = 1.0 / (px_per_m or 1.0)
    drawn = patches(plot_wall(made.wall))
    assert {name for name in drawn if name not in ("frame", "ground")} == {
        *(f"stone-{step.stone}" for step in made.plan.stone_steps),
        *(f"wedge-{step.id}" for step in made.plan.wedge_steps),
    }
    for block, corners in made.wall.outlines.blocks:
        name = next(gid for gid in drawn if gid.endswith(f"-{block}"))
        np.testing.assert_allclose(drawn[name].get_path().vertices[:-1], corners * units)
    frame = drawn["frame"].get_path().get_extents()
    assert (frame.x1, frame.y1) == pytest.approx((84 * units, 30 * units))
    written = numbers(plot_wall(made.wall))
    for step in made.plan.stone_steps:
        assert written[str(step.step)].get_position() == pytest.approx(step.centroid)
