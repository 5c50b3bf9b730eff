"""Scenes with a known end: with next to no clearance stones settle where statics says.

Tolerances are a millionth of the size of the stone that settles.
"""

import math

import numpy as np
import pytest
from scipy.optimize import brentq, minimize_scalar

from drystone.kernels.polygons import no_polygons, polygon_edges
from drystone.kernels.settling import Status, settle
from tests.kernels.heaps import rules
from tests.polygons import box_about as box
from tests.polygons import moved as at

MU = 0.58


def exact(size, **changes):
    """Rules without slack."""
    close = {"clearance": 1e-9 * size, "tolerance": 1e-7 * size, "corner": 1e-7 * size}
    near = {"overlap": 0.01 * size, "gain": 1e-12 * size, "turn": math.radians(60.0), "steps": 400}
    return rules(size, **{"lean": 0.0, **close, **near, **changes})


def let_go(outline, pose, others, size, width=400.0, **changes):
    around = no_polygons().added(others)
    return settle(outline, polygon_edges(outline), pose, around, width, exact(size, **changes))


def round_stone(corners, radius, phase=0.0):
    angle = 2.0 * np.pi * (np.arange(corners) + phase) / corners
    return radius * np.column_stack([np.cos(angle), np.sin(angle)])


def support(outline, angle, direction):
    """How far a turned outline reaches along a direction."""
    c, s = math.cos(angle), math.sin(angle)
    x = c * outline[:, 0] - s * outline[:, 1]
    y = s * outline[:, 0] + c * outline[:, 1]
    return float((x * direction[0] + y * direction[1]).max())


BRICK = box(20.0, 10.0)


def test_a_stack_of_bricks_with_offsets():
    wall = []
    for course, x in enumerate([50.0, 57.0, 48.5, 54.25, 46.0]):
        found = let_go(BRICK, (x, 10.0 * course + 6.0, 0.0), wall, 20.0)
        assert found.status == Status.RESTS
        assert found[1:4] == pytest.approx((x, 10.0 * course + 5.0, 0.0), abs=2e-5)
        wall.append(at(BRICK, found.x, found.y))


@pytest.mark.parametrize("side", [-1, 1])
def test_a_corbel_carries_itself_up_to_half_its_length(side):
    low = [at(BRICK, 50.0, 5.0)]
    inside = let_go(BRICK, (50.0 + side * 9.999, 16.0, 0.0), low, 20.0)
    assert inside.status == Status.RESTS
    assert inside[1:4] == pytest.approx((50.0 + side * 9.999, 15.0, 0.0), abs=2e-5)
    # Gravity may lean by what is left of the support over the height of its centroid.
    assert inside.margin == pytest.approx(0.001 / 5.0 / MU, abs=1e-6)
    outside = let_go(BRICK, (50.0 + side * 10.001, 16.0, 0.0), low, 20.0, turn=0.1)
    assert outside.status == Status.FAR
    assert math.copysign(1.0, outside.angle) == -side


@pytest.mark.parametrize(("corners", "others"), [(64, 48), (24, 36), (48, 25)])
def test_a_lintel_on_two_round_stones_against_the_end_of_the_wall(corners, others):
    lintel, width = box(80.0, 10.0), 120.0
    rounds = [at(round_stone(corners, 20.0), 50.0, 20.0), at(round_stone(others, 14.0), 95.0, 14.0)]
    points = np.concatenate(rounds)

    def lowest(angle):
        """Height of the centroid, when it touches the end and lies on the round stones."""
        x = width - support(lintel, angle, (1.0, 0.0))
        nx, ny = -math.sin(angle), math.cos(angle)
        return float((points @ [nx, ny] + 5.0 - nx * x).max() / ny), x

    found = let_go(lintel, (78.0, 60.0, 0.0), rounds, 80.0, width=width)
    grid = np.linspace(-0.5, 0.2, 2001)
    start = grid[int(np.argmin([lowest(angle)[0] for angle in grid]))]
    best = minimize_scalar(
        lambda angle: lowest(angle)[0], bounds=(start - 4e-4, start + 4e-4), method="bounded",
        options={"xatol": 1e-12},
    )  # fmt: skip
    assert found.status == Status.RESTS
    assert found.touching >= 2
    assert (found.y, found.angle) == pytest.approx((best.fun, best.x), abs=8e-5)
    assert found.x == pytest.approx(lowest(best.x)[1], abs=8e-5)


def notch(half_deg):
    """Two blocks whose faces meet at the ground, at x = 100."""
    out = 60.0 * math.tan(math.radians(half_deg))
    left = [[100.0, 0.0], [100.0 - out, 60.0], [90.0 - out, 60.0], [90.0 - out, 0.0]]
    right = [[100.0, 0.0], [110.0 + out, 0.0], [110.0 + out, 60.0], [100.0 + out, 60.0]]
    return [np.array(left), np.array(right)]


@pytest.mark.parametrize(
    ("half_deg", "turn"), [(45.0, 0.1), (45.0, 0.785), (45.0, 1.0), (30.0, -0.3), (30.0, 0.6)]
)
def test_a_square_in_a_notch_lies_on_both_faces_or_on_one(half_deg, turn):
    """In a notch of 60 degrees a corner reaches the other face."""
    found = let_go(box(20.0, 20.0), (100.5, 60.0, turn), notch(half_deg), 20.0)
    c, s = math.cos(math.radians(half_deg)), math.sin(math.radians(half_deg))
    along = 10.0 if half_deg == 45.0 else 10.0 + 20.0 * s / c  # of the face, from the ground on
    side = math.copysign(1.0, found.x - 100.0) if half_deg < 45.0 else 1.0
    place = 100.0 + side * (along * s - 10.0 * c), along * c + 10.0 * s
    assert found.status == Status.RESTS
    assert found[1:3] == pytest.approx(place, abs=2e-5)
    assert abs(found.angle) == pytest.approx(math.radians(half_deg), abs=2e-5)


