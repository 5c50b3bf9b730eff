"""Single blocks and stacks with closed forms, calculated from first principles, and arches.

The live load alpha A acts at the centroid.  A block b x h on the ground slides at alpha = mu and
overturns about its toe at alpha = (b / 2) / (h / 2); the first to come counts.  Tolerance 1e-8:
what the linear program's own tolerance of 1e-9 leaves.

Semicircular arches under their own weight have mean radius 1, n equal voussoirs with radial joints,
the springings radial too.  The classical answer for many voussoirs without sliding is t/R = .1075;
the values by n and those with friction were computed independently of this project.  The thickness
is given to five digits: one unit less must fall, one more stand.
"""

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from drystone.statics.flow.nonassociative import nonassociative_resistance
from drystone.statics.flow.release import held_by_upright_faces
from drystone.statics.limit import lateral_resistance
from drystone_lab import statics_cases
from tests.statics.walls import alphas, boxes
from tests.strategies import repeatable


@pytest.mark.parametrize(
    "case", statics_cases.closed_forms(), ids=lambda case: f"{case.name}, mu {case.mu}"
)
def test_what_the_cases_expect(case):
    """Single blocks, pairs and offset stacks by their formulas, and a bond that slides at mu.

    The last has no closed form; it is what a public program for block assemblies prints for it.
    """
    assert alphas(case.model) == pytest.approx((case.left, case.right), abs=1e-8)


def test_numbers_of_the_cases():
    """Sliding and overturning of 1 x 2 and the shifted block by hand: (.5 - .2) / .5 and so on."""
    block, pair = (statics_cases.aligned_blocks(*one) for one in ((1, 1, 2, 0.7), (2, 2, 1, 0.65)))
    assert (block.left, block.right, pair.left, pair.right) == (0.5, 0.5, 0.65, 0.65)
    stack = statics_cases.offset_stack(0.2, 0.9)
    assert (stack.left, stack.right) == pytest.approx((0.6, 0.4))
    assert len(statics_cases.running_bond().rectangles) == 10


@given(
    slabs=st.lists(
        st.tuples(st.floats(1.0, 2.5), st.floats(0.3, 1.5), st.floats(-0.3, 0.3)),
        min_size=2,
        max_size=9,
    ),
    unit=st.sampled_from([1e-3, 1.0, 1e3]),
    mu=st.sampled_from([0.3, 0.6, 0.9]),
)
@repeatable(40)
def test_towers_of_slabs(slabs, unit, mu):
    """Each joint carries one resultant: above it all slides at mu, or turns about an end of it."""
    rows, left, top = [], 0.0, 0.0
    for width, height, shift in slabs:
        left += shift
        rows.append((left, top, width, height))
        top += height
    sides = [mu, mu]
    for k, (x, y, width, _) in enumerate(rows):
        below = rows[max(k - 1, 0)]
        ends = max(x, below[0]), min(x + width, below[0] + below[2])
        lefts, bottoms, widths, heights = np.transpose(rows[k:])
        weights = widths * heights
        turning = weights @ (bottoms + heights / 2 - y)
        for side, sign in enumerate((-1.0, 1.0)):
            restoring = weights @ (sign * (ends[side] - lefts - widths / 2))
            sides[side] = min(sides[side], restoring / turning)
    assume(abs(min(sides)) > 1e-6)
    model = boxes(*(unit * np.array(rows)), mu=mu)
    assert lateral_resistance(model).stable == (min(sides) > 0.0)
    if min(sides) > 0.0:
        assert alphas(model) == pytest.approx(tuple(sides), abs=1e-7)
        assert held_by_upright_faces(model) == ()


@pytest.mark.parametrize("gap", [0.0, 0.025])
@pytest.mark.parametrize("courses", [2, 4])
def test_low_bonds_slide_with_head_joints_open_or_closed(gap, courses):
    """Bricks 1 x .25 in running bond, half bricks at the ends of every other course."""
    half, rows = (1.0 - gap) / 2.0, []
    for course in range(courses):
        left = 0.0
        for width in [1.0] * 5 if course % 2 == 0 else [half, *[1.0] * 4, half]:
            rows.append((left, 0.25 * course, width, 0.25))
            left += width + gap
    model = boxes(*rows, mu=0.6)
    assert alphas(model) == pytest.approx((0.6, 0.6), abs=1e-7)
    both = nonassociative_resistance(model)
    assert (both.left.alpha, both.right.alpha) == pytest.approx((0.6, 0.6), abs=1e-7)


@pytest.mark.parametrize(
    "case", [*statics_cases.WITHOUT_SLIDING[:-1], *statics_cases.WITH_FRICTION], ids=str
)
def test_least_thickness_of_arches(case):
    """None is enough where friction is too little."""
    least = case.least or statics_cases.THICKEST + 1e-5
    assert not statics_cases.stands(case.count, least - 1e-5, case.mu)
    assert case.least is None or statics_cases.stands(case.count, least + 1e-5, case.mu)
