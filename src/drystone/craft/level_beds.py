"""Level beds."""

import numpy as np

from drystone.craft.edges import Edge, edges
from drystone.craft.finding import Case, Finding, Limit, Rule
from drystone.craft.masonry import Masonry

RULE = Rule(
    "level_beds",
    "level beds",
    "Lay stones level: beds that slope make stones slide.",
    "Welch and Post, The Stone Trust, rule 1 (stones and courses level); Corcoran 2018, rule 10; "
    "the paper, section 2 (courses straight and level). The limits: own definition",
    "mean slope of the lower and upper edges of the stones, by their widths",
    higher_is_better=False,
    limit=Limit(5.0, 10.0),
    unit="°",
)


def find(masonry: Masonry, limit: Limit = RULE.limit) -> Finding:
    """Find beds that slope.

    Parameters
    ----------
    masonry : Masonry
        Any wall.
    limit : Limit
        Of the number, degrees.

    Examples
    --------
    >>> import numpy as np
    >>> find(Masonry({1: np.array([[0, 0], [2, 0], [2, 1], [0, 3]])})).number
    22.5
    """
    found = edges(masonry)
    if not found:
        return Finding(RULE, limit, None, "not judged", note="No stone is wide enough.")
    slopes = np.array([abs(edge.angle_deg) for edge in found])
    widths = np.array([edge.width for edge in found])
    number = round(float(slopes @ widths / widths.sum()), 9)
    steep = [edge for edge in found if abs(edge.angle_deg) > masonry.settings.steep_deg + 1e-9]
    steep.sort(key=lambda edge: -round(abs(edge.angle_deg), 6))
    figures = {
        "steepest": float(slopes.max()),
        "share of the edges that are too steep": len(steep) / len(found),
    }
    cases = tuple(_case(edge) for edge in steep)
    return Finding(RULE, limit, number, RULE.verdict(number, limit), cases, figures)


def _case(edge: Edge) -> Case:
    falls = "right" if edge.slope < 0 else "left"
    words = f"{edge.side} edge falls to the {falls} by {abs(edge.angle_deg):.0f}°"
    return Case((edge.stone,), round(abs(edge.angle_deg), 6), words, (edge.line,))
