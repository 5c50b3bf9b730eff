"""Big stones low in the wall."""

import numpy as np
import shapely

from drystone.craft.finding import Case, Finding, Limit, Rule
from drystone.craft.masonry import Masonry
from drystone.model.overlap import common_parts

RULE = Rule(
    "big_low",
    "big stones low",
    "Big stones go into the lower part of the wall, smaller ones above.",
    "Adcock 1994, principle 5; Delaware Quarries, rule 6. The number: own definition",
    "mean size of the stones above mid-height over that of those below; a stone across "
    "mid-height counts in both, by its shares",
    higher_is_better=False,
    limit=Limit(1.05, 1.3),
)


def find(masonry: Masonry, limit: Limit = RULE.limit) -> Finding:
    """Compare the sizes of stones below and above mid-height and name big ones above.

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
    >>> wall = Masonry({1: brick, 2: brick + [2, 0], 3: brick * [2, 1] + [0, 1]})
    >>> found = find(wall)
    >>> found.number, [case.stones for case in found.cases]
    (2.0, [(3,)])
    """
    if len(masonry.stones) < 2:
        return Finding(RULE, limit, None, "not judged", note="There are no two stones to compare.")
    x0, y0, x1, y1 = masonry.box
    middle = 0.5 * (y0 + y1)
    lower = shapely.box(x0, y0, x1, middle)
    areas = np.array([masonry.areas[i] for i in masonry.stones])
    lying = [
        sum(part.area for part in common_parts(shape, lower)) for shape in masonry.shapes.values()
    ]
    below = np.clip(np.array(lying) / areas, 0.0, 1.0)
    above = 1.0 - below
    if min(below.sum(), above.sum()) < 1e-9:
        return Finding(RULE, limit, None, "not judged", note="One half of the wall has no stone.")
    low, high = float(areas @ below / below.sum()), float(areas @ above / above.sum())
    mean = float(areas.mean())
    big = [
        (area / mean, stone)
        for stone, area, share in zip(masonry.stones, areas.tolist(), above.tolist(), strict=True)
        if share > 0.5 + 1e-9 and area >= (masonry.settings.big - 1e-9) * mean
    ]
    number = high / low
    cases = tuple(
        Case((stone,), round(times, 6), f"{times:.1f} times the mean area, above mid-height")
        for times, stone in sorted(big, key=lambda one: (-one[0], one[1]))
    )
    figures = {"mean area below over mean": low / mean, "mean area above over mean": high / mean}
    return Finding(RULE, limit, number, RULE.verdict(number, limit), cases, figures)
