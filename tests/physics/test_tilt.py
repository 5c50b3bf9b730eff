"""The tilt test and the shaking table against closed forms and published walls.

On a shaken table a rigid block slides when the ground accelerates by more than mu g, and rocks from
b/h g on (Housner 1963).  The longer the period, the closer to these values it moves by a limit.
"""

from dataclasses import replace

import numpy as np
import pytest

from drystone.errors import InputError
from drystone.physics.building import ROUNDED
from drystone.physics.scatter import TiltResult, Variation, compare_with_tilt, tilt_test
from drystone.physics.scene import EngineScene, EngineSettings
from drystone.physics.shake import ShakeSettings, shake_once, sinusoid
from drystone.physics.tilt import TiltSettings, TiltTrial, tilt_once
from drystone_lab.statics_cases import MU, WALLS
from tests.polygons import box_of

pytest.importorskip("pymunk", reason="pymunk is not installed (extra `physics`)")


def scene_of(*rectangles, mu, fixed=()):
    """Rectangles x, y, width, height, numbered from 1."""
    corners = {number: box_of(*sides) for number, sides in enumerate(rectangles, 1)}
    return EngineScene(corners, mu, fixed=frozenset(fixed))


COLUMN = scene_of(*((0.0, float(i), 1.0, 1.0) for i in range(6)), mu=0.7)
OFFSET = ((0.0, 0.0, 1.0, 1.0), (0.4, 1.0, 1.0, 1.0))
BOND = tuple(
    (left, float(course), width, 1.0)
    for course, ranges in enumerate(
        [[(0.0, 2.0), (2.0, 2.0)], [(0.0, 1.0), (1.0, 2.0), (3.0, 1.0)]]
    )
    for left, width in ranges
)
SUPPORTED = scene_of((0, 0, 3, 1), (1, 1, 1, 2), mu=0.7, fixed=(1,))
HOOK = np.array([[0, 0], [4, 0], [4, 3], [3, 3], [3, 1], [1, 1], [1, 3], [0, 3]], float)


def test_closed_forms():
    for name, scene, direction, expected in (
        ("tall block topples", scene_of((0, 0, 1, 2), mu=0.7), "right", 0.5),
        ("flat block slides, in any unit", scene_of((0, 0, 20, 10), mu=0.3), "left", 0.3),
        ("column of six", COLUMN, "left", 1 / 6),
        ("offset stack, over its edge", scene_of(*OFFSET, mu=0.9), "right", 0.2),
        ("offset stack, the other way", scene_of(*OFFSET, mu=0.9), "left", 0.7),
        ("running bond slides", scene_of(*BOND, mu=0.4), "right", 0.4),
        ("on a support", SUPPORTED, "right", 0.5),
    ):
        trial = tilt_once(scene, direction)
        assert trial.alpha == pytest.approx(expected, rel=0.012), name
        assert trial.first_motion == trial.alpha
        assert trial.settled_shift < 0.002 * scene.length


def test_concave_stones_keep_their_hollow():
    """A block in the hollow of a hook stands on its floor, and the hook weighs what it weighs."""
    block = np.array([[1.5, 1], [2.5, 1], [2.5, 2.5], [1.5, 2.5]])
    trial = tilt_once(EngineScene({1: HOOK, 2: block}, 0.9), "right")
    assert not trial.fell_at_rest
    assert trial.settled_shift < 0.01
    # The block leans against the wall of the hook at 1 / 1.5 and comes to rest there.
    assert trial.first_motion == pytest.approx(1 / 1.5, rel=0.012)
    assert trial.alpha > 0.7


def test_what_does_not_stand_has_no_alpha_and_what_never_falls_or_moves_says_so():
    hanging = scene_of((0, 0, 1, 1), (0.6, 1, 1, 1), mu=0.6)
    trial = tilt_once(hanging, "left")
    assert (trial.alpha, trial.first_motion, trial.fell_at_rest) == (None, None, True)
    assert shake_once(hanging) is None
    flat, settings = scene_of((0, 0, 2, 1), mu=0.58), TiltSettings(greatest=0.3)
    trial = tilt_once(flat, "right", None, settings)
    assert (trial.alpha, trial.fell_at_rest) == (None, False)
    shaking = ShakeSettings(period=4.0, cycles=1, greatest=0.2)
    assert shake_once(flat, None, shaking) == pytest.approx(0.2)


def test_what_rocks_comes_to_rest():
    """A half disc on its round side follows the tilt, far below .42: there it rolls away."""
    angles = np.linspace(np.pi, 2.0 * np.pi, 33)
    half = EngineScene({1: np.column_stack([np.cos(angles), 1.0 + np.sin(angles)])}, mu=0.58)
    steps = TiltSettings(coarse=0.13, fine=0.02)
    for speed_left, least, most in ((0.3, 0.2, 0.42), (0.5, 0.2, 0.42), (1.0, 0.0, 0.05)):
        # Without losses it rocks for ever, which counts as a fall.
        engine = replace(ROUNDED, speed_left=speed_left)
        assert least < tilt_once(half, "right", engine, steps).alpha < most


def test_same_input_same_result():
    scene = scene_of(*OFFSET, mu=0.9)
    plain = Variation("plain", EngineSettings(), TiltSettings())
    engine, settings = EngineSettings(corner_radius=2e-3), TiltSettings(from_level=True)
    both = plain, Variation("noisy", engine, settings, True, 1e-3, 1e-3)
    result, again = (tilt_test(scene, "right", np.random.default_rng(5), both) for _ in range(2))
    assert result == again
    low, high = result.interval("fall")
    assert low <= min(result.alphas) <= result.alpha <= max(result.alphas) <= high < low + 0.03
    assert result.alphas[1] == pytest.approx(0.2, abs=0.01)


