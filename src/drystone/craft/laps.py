"""How far stones lap over the joints below them."""

from itertools import pairwise

import numpy as np

from drystone.craft.finding import Case, Finding, Limit, Rule
from drystone.craft.masonry import Masonry

RULE = Rule(
    "laps",
    "laps over joints",
    "A stone laps well over the joint below it, by a third of its length or at least a quarter.",
    "The idea: the paper, section 3.5, Eq. 9 (offset of joints by the width of a stone); Corcoran "
    "2018, rule 7 (half bond where possible); trockenmauerkurs.de, building rule 3 (lap of at "
    "least 10 cm). The quarter and the third: own definition",
    "share of the joints that a stone covers that it laps by less than a quarter of its width",
    higher_is_better=False,
    limit=Limit(0.1, 0.3),
)


def find(masonry: Masonry, limit: Limit = RULE.limit) -> Finding:
    """Find short laps.

    The lap is the distance from the joint between two stones that a stone rests on to the nearer
    side of that stone, over its width.

    Parameters
    ----------
    masonry : Masonry
        Any wall.
    limit : Limit
        Of the number.

    Examples
    --------
    >>> import numpy as np
    >>> brick = np.array([[0, 0], [4, 0], [4, 1], [0, 1]])
    >>> wall = Masonry({1: brick, 2: brick + [4, 0], 3: brick + [3.5, 1]})
    >>> found = find(wall)
    >>> found.number, found.cases[0].stones, found.cases[0].value
    (1.0, (3, 1, 2), 0.125)
    """
    laps = [lap for stone in masonry.stones for lap in _laps(masonry, stone)]
    if not laps:
        return Finding(RULE, limit, None, "not judged", note="No stone covers a joint.")
    values = np.array([lap.value for lap in laps])
    least = masonry.settings.lap - 1e-9
    number = float(np.mean(values < least))
    figures = {
        "laps": float(len(laps)),
        "mean lap": float(values.mean()),
        "share of at least a third": float(np.mean(values >= 1.0 / 3.0 - 1e-9)),
    }
    cases = sorted((lap for lap in laps if lap.value < least), key=lambda one: one.value)
    return Finding(RULE, limit, number, RULE.verdict(number, limit), tuple(cases), figures)


def _laps(masonry: Masonry, stone: int) -> list[Case]:
    x0, y0, x1, _ = masonry.boxes[stone]
    supports = masonry.supports[stone]
    found = []
    for left, right in pairwise(supports):
        x = 0.5 * (left[2] + right[1])
        lap = round(max(0.0, min(x - x0, x1 - x)) / (x1 - x0), 6)
        side = x0 if x - x0 < x1 - x else x1
        line = np.array([[x, y0], [side, y0]])
        words = f"the first laps the joint of the others by {100 * lap:.0f} % of its width"
        found.append(Case((stone, left[0], right[0]), lap, words, (line,)))
    return found
