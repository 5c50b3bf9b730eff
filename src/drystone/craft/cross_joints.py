"""Cross joints: four stones that meet at one point, a plus instead of a T."""

from collections.abc import Iterator

import numpy as np

from drystone.craft.chains import Chain
from drystone.craft.finding import Case, Finding, Limit, Line, Rule
from drystone.craft.joints import Joint
from drystone.craft.masonry import Masonry

RULE = Rule(
    "cross_joints",
    "cross joints",
    "Joints meet as a T, never as a plus: no four stones at one point.",
    "Corcoran 2018, rule 8 (no cross joints in the built wall); Kemmler, guide to setting a dry "
    "wall (no Kreuzfugen)",
    "points at which four stones meet, per ten stones",
    higher_is_better=False,
    limit=Limit(0.0, 1.0),
    unit="per 10 stones",
)


def find(masonry: Masonry, limit: Limit = RULE.limit) -> Finding:
    """Find points at which an upright joint crosses a bed joint.

    Parameters
    ----------
    masonry : Masonry
        Any wall.
    limit : Limit
        Of the number.

    Examples
    --------
    >>> import numpy as np
    >>> brick = np.array([[0, 0], [2, 0], [2, 1], [0, 1]])
    >>> places = [(0, 0), (2, 0), (0, 1), (2, 1)]
    >>> stack = Masonry({i: brick + place for i, place in enumerate(places, 1)})
    >>> found = find(stack)
    >>> found.number, [case.stones for case in found.cases]
    (2.5, [(1, 2, 3, 4)])
    """
    if not masonry.heads:
        return Finding(RULE, limit, None, "not judged", note="There are no upright joints.")
    cases = tuple(case for chain in masonry.chains for case in _crosses(masonry, chain))
    number = 10.0 * len(cases) / len(masonry.stones)
    worst = sorted(cases, key=lambda case: case.value)
    figures = {"points": float(len(cases))}
    return Finding(RULE, limit, number, RULE.verdict(number, limit), tuple(worst), figures)


def _crosses(masonry: Masonry, chain: Chain) -> Iterator[Case]:
    """Yield where both sides of a chain change at nearly the same height."""
    height = masonry.mean_height
    reach = masonry.settings.offset * height + 2.0 * masonry.rows.spacing
    begin = 0
    while begin + 1 < len(chain.joints):
        lower = chain.joints[begin]
        end = _other_sides(chain.joints, begin, reach)
        if end is None:
            begin += 1
            continue
        upper, begin = chain.joints[end], end
        four = (lower.first, lower.second, upper.first, upper.second)
        apart = abs(float(upper.bottom[0] - lower.top[0])) / height
        words = f"{apart:.2f} mean stone heights from joint to joint"
        yield Case(four, round(apart, 9), words, _plus(lower.top, upper.bottom, height), 0)


def _other_sides(joints: tuple[Joint, ...], begin: int, reach: float) -> int | None:
    """Return the next joint between two other stones; None when there is none within reach."""
    passed = 0.0
    for place in range(begin + 1, len(joints)):
        one, other = joints[begin], joints[place]
        if one.first != other.first and one.second != other.second:
            return place
        passed += other.length
        if passed > reach:
            return None
    return None


def _plus(low: Line, high: Line, height: float) -> tuple[Line, ...]:
    middle = 0.5 * (low + high)
    arms = 0.3 * height * np.eye(2)
    return tuple(np.array([middle - arm, middle + arm]) for arm in arms)
