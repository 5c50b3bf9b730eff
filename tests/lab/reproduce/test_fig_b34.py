"""Bricks in courses: laid by hand, and planned."""

from drystone_lab.reproduce.other_stones import Brick, bricks_of, courses_of, head_joints
from tests.lab.reproduce.small_walls import context, of, rows


def course(foot, *lefts, width=20, height=10):
    return [Brick(left, left + width, foot, foot + height, True) for left in lefts]


def test_a_running_bond_is_crossed_and_a_stack_is_not():
    low, running, stack = course(0, 0, 20, 40), course(10, 10, 30, 50), course(10, 0, 20, 40)
    assert courses_of(low + running, 10, 20).crossed == 4
    assert courses_of(low + stack, 10, 20).crossed == 0
    assert courses_of(low + stack, 10, 20).joints == 4
    # Joints of four px apart are not crossed, of five they are.
    assert courses_of(low + course(10, 4, 24), 10, 20).crossed == 1
    assert courses_of(low + course(10, 5, 25), 10, 20).crossed == 3


def test_upright_raised_and_turned_bricks_are_in_no_course():
    upright = Brick(0, 10, 0, 20, True)
    turned = Brick(30, 50, 0, 10, False)
    raised = course(3, 60)
    found = courses_of([upright, turned, *raised, *course(10, 80)], 10, 20)
    assert (found.bricks, found.lying, found.in_course, found.courses) == (4, 2, 1, 1)
    assert found.joints == 0


def test_a_hole_is_no_joint_and_the_last_course_needs_one_beside_it():
    assert head_joints(course(0, 0, 24, 64)) == [22.0]
    assert courses_of(course(0, 0, 20), 10, 20).joints == 0


def test_planned_bricks_are_read_off_their_wall(tmp_path):
    output = of("figB34", (72, 2)).make(context(tmp_path))
    found = rows(output, "walls")
    assert [(row["aspect"], row["built from"]) for row in found] == [
        (2.0, "one side"), (3.0, "one side"), (2.0, "two sides"), (3.0, "two sides")
    ]  # fmt: skip
    assert [run.width for run in output.runs] == [72, 72, 72, 72]
    # Runs have one aspect after the other, rows one side.
    for run, row in zip(output.runs, (found[0], found[2], found[1], found[3]), strict=True):
        wall = context(tmp_path).wall(run)
        boxes = bricks_of(wall)
        assert row["placed"] == row["lying"] == len(boxes) == 144 // (12 * row["aspect"])
        for box, placement in zip(boxes, wall.placements, strict=True):
            pixels = wall.labels[::-1] == placement.stone_id
            assert pixels[box.bottom : box.top, box.left : box.right].all()
            assert pixels.sum() == (box.top - box.bottom) * (box.right - box.left)
    colours = [
        {patch.get_facecolor() for patch in ax.patches if str(patch.get_gid()).startswith("stone")}
        for ax in output.pictures[0].figure.axes
    ]
    assert [len(each) for each in colours] == [6, 4, 6, 4]
