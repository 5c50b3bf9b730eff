"""The shaking table against closed forms.

A rigid block slides when the ground accelerates by more than mu g, and rocks from b/h g on
(Housner 1963).  The longer the period, the closer to these values it moves by a given limit.
"""

import numpy as np
import pytest

from drystone.physics.shake import ShakeSettings, shake_once, sinusoid
from tests.physics.test_tilt import scene_of

SLOW = ShakeSettings(period=40.0, cycles=1, limit=0.02, coarse=0.064, fine=0.008)
"""Nearly as if the ground was tilted; a limit that is hardly a movement."""


def test_closed_forms():
    for name, scene, expected in (
        ("flat block slides", scene_of((0, 0, 2, 1), mu=0.4), 0.4),
        ("tall block rocks", scene_of((0, 0, 1, 4), mu=0.7), 0.25),
        ("any unit of length", scene_of((0, 0, 10, 20), mu=0.7), 0.5),
    ):
        pga_g = shake_once(scene, None, SLOW)
        # Never earlier, but for a step; later by what it takes to get as far as the limit.
        assert expected - SLOW.fine <= pga_g <= 1.03 * expected + SLOW.fine, name


def test_what_does_not_stand_has_no_amplitude_and_what_never_moves_stands_all():
    assert shake_once(scene_of((0, 0, 1, 1), (0.6, 1, 1, 1), mu=0.6)) is None
    settings = ShakeSettings(period=4.0, cycles=1, greatest=0.2)
    assert shake_once(scene_of((0, 0, 4, 1), mu=0.9), None, settings) == pytest.approx(0.2)


def test_only_what_is_watched_counts():
    """A tall block rocks before the flat one beside it slides."""
    scene = scene_of((0, 0, 2, 1), (20, 0, 0.5, 3), mu=0.5)
    settings = ShakeSettings(period=8.0, cycles=1)
    all_of_them = shake_once(scene, None, settings)
    flat = shake_once(scene, None, settings, watched={1})
    assert flat >= 0.5 - settings.fine > all_of_them


def test_the_ground_comes_back_to_rest():
    """Whole cycles: speed sums up to nothing, the peak is the amplitude."""
    signal = sinusoid(0.4, ShakeSettings(period=7.0, cycles=2), 0.01)
    assert len(signal) == 1400
    assert signal.max() == pytest.approx(0.4, rel=1e-4)
    assert signal.sum() == pytest.approx(0.0, abs=1e-9)
    assert np.all(signal[:350] > 0)
