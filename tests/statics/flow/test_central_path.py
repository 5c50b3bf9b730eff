"""Central paths: a slow twin, closed forms and published walls by paths alone, and many points."""

import numpy as np
import pytest

from drystone.contacts.blocks import model_from_labels
from drystone.statics.flow import central_path, flow_search
from drystone.statics.flow.central_path import CentralPath
from drystone.statics.flow.flow_search import ContactRates, NonassociativeSettings
from drystone.statics.flow.nonassociative import nonassociative_resistance
from drystone.statics.lp.program import assemble
from drystone.statics.result import LimitStatus
from drystone_lab.statics_cases import WALLS, closed_forms
from tests.naive.central_path import end_of_path
from tests.statics import walls
from tests.statics.walls import irregular

ONLY_PATHS = NonassociativeSettings(starts=(), random_starts=0)


@pytest.mark.parametrize("closing", [0.0, 1.0])
@pytest.mark.parametrize("sign", [1.0, -1.0])
@pytest.mark.parametrize("model", [walls.boxes([0, 0, 1, 2]), walls.brick_model(2, 2, 1.0, 0.58)])
def test_the_end_of_a_path_equals_its_twin(model, sign, closing):
    """To what t = 1e-9 leaves of the slowest velocities."""
    program = assemble(model)
    rates = ContactRates.of(program)
    found = CentralPath(program, rates.normal, rates.slip, sign).motion(closing, lambda: None)
    live = sign * program.matrix[:, [0]].toarray().ravel()
    dense = rates.normal.toarray(), rates.slip.toarray()
    expected = end_of_path(*dense, live, program.rhs, closing, central_path.END)
    assert found == pytest.approx(expected, abs=1e-3 * np.abs(expected).max())


@pytest.mark.parametrize("case", closed_forms(), ids=lambda case: f"{case.name}, mu {case.mu}")
def test_paths_alone_find_closed_forms(case):
    both = nonassociative_resistance(case.model, settings=ONLY_PATHS)
    assert (both.left.alpha, both.right.alpha) == pytest.approx((case.left, case.right), abs=1e-7)


@pytest.mark.parametrize(("wall", "least"), [(0, 0.63898), (1, 0.5574), (2, 0.35582)])
def test_paths_alone_find_the_least_known_loads_of_published_walls(wall, least):
    """Ferris and Tin-Loi (2001); what a nonlinear solver found, see tests/validation."""
    both = nonassociative_resistance(WALLS[wall].model, settings=ONLY_PATHS)
    for result in (both.left, both.right):
        assert result.check.holds
        assert result.alpha == pytest.approx(least, abs=2e-5)


def test_a_path_that_turns_back_leads_to_a_lower_load_than_a_straight_one():
    model = model_from_labels(irregular(4, 18, 100, 70), 0.58).model
    found = nonassociative_resistance(model, settings=ONLY_PATHS).left
    assert found.method == "central path, closing 1"
    assert found.answers == pytest.approx((0.552872, 0.556732), abs=1e-6)
    assert found.check.holds


def test_many_points_take_paths_first_and_then_few_rounds(monkeypatch):
    monkeypatch.setattr(flow_search, "MANY_POINTS", 10)
    monkeypatch.setattr(flow_search, "EFFORT", 5.0 * 166**2)
    result = nonassociative_resistance(WALLS[0].model).right
    assert result.method == "central path, closing 0"
    assert result.alpha == pytest.approx(0.63898, abs=5e-6)
    assert result.rounds == 2 + 5  # both paths close at once


@pytest.mark.parametrize("covered", [False, True])
def test_many_points_are_let_go_too(monkeypatch, covered):
    monkeypatch.setattr(flow_search, "MANY_POINTS", 0)
    result = nonassociative_resistance(walls.between_piers(covered=covered)).right
    assert (result.status, result.method) == (LimitStatus.UNSTABLE, "let go")
    assert result.check.holds


def test_what_look_raises_ends_a_path():
    program = assemble(WALLS[0].model)
    rates, looks = ContactRates.of(program), []

    def look():
        looks.append(None)
        if len(looks) == 20:
            raise TimeoutError

    with pytest.raises(TimeoutError):
        CentralPath(program, rates.normal, rates.slip, 1.0).motion(0.0, look)


def test_a_block_on_nothing_has_no_path():
    """No contact holds it, so nothing but its weight is in the equations."""
    program = assemble(walls.boxes([0, 5, 1, 1]))
    rates = ContactRates.of(program)
    assert CentralPath(program, rates.normal, rates.slip, 1.0).motion(0.0, lambda: None) is None
