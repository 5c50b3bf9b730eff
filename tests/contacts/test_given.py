import math

import numpy as np
import pytest
import shapely
import shapely.ops
from hypothesis import assume, given
from hypothesis import strategies as st

from drystone.contacts.given import model_from_json, polygons_from_json, refuse_astray
from drystone.errors import InputError
from drystone.statics.limit import lateral_resistance
from drystone.statics.model import GROUND
from tests.polygons import outlines_along_a_line
from tests.statics.walls import boxes, told
from tests.strategies import repeatable


def square(x, y, size=2.0):
    return [[x, y], [x + size, y], [x + size, y + size], [x, y + size]]


def model_of(*polygons):
    """The model of some polygons, numbered from 1."""
    listed = enumerate((np.asarray(polygon).tolist() for polygon in polygons), 1)
    return model_from_json({"blocks": [{"id": i, "polygon": p} for i, p in listed]})


def test_rectangles_touch_along_bed_and_head_joints():
    model = model_from_json({"blocks_xywh": [[0, 0, 2, 1], [2, 0, 2, 1], [1, 1, 2, 1]], "mu": 0.65})
    assert model.mu == 0.65
    told_of = [(block.id, block.area, block.centroid) for block in model.blocks]
    assert told_of == [(1, 2, (1, 0.5)), (2, 2, (3, 0.5)), (3, 2, (2, 1.5))]
    assert told(model.interfaces) == [
        (1, GROUND, [(0, 0), (2, 0)], (0, 1)),
        (2, GROUND, [(2, 0), (4, 0)], (0, 1)),
        (2, 1, [(2, 1), (2, 0)], (1, 0)),
        (3, 1, [(1, 1), (2, 1)], (0, 1)),
        (3, 2, [(2, 1), (3, 1)], (0, 1)),
    ]


def test_polygons_in_either_sense_with_density_and_fixed():
    fixed = {"id": 7, "polygon": square(0, 0), "fixed": True}
    dense = {"id": 3, "polygon": square(0, 2)[::-1], "density": 2.5}
    model = model_from_json({"blocks": [fixed, dense]})
    assert model.mu == 0.58
    assert [(b.id, b.weight, b.fixed) for b in model.blocks] == [(7, 4, True), (3, 10, False)]
    assert model_from_json({"blocks": [{**fixed, "density": 1e9}, dense]}).blocks[0].weight == 4e9
    assert told(model.interfaces) == [
        (7, 3, [(2, 2), (0, 2)], (0, -1)),
    ]


UP, DOWN = (0, 1), (0, -1)
ROOF, BEAM = [[0, 0], [4, 0], [2, 2]], [[0, 2], [4, 2], [4, 3], [0, 3]]
ON_GROUND = (1, GROUND, [(0, 0), (2, 0)], UP)


@pytest.mark.parametrize(
    ("polygons", "contacts"),
    [
        # Blocks that meet only at a corner do not touch.
        ([square(0, 0), square(2, 2)], [ON_GROUND]),
        # A corner on the ground, or on an edge, is a contact at a point.
        ([[[0, 0], [1, 1], [0, 2], [-1, 1]]], [(1, GROUND, [(0, 0)], UP)]),
        ([ROOF, BEAM], [(1, GROUND, [(0, 0), (4, 0)], UP), (2, 1, [(2, 2)], UP)]),
        ([BEAM, ROOF], [(2, GROUND, [(0, 0), (4, 0)], UP), (2, 1, [(2, 2)], DOWN)]),
        # So is what is left where a gap opens along an edge.
        (
            [square(0, 0), [[0.5, 2], [1.5, 2.0005], [1.5, 3], [0.5, 3]]],
            [ON_GROUND, (2, 1, [(0.5, 2)], UP)],
        ),
        # A closed polygon with a corner that is repeated.
        ([[[0, 0], *square(0, 0), [0, 0]]], [ON_GROUND]),
    ],
)
def test_what_touches_where(polygons, contacts):
    assert told(model_of(*polygons).interfaces) == contacts


@pytest.mark.parametrize(("far", "size"), [(5.0, 1.0), (2e6, 1e-3), (1e8, 1e3)])
def test_a_far_block_changes_no_answer_nearby(far, size):
    for gap, stands in ((0.0, True), (1e-6 * size, True), (1e-3 * size, False)):
        rows = [[0, 0, size, size], [0, size + gap, size, size], [far * size, 0, size, size]]
        both = lateral_resistance(model_from_json({"blocks_xywh": rows, "mu": 0.58}))
        assert both.stable == stands
        if stands:
            assert both.right.alpha == pytest.approx(0.5, abs=1e-5)


