"""What a build sheet says of a stone."""

from dataclasses import replace

import numpy as np
import pytest

from drystone.drawing.sheet.words import (
    beside,
    beside_words,
    length_words,
    lowest_corner,
    shortest_turn,
    size_words,
    turn_words,
    wedge_place,
    wedge_words,
)
from drystone.statics.model import GROUND, Interface, RigidBlockModel
from tests.drawing.export.drawn_walls import assembly


@pytest.fixture(scope="module")
def wall():
    """Steps 1 (wedge: 2), 3, 4 on the ground, then 5, 6, 7 upon them."""
    return assembly()


def part(wall, step):
    return wall.parts[step - 1]


@pytest.mark.parametrize(("angle_deg", "words"), [
    (0.0, "as it lies"), (-2.4, "as it lies"), (362.0, "as it lies"), (3.0, "turn left 3°"),
    (97.4, "turn left 97°"), (-97.4, "turn right 97°"), (262.6, "turn right 97°"),
    (180.0, "half round"), (-178.0, "half round"), (177.0, "turn left 177°"),
    (-540.0, "half round"),
])  # fmt: skip
def test_turns_are_the_short_way_round(angle_deg, words) -> None:
    assert turn_words(angle_deg) == words


def test_the_shortest_turn_is_the_same_turn() -> None:
    for angle in np.arange(-1000.0, 1000.0, 7.5):
        short = shortest_turn(float(angle))
        assert -180.0 < short <= 180.0
        assert (short - angle) % 360.0 == pytest.approx(0.0, abs=1e-9)


def test_neighbours_are_those_that_stand_already(wall) -> None:
    first = beside(wall, part(wall, 1))
    assert first.ground
    assert (first.on, first.left_of, first.right_of) == ((), (), ())
    last = beside(wall, part(wall, 7))
    assert (last.on, last.right_of, last.left_of, last.ground) == ((4,), (6,), (), False)


def test_neighbours_in_words(wall) -> None:
    assert beside_words(wall, part(wall, 1)) == "on the ground"
    # The wedge touches it too, and nobody sets a stone by a wedge beside it.
    assert beside_words(wall, part(wall, 3)) == "on the ground, right of 1"
    assert beside_words(wall, part(wall, 5)) == "on 1"
    assert beside_words(wall, part(wall, 6)) == "on 3, right of 5"


def test_wedges_in_words(wall) -> None:
    wedge = part(wall, 2)
    assert (
        wedge_words(wall, wedge)
        == "wedge 2: 150 \N{MULTIPLICATION SIGN} 30 mm, under its right end"
    )
    assert wedge_place(wall, wedge) == "right end"
    assert beside_words(wall, wedge) == "on the ground, under 1"


def test_lengths_have_units(wall) -> None:
    assert length_words(wall, 0.1234, 2.0) == "12.3, 200.0 cm"
    assert length_words(assembly(px_per_m=None), 12.3) == "12 px"
    assert size_words(assembly(px_per_m=None), 12.3, 4.0) == "12 \N{MULTIPLICATION SIGN} 4 px"


def test_the_lowest_corner_is_the_left_one_of_two(wall) -> None:
    assert lowest_corner(part(wall, 3)) == pytest.approx((0.3, 0.0))
    assert lowest_corner(part(wall, 7)) == pytest.approx((0.6, 0.15))


def test_it_does_not_matter_which_part_of_a_pair_an_interface_names_first(wall) -> None:
    turned = tuple(
        replace(face, block=face.other, other=face.block, normal=(-face.normal[0], -face.normal[1]))
        for face in wall.model.interfaces
        if face.other != GROUND
    )
    ground = tuple(face for face in wall.model.interfaces if face.other == GROUND)
    model = RigidBlockModel(wall.model.blocks, turned + ground)
    for part in wall.parts:
        assert beside(replace(wall, model=model), part) == beside(wall, part)


def test_stones_side_by_side_that_meet_at_a_corner_are_not_upon_each_other(wall) -> None:
    left, right = part(wall, 3), part(wall, 4)
    normal = {True: (0.8, 0.6), False: (-0.8, -0.6)}
    for first in (True, False):
        pair = (right.id, left.id) if first else (left.id, right.id)
        corner = Interface(*pair, np.array([[0.6, 0.15]]), normal[first])
        meeting = replace(wall, model=RigidBlockModel(wall.model.blocks, (corner,)))
        found = beside(meeting, right)
        assert (found.on, found.right_of) == ((), (left.step,))
    # A stone that a contact of the same slope carries over its width is on it.
    above = part(wall, 6)
    slope = Interface(above.id, left.id, np.array([[0.4, 0.15]]), (0.8, 0.6))
    carried = replace(wall, model=RigidBlockModel(wall.model.blocks, (slope,)))
    assert beside(carried, above).on == (left.step,)