@pytest.mark.parametrize("half_deg", [45.0, 30.0, 22.0])
@pytest.mark.parametrize(("corners", "turn"), [(64, 0.01), (24, 0.1), (33, 0.3)])
def test_a_round_stone_in_a_notch(half_deg, corners, turn):
    stone, half = round_stone(corners, 10.0), math.radians(half_deg)
    sides = [(math.cos(half), -math.sin(half)), (-math.cos(half), -math.sin(half))]

    def where(angle):
        right, left = (support(stone, angle, side) for side in sides)
        return (right + left) / (2.0 * math.sin(half)), (left - right) / (2.0 * math.cos(half))

    def height(angle):
        return where(angle)[0]

    found = let_go(stone, (101.0, 60.0, turn), notch(half_deg), 20.0)
    y, x = where(found.angle)
    assert found.status == Status.RESTS
    assert found[1:3] == pytest.approx((100.0 + x, y), abs=2e-5)
    # The lowest of the ways to turn it from there to either side.
    near = found.angle + np.linspace(-0.3, 0.3, 2001) * 2.0 * np.pi / corners
    start = near[int(np.argmin([height(angle) for angle in near]))]
    best = minimize_scalar(
        height, bounds=(start - 2e-4, start + 2e-4), method="bounded", options={"xatol": 1e-12}
    )
    assert found.angle == pytest.approx(best.x, abs=1e-6)
    assert found.y == pytest.approx(best.fun, abs=2e-5)


def leaning(length, thickness, angle, post_x, size):
    """A ladder that touches the ground and, on its right, a post; and those two points."""
    ladder = box(length, thickness)
    c, s = math.cos(angle), math.sin(angle)
    corners = ladder @ np.array([[c, s], [-s, c]])
    gap = 1e-9 * size
    x, y = post_x - gap - corners[:, 0].max(), gap - corners[:, 1].min()
    foot = corners[int(np.argmin(corners[:, 1]))] + (x, y)
    head = corners[int(np.argmax(corners[:, 0]))] + (x, y)
    return ladder, (float(x), float(y), angle), foot, head


POST = at(box(10.0, 80.0), 105.0, 40.0)


def begins_to_rest(length, thickness):
    """The angle from which on a ladder rests where it is put, by bisection."""

    def rests(angle):
        ladder, pose, _, _ = leaning(length, thickness, angle, 100.0, length)
        found = let_go(ladder, pose, [POST], length, stop=0.0, steps=1)
        return found.status == Status.RESTS and found.steps == 0

    low, high = 0.3, 1.4
    assert rests(high)
    assert not rests(low)
    while high - low > 1e-9:
        middle = (low + high) / 2.0
        low, high = (low, middle) if rests(middle) else (middle, high)
    return high


@pytest.mark.parametrize("thickness", [4e-5, 5.0])
def test_a_ladder_rests_from_the_angle_on_where_lines_of_force_meet(thickness):
    def spare(angle):
        """Where both cones of friction cross the vertical through the centroid."""
        _, (x, _, _), foot, head = leaning(40.0, thickness, angle, 100.0, 40.0)
        return head[1] + MU * (head[0] - x) - abs(x - foot[0]) / MU

    expected = brentq(spare, 0.3, 1.2, xtol=1e-13)
    assert begins_to_rest(40.0, thickness) == pytest.approx(expected, abs=1e-6)
    if thickness < 1e-4:  # as thin as the clearance allows, it is that of the textbook
        assert expected == pytest.approx(math.atan((1.0 - MU**2) / (2.0 * MU)), abs=2e-6)


def test_a_ladder_without_friction_slides_until_it_lies():
    ladder, pose, _, _ = leaning(40.0, 2.0, 1.1, 100.0, 40.0)
    found = let_go(ladder, pose, [POST], 40.0, turn=9.0, shift=400.0)
    assert found.status == Status.RESTS
    assert (found.y, found.angle) == pytest.approx((1.0, 0.0), abs=4e-5)
    stopped = let_go(ladder, pose, [POST], 40.0, stop=0.0)
    assert stopped[:4] == (Status.RESTS, *pose)


@pytest.mark.parametrize("stone", [BRICK, round_stone(36, 10.0, 0.5)])
def test_leaning_gravity_pushes_a_stone_against_the_end_of_the_wall(stone):
    found = let_go(stone, (25.0, 12.0, 0.0), [], 20.0, lean=0.3, turn=9.0)

    def reach(angle):
        return support(stone, angle, (-1.0, 0.0)), support(stone, angle, (0.0, -1.0))

    def energy(angle):
        return 0.3 * reach(angle)[0] + reach(angle)[1]

    assert found.status == Status.RESTS
    assert found[1:3] == pytest.approx(reach(found.angle), abs=2e-5)
    near = [energy(found.angle + turn) for turn in np.linspace(-0.02, 0.02, 41)]
    assert energy(found.angle) <= min(near) + 2e-5
