"""The load multiplier over friction."""

import pytest

from drystone.drawing.pictures.friction import plot_friction
from drystone.statics.friction_curve import AtFriction

CURVE = (AtFriction(0.4, 0.3, 0.4), AtFriction(0.6, None, 0.5))


@pytest.mark.parametrize("slides_at_mu", [True, False])
def test_a_wall_slides_at_mu_on_a_tilting_table_only(slides_at_mu):
    axes = plot_friction(CURVE, 0.58, slides_at_mu=slides_at_mu)
    words = [text.get_text() for text in axes.get_legend().get_texts()]
    assert ("the whole wall slides" in words) == slides_at_mu
    assert {"to the left", "to the right"} <= set(words)
