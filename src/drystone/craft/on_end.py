"""Stones on end: the longer side of the face upright."""

import numpy as np
import shapely

from drystone.craft.finding import Case, Finding, Limit, Line, Rule
from drystone.craft.masonry import Masonry

RULE = Rule(
    "on_end",
    "stones on end",
    "Lay a stone on its bed: no stone stands higher than it is long.",
    "Corcoran 2018, rule 4 (no stone higher than long); Bayer Stone, laying random ashlar (no "
    "stone on its end). From which elongation it counts: own definition",
    "share of the stones whose longer side stands steeper than 45 degrees",
    higher_is_better=False,
    limit=Limit(0.05, 0.15),
)


def find(masonry: Masonry, limit: Limit = RULE.limit) -> Finding:
    """Find stones that stand on end.

    Length and breadth are those of the smallest rectangle around the face.  A stone that is laid
    with its length along the face instead of into the wall (a traced stone), or with the bedding
    of its rock upright (face-bedded), cannot be told from the face.

    Parameters
    ----------
    masonry : Masonry
        Any wall.
    limit : Limit
        Of the number.

    Examples
    --------
    >>> import numpy as np
    >>> post = np.array([[0, 0], [1, 0], [1, 2], [0, 2]])
    >>> find(Masonry({1: post, 2: post[:, ::-1] + [1, 0]})).cases[0].stones
    (1,)
    """
    if not masonry.stones:
        return Finding(RULE, limit, None, "not judged", note="There are no stones.")
    cases = []
    longer = 0
    for stone, loop in masonry.stones.items():
        axis, elongation = _long_axis(loop)
        if elongation < masonry.settings.elongation - 1e-9:
            continue
        longer += 1
        dx, dy = np.abs(axis[1] - axis[0]).tolist()
        if dy > dx * (1.0 + 1e-9):
            words = f"{elongation:.1f} times as high as long"
            cases.append(Case((stone,), round(elongation, 6), words, (axis,)))
    number = len(cases) / len(masonry.stones)
    cases.sort(key=lambda case: -case.value)
    figures = {"stones with a longer side": float(longer)}
    return Finding(RULE, limit, number, RULE.verdict(number, limit), tuple(cases), figures)


def _long_axis(loop: Line) -> tuple[Line, float]:
    """Return the middle line of the smallest rectangle around an outline, and length/breadth."""
    around = shapely.oriented_envelope(shapely.MultiPoint(loop))
    corners = shapely.get_coordinates(around)[:4]
    one, other = corners[1] - corners[0], corners[2] - corners[1]
    sides = float(np.hypot(*one)), float(np.hypot(*other))
    along = one if sides[0] >= sides[1] else other
    middle = corners.mean(axis=0)
    line = np.array([middle - 0.4 * along, middle + 0.4 * along])
    return line, max(sides) / min(sides)
