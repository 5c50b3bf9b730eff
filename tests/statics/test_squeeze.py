"""What stands only by friction on upright faces is named, and what stands without is not."""

import pytest
from hypothesis import assume, given

from drystone.contacts.given import model_from_json
from drystone.statics import squeeze
from drystone.statics.limit import lateral_resistance
from drystone.statics.loads import Loads, tilting_table
from drystone.statics.result import LateralResistance, LimitResult, LimitStatus
from drystone.statics.squeeze import held_by_upright_faces
from drystone_lab.statics_cases import arch
from tests.statics.walls import JAMS, between_piers, boxes, brick_model, slot, under_a_roof
from tests.strategies import repeatable


@given(**JAMS)
@repeatable(25)
def test_a_brick_between_piers_is_named(pier, height, gap, mu, covered):
    model = between_piers(pier, height, gap, mu, covered=covered)
    assume(lateral_resistance(model).stable)
    assert held_by_upright_faces(model) == (3,)


@pytest.mark.parametrize("slope_deg", [0, 10, 25, 35])
def test_a_block_that_hangs_under_leaning_faces_is_named(slope_deg):
    assert held_by_upright_faces(under_a_roof(slope_deg, 0.84)) == (2,)


def test_bonds_and_a_wedge_that_is_carried_by_its_weight_are_not_named():
    assert held_by_upright_faces(brick_model(4, 4, 1.0, 0.3)) == ()
    assert held_by_upright_faces(slot(-0.3, 0.3, 0.58)) == ()


def test_an_arch_stands_by_friction_near_its_crown():
    """Joints near the crown are upright; smooth ones carry one line of thrust only."""
    found = held_by_upright_faces(arch(15, 0.3, 0.5))
    assert found
    assert 8 in found  # the keystone


def test_blocks_in_two_places_are_all_named():
    piers = ([x, 0, 1, 4] for x in (0, 2, 4))
    assert held_by_upright_faces(boxes(*piers, [1, 1, 1, 1], [3, 2, 1, 1])) == (4, 5)


def test_the_dead_load_of_the_case_counts():
    """A smooth brick between piers rests where something carries its weight."""
    model = between_piers(1.0, 4.0, 1.0, 0.58)
    table = tilting_table(model)
    lifted = table.dead.copy()
    lifted[2, 1] = 0.0
    assert held_by_upright_faces(model, Loads(lifted, table.live)) == ()


def test_friction_of_pairs_stays_on_other_faces():
    """A block on a bed of its own friction, tilted so that the model's would not do."""
    rows = [[0, 0, 4, 1], [0.5, 1, 1, 1]]
    friction = [{"between": pair, "mu": 0.5} for pair in ([2, 1], [1, 0])]
    model = model_from_json({"blocks_xywh": rows, "mu": 0.0, "friction": friction})
    table = tilting_table(model)
    pushed = Loads(table.dead + 0.3 * table.live * [[0.0], [1.0]], table.live)
    assert held_by_upright_faces(model, pushed) == ()


def test_a_solver_that_gives_up_knows_nothing(monkeypatch):
    def failing(model, *_, **__):
        ends = (LimitResult(LimitStatus.FAILED, d) for d in ("left", "right"))
        return LateralResistance(*ends, model.mu)

    monkeypatch.setattr(squeeze, "lateral_resistance", failing)
    assert held_by_upright_faces(between_piers(1.0, 4.0, 1.0, 0.58)) is None
