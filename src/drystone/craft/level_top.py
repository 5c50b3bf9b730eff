"""A level top."""

import numpy as np

from drystone.craft.finding import Case, Finding, Limit, Rule
from drystone.craft.masonry import Masonry
from drystone.craft.slots import without_slots

RULE = Rule(
    "level_top",
    "level top",
    "Keep the wall at an even height along its length.",
    "Adcock 1994, principle 6; the number is T_LEVEL of `drystone measure` with joints that are "
    "open at the top bridged. The limits: own definition",
    "mean deviation of the top from its mean height, in mean stone heights",
    higher_is_better=False,
    limit=Limit(0.15, 0.3),
)

NAMED = 0.5
"""From which deviation of a stone's top it is named, mean stone heights."""


def find(masonry: Masonry, limit: Limit = RULE.limit) -> Finding:
    """Measure how level the top is, and name stones that stand out or lie low.

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
    >>> found = find(Masonry({1: brick, 2: brick + [2, 0], 3: brick + [0, 1]}))
    >>> found.number, [case.stones for case in found.cases]
    (0.5, [(2,), (3,)])
    """
    if not masonry.stones:
        return Finding(RULE, limit, None, "not judged", note="There are no stones.")
    ground, height = masonry.box[1], masonry.mean_height
    tops = np.full(len(masonry.columns.places), ground)
    owner = np.zeros(len(tops), np.int64)
    for place, runs in enumerate(masonry.columns.runs):
        for run in runs:
            if run.id in masonry.stones and run.end > tops[place]:
                tops[place], owner[place] = run.end, run.id
    tops = without_slots(tops, masonry.settings.joint * height / masonry.columns.spacing)
    number = round(float(np.abs(tops - tops.mean()).mean()) / height, 9)
    cases = []
    for stone in np.unique(owner[owner > 0]).tolist():
        mine = np.flatnonzero(owner == stone)
        x0, _, x1, _ = masonry.boxes[stone]
        if 2 * len(mine) * masonry.columns.spacing < x1 - x0:
            continue  # most of it is covered
        off = float(tops[mine].mean() - tops.mean()) / height
        if abs(off) >= NAMED - 1e-9:
            words = f"its top is {abs(off):.1f} mean stone heights {'high' if off > 0 else 'low'}"
            line = np.column_stack([masonry.columns.places[mine], tops[mine]])[[0, -1]]
            cases.append(Case((stone,), round(abs(off), 6), words, (line,)))
    cases.sort(key=lambda case: -case.value)
    return Finding(RULE, limit, number, RULE.verdict(number, limit), tuple(cases))
