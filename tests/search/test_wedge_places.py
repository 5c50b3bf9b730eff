"""Which wedges stand in the way of a mechanism, and how much."""

from dataclasses import replace

import numpy as np
import pytest

from drystone.contacts.settled import model_with_outlines
from drystone.search.wedge_places import Motion, WedgePlace
from drystone.statics.limit import lateral_resistance
from drystone.statics.model import GROUND, Block, RigidBlockModel
from drystone.statics.result import LimitResult, Mechanism
from tests.naive.wedging import NaiveMotion
from tests.search.wedge_walls import all_places, limits_of, small_walls

MU = 0.5


def motion_of(model: RigidBlockModel, mechanism: Mechanism) -> Motion:
    told = zip(mechanism.block_ids, mechanism.velocity.tolist(), strict=True)
    return Motion.of(dict(told), {block.id: block.centroid for block in model.blocks}, model.mu)


def failing(model: RigidBlockModel) -> LimitResult:
    both = lateral_resistance(model, mechanism=True)
    assert both.left.alpha is not None
    assert both.right.alpha is not None
    return both.left if both.left.alpha <= both.right.alpha else both.right


def test_what_the_mechanism_does_not_violate_does_not_help() -> None:
    seen = {True: 0, False: 0}
    for _, made in small_walls():
        build = made.build
        one = failing(build.model)
        assert one.mechanism is not None
        assert one.alpha is not None
        outlines = build.wall.outlines
        assert outlines is not None
        lax = replace(limits_of(made), least_thickness=0.1, greatest_height=12.0, mu=3.0)
        places = all_places(build, lax)
        rates = motion_of(build.model, one.mechanism).resisted_by(places)
        naive = NaiveMotion(build.model, one.mechanism)
        for place, rate in zip(places, rates.tolist(), strict=True):
            new, near_px = [(999, place.corners)], limits_of(made).contact_px
            model = model_with_outlines(build.model, new, outlines, near_px)
            assert model.added is not None
            assert rate == pytest.approx(naive.resisted_by(model.added.interfaces), abs=1e-9)
            violated = rate > 1e-9
            # The weight of the wedge is another thing: here it has none.
            weightless = replace(model.blocks[-1], density=1e-9)
            after = lateral_resistance(replace(model, blocks=(*model.blocks[:-1], weightless)))
            alpha = after.left.alpha if one.direction == "left" else after.right.alpha
            assert alpha is not None
            assert violated or alpha <= one.alpha + 1e-6
            seen[violated] += 1
    assert min(seen.values()) > 3


def motion(*velocity: float) -> Motion:
    """A block 4 px wide and 2 high over the ground, 1 px above it, that moves."""
    model = RigidBlockModel((Block(1, 8.0, (2.0, 2.0)),), (), MU)
    return motion_of(model, Mechanism((1,), np.array([velocity])))


def wedge(*touching: tuple[int, float, tuple[float, float]]) -> WedgePlace:
    """A wedge under the right end of that block: what it touches, at which height, how."""
    contacts = [(other, (x, y), normal) for other, y, normal in touching for x in (3.0, 4.0)]
    return WedgePlace(
        0,
        np.array([[3.0, 0.0], [4.0, 0.0], [4.0, 1.0], [3.0, 1.0]]),
        np.array([other for other, _, _ in contacts], np.int64),
        np.array([point for _, point, _ in contacts], float).reshape(-1, 2),
        np.array([normal for _, _, normal in contacts], float).reshape(-1, 2),
    )


LOW, HIGH = (GROUND, 0.0, (0.0, 1.0)), (1, 1.0, (0.0, -1.0))


@pytest.mark.parametrize(
    ("velocity", "rate"),
    [
        ((0.0, -1.0, 0.0), 1.0),  # down onto the wedge
        ((0.0, 1.0, 0.0), 0.0),  # up
        ((1.0, 0.5, 0.0), 0.0),  # along it, and up as friction asks for
        ((1.0, 0.25, 0.0), 0.25),
        ((-1.0, 0.25, 0.0), 0.25),
        # Clockwise about the centroid: 2 down at its end, 1 or 2 to the left below.
        ((0.0, 0.0, -1.0), 2.5),
    ],
)
def test_the_rate_is_that_of_the_worst_point_and_the_best_neighbour(
    velocity: tuple[float, ...], rate: float
) -> None:
    rates = motion(*velocity).resisted_by([wedge(LOW), wedge(LOW, HIGH), wedge()])
    assert rates.tolist() == pytest.approx([0.0, rate, 0.0])


def test_what_touches_one_side_only_moves_along() -> None:
    falling = motion(0.0, -1.0, 0.0)
    assert falling.resisted_by([wedge(HIGH)]).tolist() == [0.0]
    assert falling.resisted_by([wedge()]).tolist() == [0.0]
    assert falling.resisted_by([]).tolist() == []


def test_blocks_stand_still_that_do_not_move() -> None:
    assert motion(0.0, 0.0, 0.0).stands_still([GROUND, 1])
    assert motion(0.0, 0.0, 1.0).stands_still([GROUND])
    for velocity in ((0.0, 0.0, -1.0), (0.0, -1e-6, 0.0), (1.0, 0.0, 0.0)):
        assert not motion(*velocity).stands_still([GROUND, 1])
