"""Planning goes on from the wall as it was measured: with noise, other stones, another order."""

import numpy as np
import pytest
import shapely
from shapely import affinity

from drystone import MeasuredPose, Planner, Site, lateral_resistance, model_from_labels
from drystone.contacts.settled import model_of_outlines
from drystone.errors import InputError, UsageError
from drystone.generate import RubbleSettings, rubble_stones
from drystone.planner.measured import fitted
from drystone.verify.check import check_plan
from tests.planner import scenes

PX_PER_M, SCALE = 200.0, 0.5
SITE = Site.from_source(250.0, 95.0, SCALE, PX_PER_M)
FAST = {"orientations": "sf"}
EXACT, PIXELS = scenes.greedy(FAST), scenes.greedy({"geometry": "raster", **FAST})
BOTH = pytest.mark.parametrize("settings", [EXACT, PIXELS], ids=["exact", "raster"])


def rubble(seed=1, count=10):
    size = RubbleSettings(count=count, width_px=240, height_px=90, courses=3)
    return rubble_stones(size, np.random.default_rng(seed))


def planner(settings, count=6):
    return Planner(rubble(count=count), SITE, seed=1, settings=settings)


def planned(one):
    """Where the planner has its stones."""
    site, poses = one.workshop.site, {}
    for placement in one.build.wall.placements:
        x, y = placement.centroid(site.height_px)
        poses[placement.stone_id] = x / site.scale, y / site.scale, placement.posed.angle_deg
    return poses


def in_metres(poses):
    return {i: MeasuredPose(x / PX_PER_M, y / PX_PER_M, a) for i, (x, y, a) in poses.items()}


def shown(corners, pose, shape, scale=1.0):
    """Pixels whose centres are in a shape (shapely), the centroid of which is somewhere, turned."""
    x, y, angle = pose
    rows, cols = np.mgrid[0 : shape[0], 0 : shape[1]]
    turned = affinity.rotate(shapely.Polygon(corners), angle, origin=(0, 0))
    there = affinity.affine_transform(turned, [scale, 0, 0, scale, x * scale, y * scale])
    return shapely.contains(there, shapely.points(cols + 0.5, shape[0] - rows - 0.5))


def picture(poses, stones, scale):
    """Draw the stones of the wall as a camera sees them."""
    shape = (95, 250) if scale == 1.0 else (SITE.height_px, SITE.width_px)
    labels = np.zeros(shape, np.uint16)
    for stone_id, pose in poses.items():
        seen = shown(stones.by_id(stone_id).outline, pose, shape, scale)
        labels[seen & (labels == 0)] = stone_id
    return labels


def turns(one, other):
    return abs((one - other + 180.0) % 360.0 - 180.0)


def check_wall(one):
    """No overlaps by shapely, and the whole wall stands by a limit analysis of its own."""
    wall, settle = one.build.wall, one.settings.settle
    if wall.outlines is None:
        counted = sum(int(p.posed.mask.sum()) for p in wall.placements)
        counted += sum(wedge.area_px for wedge in wall.wedges)
        assert int((wall.labels > 0).sum()) == counted
        model = model_from_labels(wall.labels, one.settings.mu).model
    else:
        shapes = scenes.kept_apart(wall, settle.clearance_px)
        assert min(shape.bounds[1] for shape in shapes) >= -1e-9
        model = model_of_outlines(wall.outlines.blocks, one.settings.mu, settle.contact_px)
    assert lateral_resistance(model).stable
    assert all(action.stands for action in one.build.actions)


