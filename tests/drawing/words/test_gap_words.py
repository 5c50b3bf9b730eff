"""What is said of how wide the gaps are that are closed."""

import numpy as np

from drystone.contacts.blocks import model_from_labels
from drystone.contacts.gaps import settle_gaps
from drystone.drawing.words.modelling import gap_spread
from drystone.statics.limit import lateral_resistance
from tests.contacts.test_gaps import bond


def test_the_spread_says_what_the_reach_decides():
    labels = bond(6, 20, 38, 2)
    assert gap_spread(labels, 2) == (
        "F_LR .596 with gaps up to 2 px closed (unstable with gaps up to 1 px closed,"
        " .596 with gaps up to 4 px closed)"
    )
    settled, left, right = (
        lateral_resistance(model_from_labels(settle_gaps(labels, push)[0]).model).value
        for push in (None, "left", "right")
    )
    assert gap_spread(labels, None) == (
        f"F_LR {settled:.3f} with stones settled ({left:.3f} with stones pushed left,"
        f" {right:.3f} with stones pushed right)"
    ).replace("0.", ".")
    stack = np.kron([[1], [0], [2]], np.ones((2, 8), int))
    without = gap_spread(stack, 2, mu=0.0)
    assert without.startswith("F_LR not defined with gaps up to 2 px closed (unstable")