@given(
    seed=st.integers(0, 10**6),
    size=st.sampled_from([1e-3, 1.0, 1e3]),
    far=st.sampled_from([0.0, 1e3, 1e6]),
    angle_deg=st.floats(0.0, 180.0),
)
@repeatable(40)
def test_two_halves_of_a_polygon_touch_and_do_not_overlap(seed, size, far, angle_deg):
    """However rounding turns their common edge."""
    angles = np.sort(np.random.default_rng(seed).random(8)) * 2.0 * np.pi
    corners = np.column_stack((np.cos(angles), 2.0 + np.sin(angles)))
    turn = math.radians(angle_deg)
    normal = np.array([math.cos(turn), math.sin(turn)])
    middle, along = corners.mean(axis=0), 9.0 * np.array([-normal[1], normal[0]])
    cut = shapely.LineString([middle - along, middle + along])
    whole = shapely.Polygon(corners)
    halves = shapely.ops.split(whole, cut).geoms
    edge = whole.intersection(cut).length
    areas = [half.area for half in halves]
    assume(len(halves) == 2 and min(areas) > 1e-3 and edge > 0.05)
    first, second = map(shapely.get_coordinates, halves)
    into = normal * np.sign((first.mean(axis=0) - middle) @ normal)

    def model(deep):
        """Push the second half into the first by so many tolerances."""
        shift = deep * 1e-5 * math.sqrt(min(areas)) * into
        return model_of(*((size * half + [size * far, 0.0]) for half in (first, second + shift)))

    for deep in (0.0, 0.8, -0.8):
        (joint,) = (i for i in model(deep).interfaces if i.other == 1)
        assert joint.length == pytest.approx(size * edge, rel=1e-2)
    with pytest.raises(InputError, match="blocks 1 and 2 overlap"):
        model(3.0)
    assert not any(i.other == 1 and i.length for i in model(-1.5).interfaces)


@pytest.mark.parametrize("last", [(-1e-17, 0.0), (0.0, 1e-13), (-1e-16, 1e-16)])
def test_a_closing_corner_but_for_rounding_is_read(last):
    """Each of both was on the line through the other, and the block lost half of its area."""
    model = model_of([*square(0, 0), last])
    assert model.blocks[0].area == pytest.approx(4.0)
    assert lateral_resistance(model).value == pytest.approx(1.0)


PAIR = {"blocks_xywh": [[0, 0, 2, 1], [0, 1, 2, 1]]}


def one_block(**parts):
    return {"blocks": [{"id": 1, "polygon": square(0, 0), **parts}]}


PAIRLESS = [1, 9], [1, 1], [[1], 0], [True, 0], ["1", 0], [1], 10
MALFORMED = [
    {},
    {"blocks_xywh": 3},
    {"blocks_xywh": [[0, 0, 1]]},
    *({"blocks_xywh": [[0, 0, 1, wrong]]} for wrong in ("wide", "1.0", b"1", True, np.True_, None)),
    {"blocks_xywh": [[0, 0, 1, math.nan]]},
    {"blocks_xywh": [[0, 0, 1, 0]]},
    {"blocks_xywh": [[0, 0, 1, 10**400]]},
    {"blocks": [{"id": 1}]},
    {"blocks": [7]},
    {"blocks": [{"polygon": square(0, 0)}]},
    {"blocks": [{"id": 1, "polygon": square(x, 0)} for x in (0, 2)]},
    # Weights that no solver tells from rounding.
    {"blocks": [{"id": i, "polygon": square(2 * i, 0), "density": 1e7 ** (i - 1)} for i in (1, 2)]},
    one_block(id=0),
    *(one_block(id=wrong) for wrong in (True, np.True_, "1", 1.0)),
    one_block(polygon=square(0, 0)[:2]),
    one_block(polygon=[[0, 0], [2, 2], [2, 0], [0, 2]]),
    one_block(fixed="yes"),
    *(one_block(density=wrong) for wrong in (0, 1e60, 1e-60, True, "2")),
    one_block(polygon=[[0, 0], [2, 0], [2, "2"]]),
    {**PAIR, "mu": "rough"},
    {**PAIR, "mu": True},
    {**PAIR, "mu_head": "none"},
    {**PAIR, "friction": 3},
    {**PAIR, "friction": [7]},
    *({**PAIR, "friction": [{"between": pair, "mu": 0.3}]} for pair in PAIRLESS),
    {**PAIR, "friction": [{"between": two, "mu": m} for two, m in (([1, 2], 0.3), ([2, 1], 0.4))]},
    {**PAIR, "friction": [{"between": [1, 2], "mu": True}]},
    {**PAIR, "friction": [{"between": [1, 2]}]},
    {**PAIR, "interfaces": [{"between": [0, 1], "points": [[0, 0]], "normal": [0, 1]}]},
    {**PAIR, "interfaces": [{"between": [1, 0], "points": [], "normal": [0, 1]}]},
    {**PAIR, "interfaces": [{"between": [1, 0], "points": [[0, 0]], "normal": [0, 0]}]},
    {**PAIR, "interfaces": [{"between": [1, 0], "points": [[0, 0]]}]},
    {**PAIR, "blocks": [{"id": 1, "polygon": square(0, 0)}]},
]


