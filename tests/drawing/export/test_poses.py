"""poses.json, read back with the JSON of the standard library and SciPy's rotations."""

import json
from dataclasses import replace

import numpy as np
import pytest
import shapely
from scipy.spatial.transform import Rotation

from drystone.drawing.export import robots
from drystone.drawing.export.formats import FORMATS, ExportSettings
from drystone.model.plan import StoneStep
from tests.drawing.plans import METRIC, PX_PER_M, THICKNESS_M, assembly
from tests.polygons import box_of


def written(name, folder):
    (path,) = FORMATS["poses"].write(assembly(name), folder, ExportSettings())
    assert b"-0.0," not in path.read_bytes()
    return json.loads(path.read_text(encoding="utf-8"))


def xyz(values):
    assert list(values) == ["x", "y", "z"]
    return list(values.values())


@pytest.mark.parametrize("name", METRIC)
def test_pick_and_place_follow_the_formula_of_the_plan(name, tmp_path):
    read, plan = written(name, tmp_path), assembly(name).plan
    unit = PX_PER_M if plan.length_unit == "px" else 1.0
    assert (read["schema"], read["units"]["length"]) == ("drystone-poses/1", "m")
    assert read["px_per_m"] == PX_PER_M
    assert {"W", "P", "S", "pick and place", "approach", "grasp"} <= set(read["frames"])
    assert read["source"] == {"path": plan.source["path"], "sha256": plan.source["sha256"]}
    assert read["wall"]["width_m"] == pytest.approx(110 / PX_PER_M)
    assert read["unused"] == list(plan.unused)
    assert len(read["parts"]) == len(plan.steps)
    for part, step in zip(read["parts"], plan.steps, strict=True):
        assert (part["step"], part["kind"], part["flipped"]) == (step.step, step.kind, False)
        for pose in filter(None, (part["place"], part["pick"])):
            matrix, turned = np.array(pose["matrix"]), pose["quaternion"]
            assert list(turned) == ["x", "y", "z", "w"]
            expected = Rotation.from_quat(list(turned.values())).as_matrix()
            assert matrix[:3, :3] == pytest.approx(expected, abs=1e-14)
            assert matrix[:, 3].tolist() == [*xyz(pose["point"]), 1.0]
            way = pose["approach"]
            end = np.array(xyz(way["start"])) + way["stand_off_m"] * np.array(xyz(way["direction"]))
            assert end == pytest.approx(matrix[:3, 3], abs=1e-12)
            assert way["stand_off_m"] >= 0.05
        if not isinstance(step, StoneStep):
            assert part["pick"] is part["pick_to_place"] is None
            continue
        angle = np.radians(step.angle_deg)
        turn = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
        p = np.array(step.source_centroid) + np.array([7.0, -3.0])
        q = turn @ (p - step.source_centroid) / PX_PER_M + np.array(step.centroid) / unit
        photo = np.array([*(p / PX_PER_M), 0.03, 1.0])
        moved = np.array(part["place"]["matrix"]) @ np.linalg.inv(part["pick"]["matrix"]) @ photo
        assert moved == pytest.approx([q[0], THICKNESS_M - 0.03, q[1], 1.0], abs=1e-9)
        assert np.array(part["pick_to_place"]) @ photo == pytest.approx(moved, abs=1e-12)


def test_grasps_ways_masses_sizes_and_the_order_of_work(tmp_path):
    read, wall, top = written("exact", tmp_path), assembly("exact"), 0.0
    assert (read["density_kg_m3"], read["clearance_m"]) == (2450.0, 0.05)
    assert read["thickness_m"] == THICKNESS_M
    for found, part in zip(read["parts"], wall.parts, strict=True):
        area = shapely.Polygon(part.corners).area
        assert found["mass_kg"] == pytest.approx(area * THICKNESS_M * 2450.0, rel=1e-9)
        held = found["grasp"]
        in_wall = np.array(xyz(held["direction_wall"]))
        assert np.ptp(part.corners @ in_wall[[0, 2]]) == pytest.approx(held["width_m"])
        turn = np.array(found["place"]["matrix"])[:3, :3]
        assert turn @ xyz(held["direction_part"]) == pytest.approx(in_wall, abs=1e-12)
        if found["pick"]:
            turn = np.array(found["pick"]["matrix"])[:3, :3]
            photo = turn @ xyz(held["direction_part"])
            assert photo == pytest.approx(xyz(held["direction_photo"]), abs=1e-12)
        else:
            assert held["direction_photo"] is None
        assert found["size_m"]["y"] == held["thickness_m"] == THICKNESS_M
        assert held["width_m"] <= min(found["size_m"]["x"], found["size_m"]["z"]) + 1e-12
        way, low = found["place"]["approach"], part.corners[:, 1].min()
        assert way["blocked_m"] * PX_PER_M < 1.0
        if part.kind == "stone":  # begins above everything that stands
            assert xyz(way["direction"]) == [0.0, 0.0, -1.0]
            assert low + way["stand_off_m"] == pytest.approx(max(top, low) + 0.05)
        else:
            assert xyz(way["direction"]) == [0.0, 1.0, 0.0]
            assert way["start"]["y"] + THICKNESS_M / 2 == pytest.approx(-0.05)
        top = max(top, part.corners[:, 1].max())
    # The order of work can be followed.
    there, names = {0}, [part["name"] for part in read["parts"]]
    for part in read["parts"]:
        assert part["neighbours"]
        assert set(part["neighbours"]) <= there
        there.add(part["id"])
        for index, wedge in enumerate(part["wedges_after"], part["step"]):
            assert names[index] == wedge
            assert read["parts"][index]["under"] == part["id"]
        waits = bool(part["wedges_after"])
        assert (part["alpha"]["left"] is None) == (part["alpha"]["right"] is None) == waits
    assert [name for part in read["parts"] for name in part["wedges_after"]] == ["wedge_010"]


@pytest.mark.parametrize("overlap_m", [0.0, 1e-12, -1e-12])
def test_the_widest_on_its_way_down_is_in_the_way_of_a_stone_and_not_what_it_rests_on(overlap_m):
    wall = assembly("exact")
    first, second, *_ = wall.parts
    below = replace(first, corners=box_of(0.0, 0.0, 0.3, 0.1), centroid=(0.15, 0.05))
    beside = replace(first, corners=box_of(-0.55, 0.0, 0.3, 0.1), centroid=(-0.4, 0.05))
    for left, low, blocked in (
        (0.0, 0.1 - overlap_m, 0.0),
        (0.3 - overlap_m, 0.0, 0.0),
        (-0.2, -0.1, 0.1),
        (-0.28, -0.5, 0.03),
    ):
        corners, centroid = box_of(left, low, 0.3, 0.1), (left + 0.15, low + 0.05)
        part = replace(second, corners=corners, centroid=centroid)
        found = robots.blocked_m(replace(wall, parts=(below, beside, part)), part)
        assert found == pytest.approx(blocked, abs=1e-11)