def test_bad_scenes():
    for change, code in (
        ({"outlines": {1: np.zeros((2, 2))}}, "E303"),
        ({"outlines": {1: np.array([[0, 0], [1, 1], [1, 0], [0, 1]])}}, "E303"),
        ({"fixed": frozenset({1})}, "E303"),
        ({"mu": -1.0}, "E302"),
    ):
        with pytest.raises(InputError, match=code):
            EngineScene(**({"outlines": {1: box_of(0, 0, 1, 1)}, "mu": 0.6} | change))


def test_noise_stays_within_its_size_and_never_makes_an_outline_cross_itself():
    """The last has a notch a thousandth of the block wide, and corners shifted by as much."""
    scene = scene_of((0, 0, 4, 4), (5, 0, 4, 4), mu=0.6)
    noisy = Variation("", EngineSettings(), TiltSettings(), True, 1e-3, 2e-3)
    moved = noisy.of(scene, np.random.default_rng(1))
    assert set(moved.outlines) == {1, 2}
    for block, corners in moved.outlines.items():
        change = np.abs(corners - np.asarray(scene.shapes[block].exterior.coords)[:-1])
        assert 0.0 < change.max() <= 3e-3 * scene.length
    notched = [[0, 0], [1, 0], [1, 1], [0.501, 1], [0.5, 0.2], [0.499, 1], [0, 1]]
    scene = EngineScene({1: np.array(notched)}, 0.6)
    noisy = Variation("noisy", EngineSettings(), TiltSettings(), outline_noise=0.01)
    for seed in range(40):
        assert noisy.of(scene, np.random.default_rng(seed)).shapes[1].is_valid


def trial(alpha, first=None, shift=0.0):
    """One that nothing is known of but this."""
    return TiltTrial(alpha, first, shift, 0.001, fell_at_rest=alpha is None)


def test_the_scatter_is_that_of_the_trials():
    result = TiltResult("right", (trial(0.3, 0.1), trial(0.34, 0.2, 5.0), trial(0.31)))
    assert (result.alpha, result.settled_shift, result.fell_at_rest) == (0.31, 5.0, False)
    assert result.interval("fall") == pytest.approx((0.299, 0.341))
    assert result.high == pytest.approx(0.341)
    assert result.interval("first motion") == pytest.approx((0.099, 0.201))
    fallen = TiltResult("right", (trial(None), trial(None)))
    assert fallen.fell_at_rest
    assert (fallen.alpha, fallen.high, fallen.alphas) == (None, None, ())
    assert TiltResult("right", (trial(None), trial(0.3))).fell_at_rest


def test_a_published_wall_falls_without_dilatancy():
    """Example 3 of Ferris and Tin-Loi: .3558 without dilatancy, .4037 with."""
    wall = WALLS[2]
    quick = Variation("few", EngineSettings(iterations=20), TiltSettings(coarse=0.128, fine=0.004))
    scene, rng = scene_of(*wall.rectangles, mu=MU), np.random.default_rng(0)
    _, found = compare_with_tilt(scene, wall.model, rng, (quick,))
    assert found.simulated.direction == "right"
    assert found.associative == pytest.approx(wall.left, abs=1e-5)
    low, high = wall.nonassociative
    assert low <= found.simulated.alpha <= high
    assert low <= found.nonassociative <= high


SLOW = ShakeSettings(period=40.0, cycles=1, limit=0.02, coarse=0.064, fine=0.008)
"""Nearly as if the ground was tilted; a limit that is hardly a movement."""


def test_closed_forms_of_shaking():
    for name, scene, expected in (
        ("flat block slides", scene_of((0, 0, 2, 1), mu=0.4), 0.4),
        ("tall block rocks", scene_of((0, 0, 1, 4), mu=0.7), 0.25),
        ("any unit of length", scene_of((0, 0, 10, 20), mu=0.7), 0.5),
    ):
        pga_g = shake_once(scene, None, SLOW)
        # Never earlier, but for a step; later by what it takes to get as far as the limit.
        assert expected - SLOW.fine <= pga_g <= 1.03 * expected + SLOW.fine, name


def test_only_what_is_watched_counts():
    """A tall block rocks before the flat one beside it slides."""
    scene = scene_of((0, 0, 2, 1), (20, 0, 0.5, 3), mu=0.5)
    settings = ShakeSettings(period=8.0, cycles=1)
    all_of_them = shake_once(scene, None, settings)
    flat = shake_once(scene, None, settings, watched={1})
    assert flat >= 0.5 - settings.fine > all_of_them


def test_what_is_shaken_keeps_its_speed():
    """However much of it is left to blocks that come to rest."""
    scene, settings = scene_of((0, 0, 0.5, 3), mu=0.5), ShakeSettings(period=8.0, cycles=1)
    found = {shake_once(scene, EngineSettings(speed_left=s), settings) for s in (0.1, 0.5, 1.0)}
    assert len(found) == 1


def test_the_ground_comes_back_to_rest():
    """Whole cycles: speed sums up to nothing, the peak is the amplitude."""
    signal = sinusoid(0.4, ShakeSettings(period=7.0, cycles=2), 0.01)
    assert len(signal) == 1400
    assert signal.max() == pytest.approx(0.4, rel=1e-4)
    assert signal.sum() == pytest.approx(0.0, abs=1e-9)
    assert np.all(signal[:350] > 0)
