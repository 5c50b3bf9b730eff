"""Plans read with the files beside them; parts against their pixels and the plan."""

import json
import math

import numpy as np
import pytest
import shapely

import drystone as ds
from drystone.drawing.assembly import outer_loop, read_assembly
from drystone.drawing.outlines import label_regions
from drystone.errors import DrystoneError
from tests.drawing.plans import METRIC, PX_PER_M, assembly, planned, source_stones


@pytest.mark.parametrize("name", METRIC)
def test_outlines_hold_the_pixels_of_stones_and_are_those_of_the_blocks(name):
    wall, stones = assembly(name), source_stones()
    # The outline of a plan on pixels is that of pixels of 2 source px.
    near_m = (0.7 if name.startswith("exact") else 2.5) / PX_PER_M
    areas = {block.id: block.area for block in wall.model.blocks}
    for part in wall.parts:
        outline = shapely.Polygon(part.corners)
        assert outline.is_valid
        assert outline.exterior.is_ccw
        assert outline.area == pytest.approx(part.area, rel=1e-12)
        assert outline.area == pytest.approx(areas[part.id], rel=1e-9)
        off_m = 1e-9 if name.startswith("exact") else 1.0 / PX_PER_M
        assert part.centroid == pytest.approx(outline.centroid.coords[0], abs=off_m)
        if part.kind == "wedge":
            continue
        stone = stones.by_id(part.id)
        pick = wall.pick_pose(part)
        rows, cols = np.nonzero(stone.mask)
        x = stone.left_px + cols + 0.5
        y = stone.bottom_px + stone.mask.shape[0] - rows - 0.5
        photo = np.column_stack([x / PX_PER_M, y / PX_PER_M, 0 * x, 0 * x + 1])
        moved = wall.place_pose(part).matrix @ np.linalg.inv(pick.matrix) @ photo.T
        points = shapely.points(moved[0], moved[2])
        assert shapely.distance(outline, points).max() < near_m
        assert outline.area * PX_PER_M**2 == pytest.approx(len(x), rel=0.06)


def test_the_grip_is_the_least_width_of_any_direction_and_wedges_are_in_no_photo():
    wall = assembly("exact")
    for part in wall.parts:
        width, angle_deg = part.grip
        angles = np.radians(np.append(np.arange(0.0, 180.0, 0.25), angle_deg))
        across = np.stack([np.cos(angles), np.sin(angles)])
        widths = np.ptp(part.own_corners @ across, axis=0)
        assert widths[-1] == pytest.approx(width)
        assert widths.min() >= width - 1e-12
        assert 0.0 <= angle_deg < 180.0
    (wedge,) = wall.wedges
    assert (wedge.kind, wedge.name, wedge.angle_deg) == ("wedge", "wedge_010", 0.0)
    assert wedge.under == 3
    with pytest.raises(TypeError, match="wedge_010 is in no image"):
        wall.source_corners(wedge)
    with pytest.raises(ValueError, match="read-only"):
        wedge.corners[0, 0] = 1.0


def test_folder_and_file_are_the_same_plan_of_one_scale(tmp_path):
    metric, px = tmp_path / "raster-m", tmp_path / "exact"
    for folder in (metric, px):
        ds.write_plan_folder(planned(*METRIC[folder.name]), folder)
    one, other = read_assembly(px), read_assembly(px / "plan.json")
    assert one.plan == other.plan
    assert [part.name for part in one.parts] == [part.name for part in other.parts]
    assert (one.unit, one.size) == ("px", (110.0, 40.0))
    # As thick as the side of the median stone.
    sides = sorted(shapely.Polygon(part.corners).area ** 0.5 for part in one.stones)
    middle = len(sides) // 2
    assert len(sides) % 2 == 0
    assert one.thickness == pytest.approx((sides[middle - 1] + sides[middle]) / 2)
    assert read_assembly(metric, px_per_m=PX_PER_M).px_per_m == PX_PER_M
    with pytest.raises(DrystoneError, match=r"E131 .*137 px a metre, not 200"):
        read_assembly(metric, px_per_m=200.0)
    with pytest.raises(DrystoneError, match="E131"):  # a thickness needs a scale
        read_assembly(px, thickness_m=0.3)
    for name in ("px_per_m", "thickness_m", "density_kg_m3"):
        for value in (-3.0, 0.0, math.nan, math.inf):
            with pytest.raises(
                DrystoneError, match=f"E138 --{name[:2]}.*{value} is not a positive"
            ):
                read_assembly(px, **{"px_per_m": 100.0, name: value})
    told = read_assembly(px, thickness_m=0.3, px_per_m=100.0)
    assert told.thickness == 0.3
    assert told.parts[0].corners == pytest.approx(one.parts[0].corners / 100)
    (px / "blocks.json").unlink()
    with pytest.raises(DrystoneError, match="E133"):
        read_assembly(px)


@pytest.mark.parametrize(
    ("name", "tampered", "code", "said"),
    [
        ("exact", lambda s: [*s, s[-1] | {"step": len(s) + 1}], "E213", "was placed before"),
        ("exact", lambda s: [one | {"under": 9999} if "under" in one else one for one in s],
         "E214", "does not follow stone 9999"),
        ("raster-m", lambda s: [one | {"step": one["step"] + 1} for one in s], "E214",
         "this is step 1 of the plan"),
    ],
)  # fmt: skip
def test_steps_that_nobody_can_build_by_are_refused(name, tampered, code, said, tmp_path):
    ds.write_plan_folder(planned(*METRIC[name]), tmp_path)
    path = tmp_path / "plan.json"
    plan = json.loads(path.read_text("utf-8"))
    plan["steps"] = tampered(plan["steps"])
    path.write_text(json.dumps(plan), "utf-8")
    with pytest.raises(DrystoneError, match=f"{code} .*{said}.*`drystone check`"):
        read_assembly(tmp_path)


def test_pits_that_meet_the_outside_at_a_corner_are_filled_holes_and_lesser_pieces_left_out():
    labels = np.zeros((8, 9), np.uint32)
    labels[1:7, 1:8] = 3
    labels[1, 1] = labels[2, 2] = 0
    ((found, *_),) = (region.loops for region in label_regions(labels))
    assert not shapely.Polygon(found).is_valid
    polygon = shapely.Polygon(outer_loop([found]))
    assert polygon.is_valid
    assert polygon.exterior.is_ccw
    assert polygon.area == 6 * 7 - 1
    labels = np.zeros((9, 12), np.uint32)
    labels[1:8, 1:8] = 3
    labels[3:5, 3:5] = 0
    labels[4, 9:11] = 3
    (region,) = label_regions(labels)
    assert len(region.loops) == 3
    found = outer_loop(region.loops)
    assert found.tolist() in [loop.tolist() for loop in region.loops]
    assert shapely.Polygon(found).area == 49.0