@pytest.mark.parametrize(
    ("settings", "scale"), [(EXACT, None), (PIXELS, None), (EXACT, SCALE), (PIXELS, 1.0)]
)
def test_a_wall_that_is_built_off_its_plan_goes_on_from_where_it_is(settings, scale):
    """As poses say that are measured, or pictures of some scale."""
    count, noise, seed, least = (9, 1.0, 5, 6) if scale is None else (6, 0.7, 2, 5)
    one, rng, seen, built = planner(settings, count), np.random.default_rng(seed), [], {}
    for step in one.steps():
        pose, angle = step.pose3d, step.action.stabilised.placement.posed.angle_deg
        # A stone that is put down lies on others, not in them: it ends up somewhat higher.
        built[step.stone_id] = (
            pose.x_m * PX_PER_M + rng.normal(0.0, noise),
            pose.z_m * PX_PER_M + abs(rng.normal(0.0, noise)),
            angle + rng.normal(0.0, noise),
        )
        stones = one.workshop.stones
        seen.append(
            one.observe(in_metres(built) if scale is None else picture(built, stones, scale))
        )
    assert len(built) == len(one.build.actions) >= least
    assert all((told.stands, told.notices) == (True, ()) for told in seen)
    check_wall(one)
    if scale is None:
        assert 1.0 < max(observation.largest_px for observation in seen) < 5.0
        # Stones that are pixels have angles that nothing but measuring gives them: so says the
        # checker, which builds the wall again from the poses alone.
        problems = check_plan(scenes.result_of(one).plan, one.workshop.stones).problems
        assert {problem.code for problem in problems} == ({"E235"} if settings is PIXELS else set())
        found = planned(one)
    else:
        found = {
            i: (p.x * PX_PER_M, p.y * PX_PER_M, p.angle_deg) for i, p in seen[-1].poses.items()
        }
    # Brought apart, lowered, and on pixels put onto them; stones that were measured one in another
    # hide some pixels of a picture.
    most_px, most_deg = (5.0, 4.0) if scale is None else (0.8 / scale, 2.0)
    for stone_id, (x, y, angle) in found.items():
        true = built[stone_id]
        assert np.hypot(x - true[0], y - true[1]) < most_px
        assert turns(angle, true[2]) < most_deg


@BOTH
def test_a_wall_that_is_built_as_planned_changes_nothing(settings):
    one = planner(settings)
    for _ in one.steps():
        before, there = one.build, planned(one)
        seen = before.wall.labels
        if settings is PIXELS:
            seen = picture(there, one.workshop.stones, 1.0)
        for measured, least_px in ((in_metres(there), 1e-9), (seen, 0.0), (seen.tolist(), 0.0)):
            found = one.observe(measured)
            assert one.build is before
            assert max(found.largest_px, found.largest_moved_px) <= least_px
            assert (found.largest_deg, found.stands) == (0, True)
            assert (found.free, found.lost, found.added, found.notices) == ((), (), (), ())
    assert scenes.same(one, scenes.finish(planner(settings)))


@pytest.mark.parametrize("scale", [1.0, SCALE], ids=["source", "working"])
def test_a_stone_alone_is_measured_to_less_than_half_a_pixel_and_to_a_degree(scale):
    rng, stones = np.random.default_rng(3), rubble()
    for stone in stones:
        true = (125.0 + rng.uniform(-3, 3), 47.0 + rng.uniform(-3, 3), rng.uniform(-180, 180))
        labels = picture({stone.id: true}, stones, scale)
        place = fitted(labels == stone.id, stone.outline, scale, true[2] + rng.normal(0, 5))
        assert np.hypot(place.x_px - true[0], place.y_px - true[1]) * scale < 0.4
        assert turns(place.angle_deg, true[2]) < 1.0


@pytest.mark.parametrize(("aside", "up"), [(-1, 0), (1, 0), (0, 1), (0, -1)])
def test_a_stone_that_the_edge_of_the_picture_cuts_is_measured_by_what_is_in_it(aside, up):
    for stone, out in zip(rubble(), (0.1, 0.2, 0.3), strict=False):
        width, height = np.ptp(stone.outline, axis=0) * (0.5 - out)
        x, y = 50 + aside * (50 - width), 50 + up * (50 - height)
        place = fitted(shown(stone.outline, (x, y, 4.0), (100, 100)), stone.outline, 1.0, 0.0)
        assert np.hypot(place.x_px - x, place.y_px - y) < 0.4
        assert turns(place.angle_deg, 4.0) < 1.0


def about_its_centroid(*corners):
    return np.array(corners) - shapely.get_coordinates(shapely.Polygon(corners).centroid)


