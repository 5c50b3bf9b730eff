"""Ends of the wall that slope inwards."""

from drystone.craft.edges import edges
from drystone.craft.finding import Case, Finding, Limit, Rule
from drystone.craft.masonry import Masonry

RULE = Rule(
    "inward_edges",
    "inward edges",
    "At the ends of the wall the upper edges fall inwards, so that nothing slides out.",
    "The paper, section 3.5, Eq. 10 (IS, inward slope of stones at the boundary); Delaware "
    "Quarries, rule 5, says it of slopes across the wall. A fitted line instead of two highest "
    "points, and the limits: own definition",
    "least inward slope (rise over run) of the upper edges at both ends; below 0 it is outwards",
    higher_is_better=True,
    limit=Limit(-0.1, -0.25),
)


def find(masonry: Masonry, limit: Limit = RULE.limit) -> Finding:
    """Find end stones whose upper edge falls outwards.

    Parameters
    ----------
    masonry : Masonry
        Any wall.
    limit : Limit
        Of the number.

    Examples
    --------
    >>> import numpy as np
    >>> wedge = np.array([[0, 0], [2, 0], [2, 2], [0, 1]])
    >>> brick = np.array([[2, 0], [4, 0], [4, 2], [2, 2]])
    >>> found = find(Masonry({1: wedge, 2: brick}))
    >>> round(found.number, 6), found.cases[0].stones, found.cases[0].words
    (-0.5, (1,), 'upper edge at the left end falls outwards by 27°')
    """
    left, right = masonry.ends
    # A stone from end to end has no inward side.
    sides = dict.fromkeys(right - left, 1.0) | dict.fromkeys(left - right, -1.0)
    ends = [edge for edge in edges(masonry) if edge.side == "upper" and edge.stone in sides]
    if not ends:
        return Finding(RULE, limit, None, "not judged", note="The wall has no two ends.")
    inward = {edge.stone: sides[edge.stone] * edge.slope for edge in ends}
    number = round(min(inward.values()), 9) + 0.0  # never -0
    cases = [
        Case(
            (edge.stone,),
            round(-inward[edge.stone], 6),
            f"upper edge at the {'right' if sides[edge.stone] > 0 else 'left'} end falls outwards "
            f"by {abs(edge.angle_deg):.0f}°",
            (edge.line,),
        )
        for edge in ends
        if inward[edge.stone] < -masonry.settings.outward - 1e-9
    ]
    cases.sort(key=lambda case: -case.value)
    figures = {
        "mean inward slope": sum(inward.values()) / len(inward),
        "end stones": float(len(inward)),
    }
    return Finding(RULE, limit, number, RULE.verdict(number, limit), tuple(cases), figures)
