"""Simulated beside predicted."""

import numpy as np
import pytest

from drystone.contacts.outlines import model_from_outlines
from drystone.physics.compare import TiltComparison, compare_with_tilt
from drystone.physics.scatter import TiltResult, Variation
from drystone.physics.scene import EngineSettings, Scene
from drystone.physics.tilt import TiltSettings, TiltTrial
from drystone_lab.statics_cases import MU, WALLS

ONCE = (Variation("as given", EngineSettings(), TiltSettings()),)
QUICK = (Variation("few iterations", EngineSettings(iterations=50), TiltSettings(coarse=0.064)),)


def trial(alpha: float | None, first: float | None = None, shift: float = 0.0) -> TiltTrial:
    """One that nothing is known of but this."""
    return TiltTrial("right", alpha, first, (), shift, 0.001, fell_at_rest=alpha is None)


def test_both_directions_of_a_stack() -> None:
    pytest.importorskip("pymunk", reason="pymunk is not installed (extra `physics`)")
    square = np.array([[0.0, 0], [10, 0], [10, 10], [0, 10], [0, 0]])
    outlines = {1: square, 2: square + np.array([2.0, 10.0])}
    found = compare_with_tilt(
        Scene(outlines, 0.9),
        model_from_outlines(outlines, 0.9),
        np.random.default_rng(0),
        nonassociative={"left": 0.6, "right": 0.5},
        variations=ONCE,
    )
    assert [one.direction for one in found] == ["left", "right"]
    assert [one.associative for one in found] == pytest.approx([0.6, 0.4])
    assert [one.simulated.alpha for one in found] == pytest.approx([0.6, 0.4], rel=0.012)
    assert [one.nonassociative for one in found] == [0.6, 0.5]
    assert found[1].inside(0.5) is False


def test_predictions_are_asked_for() -> None:
    pytest.importorskip("pymunk", reason="pymunk is not installed (extra `physics`)")
    square = np.array([[0.0, 0], [10, 0], [10, 10], [0, 10], [0, 0]])
    model = model_from_outlines({1: square}, 0.5)
    asked = []

    def predict(given: object, direction: str) -> float:
        asked.append((given, direction))
        return 0.25

    (found,) = compare_with_tilt(
        Scene({1: square}, 0.5),
        model,
        np.random.default_rng(0),
        nonassociative=predict,
        variations=ONCE,
        directions=("right",),
    )
    assert asked == [(model, "right")]
    assert found.nonassociative == 0.25


def test_a_published_wall_falls_without_dilatancy() -> None:
    """Example 3 of Ferris and Tin-Loi: .3558 without dilatancy, .4037 with."""
    pytest.importorskip("pymunk", reason="pymunk is not installed (extra `physics`)")
    wall = WALLS[2]
    outlines = {
        number: np.array([[x, y], [x + w, y], [x + w, y + h], [x, y + h]])
        for number, (x, y, w, h) in enumerate(wall.rectangles, 1)
    }
    (found,) = compare_with_tilt(
        Scene(outlines, MU),
        wall.model,
        np.random.default_rng(0),
        variations=QUICK,
        directions=("right",),
    )
    assert found.associative == pytest.approx(wall.associative, abs=1e-5)
    low, high = wall.nonassociative
    assert low <= found.simulated.alpha <= high
    assert found.inside(found.associative) is False


def test_the_scatter_is_that_of_the_trials() -> None:
    result = TiltResult("right", (trial(0.3, 0.1), trial(0.34, 0.2, 5.0), trial(0.31)), ("",) * 3)
    assert result.alpha == 0.31
    assert (result.low, result.high) == pytest.approx((0.299, 0.341))
    assert result.first_motions == (0.1, 0.2)
    assert result.settled_shift == 5.0
    assert not result.fell_at_rest
    compared = TiltComparison(result, 0.3405, None)
    assert compared.inside(0.3405) is True
    assert compared.inside(0.3415) is False
    assert compared.inside(0.2995) is True
    assert compared.inside(0.2985) is False
    assert compared.inside(None) is None
    assert compared.inside(0.1995, "first motion") is True
    assert compared.inside(0.0985, "first motion") is False


def test_walls_that_fall_at_rest_have_no_alpha() -> None:
    result = TiltResult("right", (trial(None), trial(None)), ("", ""))
    assert result.fell_at_rest
    assert (result.alpha, result.low, result.high, result.alphas) == (None, None, None, ())
    assert TiltComparison(result, 0.3, None).inside(0.3) is None
    some = TiltResult("right", (trial(None), trial(0.3)), ("", ""))
    assert TiltComparison(some, 0.3, None).inside(0.3) is None
