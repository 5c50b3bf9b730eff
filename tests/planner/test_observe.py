"""Planning goes on from the wall as it was measured, with noise or without."""

from dataclasses import dataclass, field

import numpy as np
import pytest
import shapely
from shapely import affinity

from drystone.contacts.blocks import model_from_labels
from drystone.contacts.settled import model_of_outlines
from drystone.errors import InputError, UsageError
from drystone.generate import RubbleSettings, rubble_stones
from drystone.model.site import Site
from drystone.planner.measured import MeasuredPose, fitted
from drystone.planner.planner import Planner
from drystone.statics.limit import lateral_resistance
from drystone.verify.check import check_plan
from tests.planner.scenes import WITH_WEDGES, few_stones, finish, greedy, result_of, same

PX_PER_M, SCALE = 200.0, 0.5
SITE = Site.from_source(250.0, 95.0, SCALE, PX_PER_M)
FAST = {"orientations": "sf"}
EXACT, RASTER = greedy(FAST), greedy({"geometry": "raster", **FAST})
BOTH = pytest.mark.parametrize("settings", [EXACT, RASTER], ids=["exact", "raster"])
PICTURES = pytest.mark.parametrize("scale", [1.0, SCALE], ids=["source", "working"])

Pose = tuple[float, float, float]
"""x and y of the centroid, source px, and the angle in degrees."""


def rubble(seed=1, count=10):
    size = RubbleSettings(count=count, width_px=240, height_px=90, courses=3)
    return rubble_stones(size, np.random.default_rng(seed))


def planner(settings, count=6):
    return Planner(rubble(count=count), SITE, seed=1, settings=settings)


def planned(one):
    """Where the planner has its stones."""
    poses = {}
    for placement in one.build.wall.placements:
        x, y = placement.centroid(SITE.height_px)
        poses[placement.stone_id] = x / SCALE, y / SCALE, placement.posed.angle_deg
    return poses


def in_metres(poses):
    return {i: MeasuredPose(x / PX_PER_M, y / PX_PER_M, a) for i, (x, y, a) in poses.items()}


def picture(poses, stones, scale):
    """Draw the stones as a camera sees them: a pixel is of the stone at its centre (shapely)."""
    height, width = round(95.0 * scale), round(250.0 * scale)
    if scale == SCALE:
        height, width = SITE.height_px, SITE.width_px
    rows, cols = np.mgrid[0:height, 0:width]
    centres = shapely.points(cols + 0.5, height - rows - 0.5)
    labels = np.zeros((height, width), np.uint16)
    for stone_id, (x, y, angle) in poses.items():
        outline = shapely.Polygon(stones.by_id(stone_id).outline)
        turned = affinity.rotate(outline, angle, origin=(0, 0))
        there = affinity.affine_transform(turned, [scale, 0, 0, scale, x * scale, y * scale])
        labels[shapely.contains(there, centres) & (labels == 0)] = stone_id
    return labels


def turns(one, other):
    return abs((one - other + 180.0) % 360.0 - 180.0)


@dataclass
class Robot:
    """Puts stones down a little off, and never touches them again."""

    noise: float
    rng: np.random.Generator
    built: dict[int, Pose] = field(default_factory=dict)

    def place(self, step):
        pose, rng = step.pose3d, self.rng
        angle = step.action.stabilised.placement.posed.angle_deg
        # A stone that is put down lies on others, not in them: it ends up somewhat higher.
        self.built[step.stone_id] = (
            pose.x_m * PX_PER_M + rng.normal(0.0, self.noise),
            pose.z_m * PX_PER_M + abs(rng.normal(0.0, self.noise)),
            angle + rng.normal(0.0, self.noise),
        )


def live(one, robot, scale):
    """Plan, place, measure."""
    for step in one.steps():
        robot.place(step)
        seen = in_metres(robot.built)
        if scale is not None:
            seen = picture(robot.built, one.workshop.stones, scale)
        yield one.observe(seen)


