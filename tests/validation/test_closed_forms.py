"""Single blocks and stacks with closed forms, calculated from first principles.

The live load alpha A acts at the centroid.  A block b x h on the ground slides at alpha = mu and
overturns about its toe at alpha = (b / 2) / (h / 2); the first to come counts.  Tolerance 1e-8:
what the linear program's own tolerance of 1e-9 leaves.
"""

import pytest

from drystone.experiments.cases import (
    closed_forms,
    offset_stack,
    running_bond,
    single_block,
    two_equal_blocks,
)
from drystone.statics.limit import lateral_resistance

TOLERANCE = 1e-8


def alphas(case):
    both = lateral_resistance(case.model)
    return both.left.alpha, both.right.alpha


@pytest.mark.parametrize(
    ("width", "height", "mu", "expected"),
    [
        (1, 1, 0.3, 0.3),
        (1, 2, 0.7, 0.5),
        (1, 4, 0.65, 0.25),
        (2, 1, 0.65, 0.65),
        (1, 1, 0.58, 0.58),
        (1, 4, 0.58, 0.25),
        (0.2, 1.0, 0.7, 0.2),  # the block of Portioli's examples
    ],
)
def test_single_block(width, height, mu, expected):
    """min(mu, b/h)."""
    found = alphas(single_block(width, height, mu))
    assert found == pytest.approx((expected, expected), abs=TOLERANCE)


@pytest.mark.parametrize(("width", "height", "mu"), [(1, 1, 0.65), (2, 1, 0.65), (3, 0.5, 0.9)])
def test_two_equal_blocks(width, height, mu):
    """min(mu, b/(2h)): both overturn as one."""
    expected = min(mu, width / (2 * height))
    found = alphas(two_equal_blocks(width, height, mu))
    assert found == pytest.approx((expected, expected), abs=TOLERANCE)


@pytest.mark.parametrize("shift", [0.0, 0.1, 0.2, 0.4, 0.5])
@pytest.mark.parametrize("mu", [0.3, 0.9])
def test_offset_stack(shift, mu):
    """A unit block on a unit block, shifted towards +x.

    Towards +x the top block overturns about the lower one's edge at (.5 - s) / .5, both about the
    ground at (.5 + .5 - s) / (.5 + 1.5); towards -x the top block at 1, both at
    (.5 + .5 + s) / (.5 + 1.5).
    """
    right = min(mu, (0.5 - shift) / 0.5, (1.0 - shift) / 2.0)
    left = min(mu, 1.0, (1.0 + shift) / 2.0)
    found = alphas(offset_stack(shift, mu))
    assert found == pytest.approx((left, right), abs=TOLERANCE)


def test_running_bond_of_four_courses_slides():
    """Bricks 2 x 1 in four courses of running bond, mu .58: alpha = mu.

    No closed form; the value that a public program for block assemblies prints for this wall.
    """
    assert len(running_bond().rectangles) == 10
    assert alphas(running_bond()) == pytest.approx((0.58, 0.58), abs=TOLERANCE)


@pytest.mark.parametrize("case", closed_forms(), ids=lambda case: f"{case.name}, mu {case.mu}")
def test_what_the_cases_expect(case):
    assert alphas(case) == pytest.approx((case.left, case.right), abs=TOLERANCE)