def bed(pair, y, normal, reach=0):
    """Two blocks, of which a bed is told."""
    points = [[-reach, y], [2 + reach, y]]
    return {**PAIR, "interfaces": [{"between": pair, "points": points, "normal": normal}]}


@pytest.mark.parametrize(
    ("data", "code", "cure"),
    [
        *((data, "E303", "") for data in MALFORMED),
        *((one_block(held=held), "E303", "what is held") for held in (["up"], [["x"]], "x, y", 3)),
        ({"blocks_xywh": [[0, 0, 1e150, 1e150]]}, "E303", "another unit"),
        ({"blocks_xywh": [[0, 0, 1e60, 1]]}, "E303", "another unit"),
        ({"blocks_xywh": [[1e308, 0, 1e308, 1]]}, "E303", "another unit"),
        (one_block(polygon=[[2.0**63, 0], [2.0**64, 0], [8, 3], [6, 3]]), "E303", "another unit"),
        ({"blocks_xywh": [[0, 0, 1, 1e-60]]}, "E303", "another unit"),
        (one_block(polygon=square(0, 0, 1e150)), "E303", "another unit"),
        (one_block(polygon=square(0, 0, 1e-150)), "E303", "another unit"),
        ({"blocks_xywh": [[1e17, 0, 1, 1]]}, "E303", "origin"),
        (one_block(polygon=square(0, 1e10, 1)), "E303", "origin"),
        *(({**PAIR, "mu": mu}, "E302", "") for mu in (-1, math.nan, math.inf)),
        ({**PAIR, "mu": 10**400}, "E302", ""),
        ({"blocks_xywh": [[0, -1, 1, 3]]}, "E304", "up"),
        # Bars that cross, of which no corner is inside of the other.
        ({"blocks_xywh": [[0, 1, 3, 1], [1, 0, 1, 3]]}, "E304 .*blocks 1 and 2 overlap", ""),
        (
            {"blocks": [{"xywh": [0, 0, 2, 1]}]},
            'E303 .*belongs into "blocks_xywh"',
            "[[x, y, width, height]",
        ),
    ],
)
def test_what_is_no_block_model_is_refused(data, code, cure):
    """Without a warning of NumPy: warnings are errors here."""
    with pytest.raises(InputError, match=code) as refused:
        model_from_json(data)
    assert refused.value.cure
    assert cure in refused.value.cure
    assert refused.value.where


def test_numbers_of_numpy_are_ids_and_numbers():
    corners = [[np.float32(x), np.int8(y)] for x, y in square(0, 0)]
    data = one_block(id=np.int64(7), polygon=corners, density=np.float32(2))
    twice = 2 * [{"between": [np.uint8(7), 0], "mu": np.float32(0.25)}]
    model = model_from_json({**data, "mu": np.int64(1), "friction": twice})
    (block,), (face,) = model.blocks, model.interfaces
    assert (block.id, block.weight, model.mu, face.mu) == (7, 8, 1, 0.25)
    assert {type(one) for one in (block.id, model.mu, face.mu)} == {int, float}


def test_a_corner_at_which_an_edge_goes_straight_on_is_none():
    feet = [[1, 1], [3, 2], [5, 1], [5, 4], [1, 4]]
    for step in (0, 1e-13, -1e-13):
        model = model_of([[0, 0], [6, 0], [6, 1], [5, 1 + step], [1, 1], [0, 1]], feet)
        assert [p.tolist() for i in model.interfaces[1:] for p in i.points] == [[1, 1], [5, 1]]
    # A turn of a thousandth is a corner.
    bent = [[0, 0], [6, 0], [6, 1], [3, 1.001], [0, 1]]
    assert len(polygons_from_json(one_block(polygon=bent))[1]) == 6