def test_a_stone_is_found_whichever_way_it_is_turned():
    shape = about_its_centroid((0, 0), (40, 0), (40, 12), (20, 16), (0, 30))
    for angle in (-170.0, -60.0, 0.0, 95.0, 180.0):
        place = fitted(shown(shape, (41.3, 37.8, angle), (80, 80)), shape, 1.0, None)
        assert turns(place.angle_deg, angle) < 1.0
        # Straight edges along rows and columns tell where they are to half a pixel.
        assert np.hypot(place.x_px - 41.3, place.y_px - 37.8) < (0.5 if angle % 90 == 0 else 0.3)
    wedge = about_its_centroid((0, 0), (40, 0), (40, 6), (0, 26))
    brick = about_its_centroid((0, 0), (40, 0), (40, 20), (0, 20))
    # A brick upside down is the same picture: it is as it was planned.
    for shape, planned_deg, found_deg in ((wedge, -100.0, 33.0), (brick, -145.0, -147.0)):
        place = fitted(shown(shape, (40.2, 39.7, 33.0), (80, 80)), shape, 1.0, planned_deg)
        assert turns(place.angle_deg, found_deg) < 1.0


@BOTH
def test_stones_that_have_fallen_are_free_again_and_lost_ones_used_no_more(settings):
    one = planner(settings.updated({"pin": [*range(1, 7)]}))
    scenes.finish(one, 4)
    poses = planned(one)
    *left, gone, fallen = poses
    other = next(i for i in one.workshop.fitting if i not in poses)
    found = one.observe({i: in_metres(poses)[i] for i in left}, lost=np.array([gone, other]))
    assert found.free == (fallen,)
    assert repr(found.lost) == repr(tuple(sorted((gone, other)))) == repr(one.settings.ban)
    assert planned(one) == {i: poses[i] for i in left}
    assert not {gone, other} & {*one.settings.pin}
    scenes.finish(one)
    assert fallen in planned(one)
    assert not {gone, other} & set(planned(one))
    check_wall(one)


@BOTH
def test_deviations_are_measured_less_planned(settings):
    one = planner(settings)
    step = next(one.steps())
    x, y, angle = planned(one)[step.stone_id]
    aside = 1.0 if x < 125.0 else -1.0  # inwards: the wall ends there
    place = (np.float64(x + aside), y + 0.5, angle - 0.4)
    seen = one.observe(in_metres({step.stone_id: place}))
    (deviation,) = seen.deviations
    assert {type(number) for number in vars(deviation).values()} == {int, float}
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


def of_wedges(one):
    """Ids of the wedges, and of the stones above them."""
    return {wedge.id: wedge.under for wedge in one.build.wall.wedges}


def test_wedges_in_a_picture_are_no_stones():
    stones = scenes.few_stones()
    site = Site.from_source(84.0, 34.0, SCALE)
    one = scenes.finish(Planner(stones, site, seed=3, settings=scenes.greedy(scenes.WITH_WEDGES)))
    before = one.build
    assert of_wedges(one) == {6: 4, 7: 5}
    found = one.observe(one.build.wall.labels)
    assert set(found.poses) == {placement.stone_id for placement in before.wall.placements}
    assert one.build is before
    # A pixel of the source to the right, with all that it lies on: wedges are cut again.
    found = one.observe({i: MeasuredPose(x + 1.0, y, a) for i, (x, y, a) in planned(one).items()})
    assert found.stands
    assert max(turn.moved_px for turn in found.deviations) < 2.0
    assert of_wedges(one) == {6: 4, 7: 5}
    # Stones fall, one after the other, and wedges are left where they were.  Their ids mean no
    # stone, and nothing else: what stays keeps its id, and what is new gets one that none had.
    for gone, left, then in ((5, {6: 4}, {6: 4, 8: 2}), (4, {8: 2}, {8: 2})):
        seen = np.where(one.build.wall.labels == gone, 0, one.build.wall.labels)
        seen[0, :2] = 6, 7
        assert [one.observe(seen).free for _ in range(2)] == [(gone,), ()]
        assert of_wedges(one) == left
        assert of_wedges(scenes.finish(one, 1)) == then