def check_wall(one):
    """No overlaps by shapely, and the whole wall stands by a limit analysis of its own."""
    wall, settle = one.build.wall, one.settings.settle
    if wall.outlines is None:
        counted = sum(int(p.posed.mask.sum()) for p in wall.placements)
        counted += sum(wedge.area_px for wedge in wall.wedges)
        assert int((wall.labels > 0).sum()) == counted
        model = model_from_labels(wall.labels, one.settings.mu).model
    else:
        polygons = [shapely.Polygon(corners) for _, corners in wall.outlines.blocks]
        for i, polygon in enumerate(polygons):
            assert polygon.bounds[1] >= -1e-9
            for other in polygons[:i]:
                assert polygon.intersection(other).area < 1e-9
        model = model_of_outlines(wall.outlines, one.settings.mu, settle.contact_px)
    assert lateral_resistance(model).stable
    assert all(action.stands for action in one.build.actions)


def found_wrong(one):
    """What the checker says of the wall, which it builds again from the poses alone."""
    plan = result_of(one).plan
    return {problem.code for problem in check_plan(plan, one.workshop.stones).problems}


@BOTH
def test_a_wall_that_is_built_off_its_plan_goes_on_from_where_it_is(settings):
    one, robot = planner(settings, 9), Robot(1.0, np.random.default_rng(5))
    seen = list(live(one, robot, None))
    assert len(seen) == len(robot.built) == len(one.build.actions) >= 6
    assert all(observation.stands for observation in seen)
    assert 1.0 < max(observation.largest_px for observation in seen) < 5.0
    check_wall(one)
    # Stones that are pixels have angles that nothing but measuring gives them.
    assert found_wrong(one) == ({"E235"} if settings is RASTER else set())
    for stone_id, (x, y, angle) in planned(one).items():
        true = robot.built[stone_id]
        # Brought apart, lowered, and on pixels put onto them.
        assert np.hypot(x - true[0], y - true[1]) < 5.0
        assert turns(angle, true[2]) < 4.0


@pytest.mark.parametrize(("settings", "scale"), [(EXACT, SCALE), (RASTER, 1.0)])
def test_pictures_do_as_well(settings, scale):
    one, robot = planner(settings), Robot(0.7, np.random.default_rng(2))
    seen = list(live(one, robot, scale))
    assert len(robot.built) == len(one.build.actions) >= 5
    assert all(observation.stands for observation in seen)
    check_wall(one)
    for stone_id, pose in seen[-1].poses.items():
        x, y, angle = robot.built[stone_id]
        # Stones that were measured one in another hide some pixels.
        assert np.hypot(pose.x * PX_PER_M - x, pose.y * PX_PER_M - y) * scale < 0.8
        assert turns(pose.angle_deg, angle) < 2.0


@BOTH
def test_a_wall_that_is_built_as_planned_changes_nothing(settings):
    one = planner(settings)
    for _ in one.steps():
        before, there = one.build, planned(one)
        seen = before.wall.labels
        if settings is RASTER:
            seen = picture(there, one.workshop.stones, 1.0)
        for measured, least_px in ((in_metres(there), 1e-9), (seen, 0.0)):
            found = one.observe(measured)
            assert one.build is before
            assert max(found.largest_px, found.largest_moved_px) <= least_px
            assert (found.largest_deg, found.stands) == (0, True)
            assert (found.free, found.lost, found.added, found.notices) == ((), (), (), ())
    assert same(one, finish(planner(settings)))


@PICTURES
def test_a_stone_alone_is_measured_to_a_third_of_a_pixel_and_a_degree(scale):
    rng, stones = np.random.default_rng(3), rubble()
    for stone in stones:
        true = (125.0 + rng.uniform(-3, 3), 47.0 + rng.uniform(-3, 3), rng.uniform(-180, 180))
        labels = picture({stone.id: true}, stones, scale)
        place = fitted(labels == stone.id, stone.outline, scale, true[2] + rng.normal(0, 5))
        assert np.hypot(place.x_px - true[0], place.y_px - true[1]) * scale < 0.3
        assert turns(place.angle_deg, true[2]) < 1.0


