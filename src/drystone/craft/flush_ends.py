"""Flush ends."""

import numpy as np

from drystone.craft.finding import Case, Finding, Limit, Rule
from drystone.craft.masonry import Masonry

RULE = Rule(
    "flush_ends",
    "flush ends",
    "The ends of the wall are upright and in line.",
    "Own definition, like E_FLUSH of `drystone measure` but of the stones at the ends alone: a "
    "bed that is open from end to end, or an uneven top, is no ragged end",
    "mean gap between the ends of the wall and its end lines, in mean stone widths",
    higher_is_better=False,
    limit=Limit(0.1, 0.2),
)

NAMED = 0.25
"""From which gap beside a stone it is named, mean stone widths."""


def find(masonry: Masonry, limit: Limit = RULE.limit) -> Finding:
    """Measure how far the ends keep from upright lines through the outermost stones.

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
    >>> found = find(Masonry({1: brick, 2: brick + [0, 1], 3: brick + [1, 2]}))
    >>> round(found.number, 6), [case.stones for case in found.cases]
    (0.25, [(1,), (2,), (3,)])
    """
    if not masonry.stones:
        return Finding(RULE, limit, None, "not judged", note="There are no stones.")
    x0, _, x1, _ = masonry.box
    beside: dict[tuple[int, int], list[tuple[float, float]]] = {}
    for y, runs in zip(masonry.rows.places.tolist(), masonry.rows.runs, strict=True):
        stones = [run for run in runs if run.id in masonry.stones]
        if stones:
            pair = (stones[0].begin - x0, x1 - stones[-1].end)
            for side, (gap, run) in enumerate(zip(pair, (stones[0], stones[-1]), strict=True)):
                # Else the row runs through an open bed, or above the stones of the end.
                if run.id in masonry.ends[side]:
                    beside.setdefault((run.id, side), []).append((y, gap))
    if not beside:
        return Finding(RULE, limit, None, "not judged", note="The wall has no ends.")
    width = masonry.mean_width
    number = round(float(np.mean([gap for rows in beside.values() for _, gap in rows])) / width, 9)
    cases = []
    for (stone, side), rows in beside.items():
        mean = float(np.mean([gap for _, gap in rows])) / width
        if mean >= NAMED - 1e-9:
            end = "left" if side == 0 else "right"
            words = f"{mean:.2f} mean stone widths short of the {end} end"
            line = np.array([[(x0, x1)[side], rows[0][0]], [(x0, x1)[side], rows[-1][0]]])
            cases.append(Case((stone,), round(mean, 6), words, (line,)))
    cases.sort(key=lambda case: (-case.value, case.stones))
    return Finding(RULE, limit, number, RULE.verdict(number, limit), tuple(cases))
