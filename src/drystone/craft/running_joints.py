"""Running joints: head joints that go on through several courses."""

from drystone.craft.chains import Chain
from drystone.craft.finding import Case, Finding, Limit, Rule
from drystone.craft.masonry import Masonry

RULE = Rule(
    "running_joints",
    "running joints",
    "Cross every upright joint with the next stone; no joint runs up through several courses.",
    "Adcock 1994, principle 1 (cover all joints; a joint of two stones only once in a blue moon); "
    "Bowland Dry Stone Walling 2024 (no seam of more than two stones or courses); the paper, "
    "section 2 (offset vertical joints)",
    "courses that the longest joint goes through: the lesser number of stones on its two sides",
    higher_is_better=False,
    limit=Limit(1, 2),
    unit="courses",
)


def find(masonry: Masonry, limit: Limit = RULE.limit) -> Finding:
    """Find the joints that go through two courses or more.

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
    >>> found.number, found.cases[0].stones
    (2.0, (1, 3, 2, 4))
    """
    every = masonry.chains
    if not every:
        return Finding(RULE, limit, None, "not judged", note="There are no upright joints.")
    height = masonry.mean_height
    running = [chain for chain in every if chain.courses > 1]
    running.sort(key=lambda one: (-one.courses, -round(one.height / height, 6), one.line[0, 0]))
    number = float(max(chain.courses for chain in every))
    whole = sum(joint.length for chain in every for joint in chain.joints)
    long = sum(joint.length for chain in running for joint in chain.joints)
    figures = {
        "longest joint, mean stone heights": max(chain.height for chain in every) / height,
        "joints through two courses": float(sum(chain.courses == 2 for chain in running)),
        "joints through three or more": float(sum(chain.courses > 2 for chain in running)),
        "share of the length of all upright joints": long / whole,
    }
    cases = tuple(_case(chain, height) for chain in running)
    return Finding(RULE, limit, number, RULE.verdict(number, limit), cases, figures)


def _case(chain: Chain, height: float) -> Case:
    words = f"{chain.courses} courses, {chain.height / height:.1f} mean stone heights"
    stones = tuple(dict.fromkeys(chain.left + chain.right))
    return Case(stones, float(chain.courses), words, (chain.line,), at_fault=0)