def shown(corners, angle_deg, x, y):
    """A shape as a picture of 80 x 80 px shows it, turned, with its centroid somewhere."""
    rows, cols = np.mgrid[0:80, 0:80]
    there = affinity.rotate(shapely.Polygon(corners), angle_deg, origin=(0, 0))
    there = affinity.translate(there, x, y)
    return shapely.contains(there, shapely.points(cols + 0.5, 80 - rows - 0.5))


def about_its_centroid(*corners):
    return np.array(corners) - shapely.get_coordinates(shapely.Polygon(corners).centroid)


def test_a_stone_is_found_whichever_way_it_is_turned():
    shape = about_its_centroid((0, 0), (40, 0), (40, 12), (20, 16), (0, 30))
    for angle in (-170.0, -60.0, 0.0, 95.0, 180.0):
        place = fitted(shown(shape, angle, 41.3, 37.8), shape, 1.0, None)
        assert turns(place.angle_deg, angle) < 1.0
        # Straight edges along rows and columns tell where they are to half a pixel.
        assert np.hypot(place.x_px - 41.3, place.y_px - 37.8) < (0.5 if angle % 90 == 0 else 0.3)


def test_a_stone_is_turned_otherwise_than_planned_only_if_it_looks_so():
    wedge = about_its_centroid((0, 0), (40, 0), (40, 6), (0, 26))
    brick = about_its_centroid((0, 0), (40, 0), (40, 20), (0, 20))
    # A brick upside down is the same picture: it is as it was planned.
    for shape, planned_deg, found_deg in ((wedge, -100.0, 33.0), (brick, -145.0, -147.0)):
        place = fitted(shown(shape, 33.0, 40.2, 39.7), shape, 1.0, planned_deg)
        assert turns(place.angle_deg, found_deg) < 1.0


@BOTH
def test_stones_that_have_fallen_are_free_again_and_lost_ones_used_no_more(settings):
    one = planner(settings.updated({"pin": [*range(1, 7)]}))
    finish(one, 4)
    poses = planned(one)
    *left, gone, fallen = poses
    other = next(i for i in one.workshop.fitting if i not in poses)
    found = one.observe({i: in_metres(poses)[i] for i in left}, lost=np.array([gone, other]))
    assert found.free == (fallen,)
    assert repr(found.lost) == repr(tuple(sorted((gone, other)))) == repr(one.settings.ban)
    assert planned(one) == {i: poses[i] for i in left}
    assert not {gone, other} & {*one.settings.pin}
    finish(one)
    assert fallen in planned(one)
    assert not {gone, other} & set(planned(one))
    check_wall(one)


@BOTH
def test_deviations_are_measured_less_planned(settings):
    one = planner(settings)
    step = next(one.steps())
    x, y, angle = planned(one)[step.stone_id]
    aside = 1.0 if x < 125.0 else -1.0  # inwards: the wall ends there
    seen = one.observe(in_metres({step.stone_id: (x + aside, y + 0.5, angle - 0.4)}))
    (deviation,) = seen.deviations
    assert (deviation.dx, deviation.dy) == pytest.approx((0.005 * aside, 0.0025))
    assert deviation.angle_deg == pytest.approx(-0.4)
    assert deviation.shift_px == pytest.approx(np.hypot(1.0, 0.5)) == seen.largest_px
    assert seen.largest_deg == pytest.approx(0.4)
    now = planned(one)[step.stone_id]
    moved = np.hypot(now[0] - x - aside, now[1] - y - 0.5)
    assert (deviation.moved_px, seen.largest_moved_px) == pytest.approx((moved, moved))
    assert deviation.turned_deg == pytest.approx((now[2] - angle + 0.4 + 180) % 360 - 180)
    if settings is EXACT:
        # A stone alone on the ground: it goes down again, and nowhere else.
        assert now[0] == pytest.approx(x + aside, abs=0.3)
        assert now[1] < y + 0.5


