"""Models of settled stones: closed forms, exact walls with gaps, and a twin by dense sampling."""

from dataclasses import replace

import numpy as np
import pytest
import shapely
from shapely.geometry.polygon import orient

from drystone.contacts.given import model_from_json
from drystone.contacts.outlines import model_of_traced
from drystone.contacts.settled import PlacedPolygons, model_of_outlines, model_with_outlines
from drystone.kernels.polygons import area_and_centroid
from drystone.kernels.raster import turn
from drystone.statics.limit import lateral_resistance
from drystone.statics.model import RigidBlockModel
from drystone.statics.result import LimitStatus
from drystone_lab.pixels import tilted_wall
from tests.polygons import box_of

MU = 0.58


def model_of(*polygons, mu=MU, tolerance=0.1, setback=0.0):
    placed = PlacedPolygons.of(enumerate(polygons, start=1))
    return model_of_outlines(placed, mu, tolerance, setback)


def alphas(model):
    found = lateral_resistance(model)
    return found.left.alpha, found.right.alpha


def statuses(model):
    found = lateral_resistance(model)
    return found.left.status, found.right.status


def settled_wall(seed, loose, lean):
    """A wall 200 high of polygons with gaps of about .01, moved and turned a little."""
    rng = np.random.default_rng(seed)
    placed = []
    for polygon in tilted_wall(rng, courses=3).polygons:
        smaller = shapely.Polygon(polygon * 200.0).buffer(
            -0.005, join_style="mitre", mitre_limit=20.0
        )
        corners = shapely.get_coordinates(orient(smaller))[:-1]
        _, x, y = area_and_centroid(corners)
        turned = turn(corners - np.array([x, y]), np.degrees(rng.uniform(-lean, lean)))
        moved = np.array([x, y + loose]) + rng.uniform(-loose, loose, 2)
        placed.append(turned + moved)
    return placed


@pytest.mark.parametrize("gap", [0.0, 0.01, 0.099])
def test_a_block_tilts_about_its_toe_whatever_the_gap(gap):
    """min(mu, b / h)."""
    assert alphas(model_of(box_of(0, gap, 20, 40))) == pytest.approx((0.5, 0.5), abs=1e-8)
    assert alphas(model_of(box_of(0, gap, 40, 20))) == pytest.approx((MU, MU), abs=1e-8)


WALLS = {
    "a quarter over": [[0, 0, 40, 20], [10, 20, 40, 20]],
    "running bond": [[0, 0, 40, 20], [40, 0, 40, 20], [20, 20, 40, 20], [60, 20, 20, 20]],
    "four joints meet": [[0, 0, 40, 20], [40, 0, 40, 20], [0, 20, 40, 20], [40, 20, 40, 20]],
    "lintel on two posts": [[0, 0, 20, 60], [80, 0, 20, 60], [0, 60, 100, 10]],
}


@pytest.mark.parametrize("name", WALLS)
@pytest.mark.parametrize("mu", [0.3, 0.58, 0.9])
def test_walls_of_boxes_are_as_strong_as_without_gaps(name, mu):
    boxes = WALLS[name]
    exact = alphas(model_from_json({"blocks_xywh": boxes, "mu": mu}))
    # Every box keeps .01 from the left, and what is below.
    level = {y: k + 1 for k, y in enumerate(sorted({y for _, y, _, _ in boxes}))}
    placed = [box_of(x + 0.01 * (x // 20), y + 0.01 * level[y], w, h) for x, y, w, h in boxes]
    assert alphas(model_of(*placed, mu=mu)) == pytest.approx(exact, abs=2e-3)


@pytest.mark.parametrize("gap", [0.0, 0.01, 0.09])
def test_a_corbel_inside_and_outside_of_its_limit(gap):
    base = box_of(0, 0.01, 40, 20)
    inside, outside = box_of(19.99, 20.01 + gap, 40, 5), box_of(20.01, 20.01 + gap, 40, 5)
    assert statuses(model_of(base, inside)) == (LimitStatus.OPTIMAL,) * 2
    assert statuses(model_of(base, outside)) == (LimitStatus.UNSTABLE,) * 2


def test_a_square_in_a_notch_slides_out_over_a_face():
    """The faces lean by 45 degrees: alpha = tan(45 degrees + friction angle)."""
    notch = np.array([[-40.0, 0.0], [40.0, 0.0], [40.0, 80.0], [0.0, 40.0], [-40.0, 80.0]])
    square = turn(box_of(0, 0, 20, 20), 45.0) + np.array([0.0, 40.0142])
    model = model_of(notch, square)
    fixed = replace(model, blocks=(replace(model.blocks[0], fixed=True), model.blocks[1]))
    expected = (1 + MU) / (1 - MU)
    assert alphas(fixed) == pytest.approx((expected, expected), abs=1e-5)


@pytest.mark.parametrize("seed", range(4))
def test_settled_walls_are_as_strong_as_those_without_gaps(seed):
    exact = alphas(tilted_wall(np.random.default_rng(seed), courses=3).model())
    for loose, lean in ((0.0, 0.0), (0.02, 1e-4)):
        placed = settled_wall(seed, loose, lean)
        assert alphas(model_of(*placed)) == pytest.approx(exact, abs=1e-3)
        closed = {i: np.vstack([c, c[:1]]) for i, c in enumerate(placed, start=1)}
        others = model_of_traced(closed, MU)
        assert alphas(model_of(*placed)) == pytest.approx(alphas(others), abs=1e-3)


def test_blocks_and_interfaces_do_not_depend_on_how_they_are_added():
    placed = settled_wall(2, 0.01, 1e-5)
    whole = model_of(*placed)
    ids = list(range(1, len(placed) + 1))
    grown = RigidBlockModel((), (), MU)
    for place in range(0, len(placed), 2):  # a stone and its wedge at a time
        around = PlacedPolygons.of(list(zip(ids, placed, strict=True))[:place])
        blocks = list(zip(ids, placed, strict=True))[place : place + 2]
        grown = model_with_outlines(grown, blocks, around, 0.1, 0.0)
    assert grown.blocks == whole.blocks
    assert told(grown) == told(whole)
    assert all(i.block > i.other for i in whole.interfaces)


def told(model):
    return [(i.block, i.other, i.points.tolist(), i.normal) for i in model.interfaces]


def test_ids_need_not_ascend():
    placed = PlacedPolygons.of([(7, box_of(0, 0.01, 4, 2)), (3, box_of(2, 2.02, 4, 2))])
    model = model_of_outlines(placed)
    assert [(i.block, i.other) for i in model.interfaces] == [(7, 0), (3, 7)]
    assert model.interfaces[1].normal == (0.0, 1.0)