WRONG = "0.5", True, np.True_, None, 10**400


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
        *(
            (f"E197 .*{said}", {1: MeasuredPose(*pose)})
            for number, said in ({nan: "nan", inf: "inf"} | dict.fromkeys(WRONG, "Pose")).items()
            for pose in ((number, 0.1, 0.0), (0.5, number, 0.0), (0.5, 0.1, number))
        ),
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
    with pytest.raises(TypeError, match="lost must be a list, not 5"):
        one.observe(in_metres(planned(one)), lost=5)
    with pytest.raises(TypeError, match="measured must be"):
        one.observe(5)


def test_poses_of_steps_are_in_metres_and_need_a_scale():
    one = planner(PIXELS)
    step = next(one.steps())
    ((x, y, angle),) = planned(one).values()
    assert (step.pose3d.x_m, step.pose3d.y_m, step.pose3d.z_m) == (
        pytest.approx(x / PX_PER_M), 0.0, pytest.approx(y / PX_PER_M),
    )  # fmt: skip
    # Counter-clockwise as seen from the front, in a frame whose y goes away from the viewer.
    radians = np.radians(angle)
    assert step.pose3d.xaxis == pytest.approx((np.cos(radians), 0.0, np.sin(radians)))
    assert step.place_pose(0.3).y_m == pytest.approx(0.15)
    for poses in (step.place_pose, step.pick_pose):
        for wrong, kind, said in ((-0.1, UsageError, "E138 .*not a thickness"),
                                  (float("nan"), UsageError, "E138"),
                                  ("0.3", TypeError, "thickness_m must be a number")):  # fmt: skip
            with pytest.raises(kind, match=said):
                poses(wrong)
    centroid = one.workshop.stones.by_id(step.stone_id).centroid
    pick = step.pick_pose(0.3)
    assert (pick.x_m * PX_PER_M, pick.y_m * PX_PER_M) == pytest.approx(centroid)
    assert pick.z_m == pytest.approx(0.15)
    # What is ground under the camera is the back of the wall, and what it sees the front.
    moved = step.place_pose(0.3).matrix @ np.linalg.inv(pick.matrix)
    for z, y in ((0.0, 0.3), (0.3, 0.0)):
        point = moved @ (pick.x_m, pick.y_m, z, 1.0)
        assert point[:3] == pytest.approx((step.pose3d.x_m, y, step.pose3d.z_m))
    # Without a thickness both are those of a plate.
    assert step.place_pose() == step.pose3d
    assert step.pick_pose().z_m == 0.0
    unscaled = Planner(rubble(), Site.from_source(250.0, 95.0, SCALE), settings=PIXELS)
    step = next(unscaled.steps())
    for asked in (lambda: step.pose3d, step.place_pose, step.pick_pose):
        with pytest.raises(UsageError, match=r"E131.*--px-per-m.*--ruler.*markers"):
            asked()


def at(spots):
    """Poses of stones that are not turned, in px."""
    return {i: MeasuredPose(x, y, 0.0) for i, (x, y, *_) in spots.items()}


def laid(settings, spots, sizes):
    """A planner whose plan has blocks where they are asked for."""
    one = Planner(
        scenes.blocks({1: (20, 10), 2: (20, 10), **sizes}), Site(60, 60), settings=settings
    )
    assert one.observe(at(spots)).stands
    assert scenes.ids(one) == list(spots)
    return one


LOWER, UPPER = (30.0, 5.0), (30.0, 15.0)
"""Two blocks, 10 px high, one on the other."""


@scenes.GEOMETRIES
@pytest.mark.parametrize(
    ("planned", "third", "measured", "order"),
    [
        # Without what is put under it the second hangs in the air, or falls to where the third is.
        ((LOWER, UPPER), (20, 10), ((30.0, 5.0), (30.0, 25.0), (30.0, 15.0)), [1, 3, 2]),
        ((LOWER, UPPER), (20, 3), ((30.0, 5.0), (30.0, 18.0), (30.0, 11.5)), [1, 3, 2]),
        # A prop keeps the stone above where it was measured.
        (((24.0, 5.0), (24.0, 15.0)), (10, 10), ((24.0, 5.0), (12.0, 15.0), (7.0, 5.0)), [1, 3, 2]),
        # What is put on top comes after those that were planned, though it lies lower.
        ((LOWER, UPPER), (20, 10), (LOWER, UPPER, (50.0, 5.0)), [1, 2, 3]),
    ],
)
def test_a_stone_that_was_put_there_is_built_in_its_turn(settings, planned, third, measured, order):
    one = laid(settings, dict(enumerate(planned, 1)), {3: third})
    seen = one.observe(at(dict(enumerate(measured, 1))))
    assert (seen.stands, seen.notices, seen.added) == (True, (), (3,))
    assert seen.largest_moved_px < 0.5
    assert scenes.ids(one) == order
    assert all(action.stands for action in one.build.actions)
    assert scenes.ids(scenes.finish(one))[:3] == order