def test_wedges_in_a_picture_are_no_stones():
    stones = few_stones()
    site = Site.from_source(84.0, 34.0, SCALE)
    one = finish(Planner(stones, site, seed=3, settings=greedy(WITH_WEDGES)))
    assert one.build.wall.wedges
    before = one.build
    found = one.observe(one.build.wall.labels)
    assert set(found.poses) == {placement.stone_id for placement in before.wall.placements}
    assert one.build is before
    # A pixel of the source to the right, with all that it lies on: wedges are cut again.
    poses = {}
    for placement in before.wall.placements:
        x, y = placement.centroid(site.height_px)
        shifted = MeasuredPose(x / SCALE + 1.0, y / SCALE, placement.posed.angle_deg)
        poses[placement.stone_id] = shifted
    found = one.observe(poses)
    assert found.stands
    assert one.build.wall.wedges
    assert max(turn.moved_px for turn in found.deviations) < 2.0
    ids = [wedge.id for wedge in one.build.wall.wedges]
    assert ids == list(range(min(ids), min(ids) + len(ids)))


def test_what_makes_no_sense_is_refused_and_changes_nothing():
    one = planner(EXACT)
    stone_id = next(one.steps()).stone_id
    before, x = one.build, planned(one)[stone_id][0]
    labels = picture(planned(one), one.workshop.stones, 1.0)
    nowhere, nan, inf = MeasuredPose(0.5, 0.1, 0.0), float("nan"), float("inf")
    bad = [
        ("E195", in_metres(planned(one)) | {99: nowhere}),
        (f"E195 .*no stone '{stone_id}' among", {str(stone_id): nowhere}),  # it comes out of JSON
        ("E197", {1: MeasuredPose(1.3, 0.1, 0.0)}),
        ("E197", {1: MeasuredPose(0.5, nan, 0.0)}),
        ("E197", {1: MeasuredPose(0.5, 0.1, inf)}),
        (r"E197 .*\(0.5, 0.1, 0.0\), which is not a MeasuredPose", {stone_id: (0.5, 0.1, 0.0)}),
        *(("E196", array) for array in (labels[:-1], labels * 1.0, labels[None])),
        ("E197", np.where(np.arange(250) < x, labels, 0)),
        ("E195", np.where(labels > 0, 99, 0)),
    ]
    for said, measured in bad:
        with pytest.raises(InputError, match=said):
            one.observe(measured)
        assert one.build is before
    with pytest.raises(UsageError, match="E199"):  # it is there
        one.observe(in_metres(planned(one)), lost=[stone_id])


def test_poses_of_steps_are_in_metres():
    one = planner(RASTER)
    step = next(one.steps())
    ((x, y, angle),) = planned(one).values()
    assert (step.pose3d.x_m, step.pose3d.y_m, step.pose3d.z_m) == (
        pytest.approx(x / PX_PER_M), 0.0, pytest.approx(y / PX_PER_M),
    )  # fmt: skip
    # Counter-clockwise as seen from the front, in a frame whose y goes away from the viewer.
    radians = np.radians(angle)
    assert step.pose3d.xaxis == pytest.approx((np.cos(radians), 0.0, np.sin(radians)))
    assert step.place_pose(0.3).y_m == pytest.approx(0.15)
    centroid = one.workshop.stones.by_id(step.stone_id).centroid
    pick = step.pick_pose(0.3)
    assert (pick.x_m * PX_PER_M, pick.y_m * PX_PER_M) == pytest.approx(centroid)
    assert pick.z_m == pytest.approx(0.15)


def test_poses_need_a_scale():
    one = Planner(rubble(), Site.from_source(250.0, 95.0, SCALE), settings=RASTER)
    step = next(one.steps())
    for asked in (lambda: step.pose3d, step.place_pose, step.pick_pose):
        with pytest.raises(UsageError, match=r"E131.*--px-per-m.*--ruler.*markers"):
            asked()