def test_a_bed_is_where_both_blocks_are_and_carries_the_first():
    for one in (bed([1, 0], 0, [0, 1]), bed([2, 1], 1.05, [0, 2]), bed([1, 2], 1, [0, -1])):
        refuse_astray(model_from_json(one), polygons_from_json(one))
    for wrong, said in [
        (bed([1, 0], 0, [0, -1]), "out of block 1"),
        (bed([2, 1], 1, [0, -1]), "out of block 2"),
        (bed([1, 0], 0, [0, 1], 5), "up to 5 from block 1"),
        (bed([2, 1], 0, [0, 1]), "up to 1 from block 2"),
    ]:
        with pytest.raises(InputError, match=f"E303 interfaces, entry 1: .*{said}"):
            refuse_astray(model_from_json(wrong), polygons_from_json(wrong))


@pytest.mark.parametrize(
    ("footing", "beds"),
    [
        ([[0, -1], [2, -1], [2, 0], [0, 0]], {1: [0.5, 2], 0: [2, 2.5]}),
        ([[-9, -1], [9, -1], [9, 0], [-9, 0]], {1: [0.5, 2.5]}),
        ([[0, -1], [4, 0], [0, 0]], {1: [0.5, 2.5]}),
        ([[1, -1], [2, -1], [2, -1e-6], [1, -1e-6]], {1: [1, 2], 0: [0.5, 1, 2, 2.5]}),
        ([[0, -1], [2, -1], [2, -0.1], [0, -0.1]], {0: [0.5, 2.5]}),
        ([[2.5, -1], [4, -1], [4, 1], [2.5, 1]], {1: [2.5, 2.5], 0: [0.5, 2.5]}),
    ],
)
def test_what_is_fixed_in_the_ground_bears_in_its_place(footing, beds):
    """And it does not stand on the ground itself."""
    block = {"id": 2, "polygon": [[0.5, 0], [2.5, 0], [2.5, 2], [0.5, 2]]}
    fixed = {"id": 1, "polygon": footing, "fixed": True}
    found: dict[int, list[float]] = {}
    for face in model_from_json({"blocks": [fixed, block]}).interfaces:
        assert face.block == 2
        found.setdefault(face.other, []).extend(face.points[:, 0].tolist())
    assert {other: sorted(xs) for other, xs in found.items()} == {
        other: pytest.approx(xs, abs=1e-4) for other, xs in beds.items()
    }


def test_points_of_an_interface_run_along_it():
    three = {"between": [1, 0], "points": [[2, 0], [0, 0], [4, 0]], "normal": [0, 2]}
    model = model_from_json({"blocks_xywh": [[0, 0, 4, 4]], "mu": 2, "interfaces": [three]})
    assert model.interfaces[0].points.tolist() == [[0, 0], [2, 0], [4, 0]]
    assert (model.interfaces[0].length, model.interfaces[0].normal) == (4, (0, 1))


@pytest.mark.parametrize(
    ("unit", "away"), [(1e-49, 0), (1e-12, 0), (1e12, 0), (1e49, 0), (1, 1e8), (1, -1e8)]
)
def test_any_unit_that_arithmetic_carries_and_any_origin(unit, away):
    rows = [[away, 0, 0.5, 1], [away + 0.125, 1, 0.375, 0.5]]
    both = lateral_resistance(boxes(*(np.array(rows) * unit)))
    expected = lateral_resistance(boxes([0, 0, 4, 8], [1, 8, 3, 4]))
    sides = expected.left.alpha, expected.right.alpha
    assert (both.left.alpha, both.right.alpha) == pytest.approx(sides, abs=1e-6)


def test_blocks_with_a_common_line_do_not_overlap():
    """In floats GEOS finds three of a hundred such pairs to overlap by up to their whole area."""
    rng = np.random.default_rng(3)
    for _ in range(100):
        assert {i.other for i in model_of(*outlines_along_a_line(rng)).interfaces} == {1}


def test_not_all_of_many_blocks_may_meet_at_one_point(monkeypatch):
    angles = np.linspace(0.0, math.pi, 21)
    rim = np.column_stack([np.cos(angles), np.sin(angles)])
    sectors = [[[0, 0], *rim[i : i + 2].tolist()] for i in range(20)]
    assert len(model_of(*sectors).blocks) == 20
    monkeypatch.setattr("drystone.contacts.given.MOST_TOUCHING", (20, 8))
    with pytest.raises(InputError, match=r"E303 .*more than 180 pairs of its 20 blocks touch"):
        model_of(*sectors)