@scenes.GEOMETRIES
def test_what_has_no_room_is_in_no_wall(settings):
    one = laid(settings, {1: LOWER, 2: UPPER}, {3: (20, 10)})
    before = one.build
    with pytest.raises(InputError, match="E198 observe: stone 3"):
        one.observe(at({1: (30.0, 5.0), 2: (30.0, 15.0), 3: (30.0, 14.0)}))
    assert one.build is before
    roomy = settings.updated({"skip_too_large": True})
    short = Planner(scenes.blocks({1: (20, 10), 2: (46, 10)}), Site(45, 40), settings=roomy)
    with pytest.raises(InputError, match="E198 observe: stone 2"):
        short.observe(at({2: (22.0, 5.0)}))


def test_a_stone_that_would_fall_from_where_it_was_planned_is_named():
    one = laid(scenes.greedy(), {1: (12.0, 5.0), 2: (12.0, 15.0)}, {})
    there = at(planned(one))
    seen = one.observe(there | at({1: (24.0, 5.0)}))
    # It would fall off the first; the nearest place where it does not is taken, and said to be.
    assert seen.stands
    assert planned(one)[2][0] - there[2].x == pytest.approx(seen.largest_moved_px, abs=0.01)
    assert 2.0 < seen.largest_moved_px < 3.5
    (notice,) = seen.notices
    assert notice.code == "W127"
    assert "stones 2 are taken" in notice.message
    one = laid(scenes.RASTER, {1: (12.0, 5.0), 2: (12.0, 15.0)}, {})
    there = planned(one)
    seen = one.observe(at(there | {1: (27.0, 5.0)}))
    assert not seen.stands
    assert [notice.code for notice in seen.notices] == ["W124"]
    assert planned(one)[2] == there[2]


@pytest.mark.parametrize(
    ("height_px", "scale", "inside"),
    [(19.55, 1.0, True), (19.2, 0.5, True), (19.4, 1.0, False), (18.4, 0.5, False)],
)
def test_half_a_working_px_above_the_top_is_in_the_wall_and_more_is_not(height_px, scale, inside):
    site = Site.from_source(60.0, height_px, scale)
    one = Planner(scenes.blocks({1: (20, 10), 2: (20, 10)}), site, settings=scenes.greedy())
    if inside:
        assert one.observe(at({1: LOWER, 2: UPPER})).stands
        assert scenes.ids(one) == [1, 2]
    else:
        with pytest.raises(InputError, match="E198 observe: stone 2"):
            one.observe(at({1: LOWER, 2: UPPER}))


def test_the_nearest_place_where_the_wall_stands_is_taken():
    # A beam on a post.  A block as heavy as the beam tips it where its centroid is further from
    # the middle than the post is wide: 1800 (d - 15) > 1800 * 15.
    one = Planner(
        scenes.blocks({1: (30, 60), 2: (120, 15), 3: (30, 60)}),
        Site(200, 140),
        settings=scenes.greedy(),
    )
    below = {1: (100.0, 30.0), 2: (100.0, 67.5)}
    seen = one.observe(at({**below, 3: (133.0, 105.0)}))
    assert (seen.stands, seen.added) == (True, (1, 2, 3))
    assert 120.0 < planned(one)[3][0] < 130.0
    # Much further out there is no such place near it.
    far = one.observe(at({**below, 3: (150.0, 105.0)}))
    assert not far.stands
    assert "stones 3." in far.notices[0].message
    assert planned(one)[3][0] == pytest.approx(150.0, abs=0.5)
