"""All rules at once."""

from collections.abc import Mapping
from dataclasses import asdict, dataclass
from types import MappingProxyType
from typing import Any

from drystone.craft.bond import cross_joints, laps, one_over_two, running_joints
from drystone.craft.finding import Finding, Limit, Rule
from drystone.craft.lie import big_low, flush_ends, inward_edges, level_beds, level_top, on_end
from drystone.craft.masonry import Masonry
from drystone.craft.pins import pins
from drystone.craft.seats import seats, towers, voids, wedge_sizes
from drystone.errors import UsageError

UNSEEN = (
    "What a flat picture does not show: traced stones (length along the face instead of into the "
    "wall), through stones, hearting, batter, and the bedding of the rock."
)

_ALL = (
    Rule(
        "running_joints", "running joints",
        "Cross every upright joint with the next stone; no joint runs up through several courses.",
        "Adcock 1994, principle 1 (cover all joints; a joint of two stones only once in a blue "
        "moon); Bowland Dry Stone Walling 2024 (no seam of more than two stones or courses); the "
        "paper, section 2 (offset vertical joints)",
        "longest unbroken upright joint, in courses",
        Limit(1, 2), running_joints, unit="courses",
    ),
    Rule(
        "cross_joints", "cross joints",
        "Joints meet as a T, never as a plus: no four stones at one point.",
        "Corcoran 2018, rule 8 (no cross joints in the built wall); Kemmler, guide to setting a "
        "dry wall (no Kreuzfugen)",
        "points at which four stones meet, per ten stones",
        Limit(0.0, 1.0), cross_joints, unit="per 10 stones",
    ),
    Rule(
        "one_over_two", "one over two",
        "One stone on two, and two stones on one.",
        "Adcock 1994, principle 1; the paper, section 2 (each block in contact with several "
        "others)",
        "share of the stones between the ends and above the foot that rest on two or more",
        Limit(0.8, 0.6), one_over_two, higher_is_better=True,
    ),
    Rule(
        "laps", "laps over joints",
        "A stone laps well over the joint below it, by a third of its length or at least a "
        "quarter.",
        "The idea: the paper, section 3.5, Eq. 9 (offset of joints by the width of a stone); "
        "Corcoran 2018, rule 7 (half bond where possible); trockenmauerkurs.de, building rule 3 "
        "(lap of at least 10 cm). The quarter and the third: own definition",
        "share of the joints that a stone covers that it laps by less than a quarter of its width",
        Limit(0.1, 0.3), laps,
    ),
    Rule(
        "on_end", "stones on end",
        "Lay a stone on its bed: no stone stands higher than it is long.",
        "Corcoran 2018, rule 4 (no stone higher than long); Bayer Stone, laying random ashlar (no "
        "stone on its end). From which elongation it counts: own definition",
        "share of the stones whose longer side stands steeper than 45 degrees",
        Limit(0.05, 0.15), on_end,
    ),
    Rule(
        "big_low", "big stones low",
        "Big stones go into the lower part of the wall, smaller ones above.",
        "Adcock 1994, principle 5; Delaware Quarries, rule 6. The number: own definition",
        "mean size of the stones above mid-height over that of those below; a stone across "
        "mid-height counts in both, by its shares",
        Limit(1.05, 1.3), big_low,
    ),
    Rule(
        "level_beds", "level beds",
        "Lay stones level: beds that slope make stones slide.",
        "Welch and Post, The Stone Trust, rule 1 (stones and courses level); Corcoran 2018, rule "
        "10; the paper, section 2 (courses straight and level). The limits: own definition",
        "mean slope of the lower and upper edges of the stones, by their widths",
        Limit(5.0, 10.0), level_beds, unit="°",
    ),
    Rule(
        "inward_edges", "inward edges",
        "At the ends of the wall the upper edges fall inwards, so that nothing slides out.",
        "The paper, section 3.5, Eq. 10 (IS, inward slope of stones at the boundary); Delaware "
        "Quarries, rule 5, says it of slopes across the wall. A fitted line instead of two highest "
        "points, and the limits: own definition",
        "least inward slope (rise over run) of the upper edges at both ends; below 0 it is "
        "outwards",
        Limit(-0.1, -0.25), inward_edges, higher_is_better=True,
    ),
    Rule(
        "pins", "pins and wedges",
        "Wedges fill gaps and stop rocking; the load goes beside them, none sticks out, and each "
        "is a flat piece that one can cut and that stays in its place.",
        "The paper, section 2 (shards fill openings or prevent rocking); rockinwalls.com, Pinning "
        "& Chinks, 2011 (pins that lift a large stone fall out or are crushed); Delaware Quarries, "
        "rule 10 (fill cracks after the wall is complete). The number: own definition",
        "greatest load that a wedge cannot help carrying, over the weight of the stones on it; "
        "under the wall's own weight, with open upright joints",
        Limit(0.1, 0.5), pins, by_limit=True,
    ),
    Rule(
        "seats", "seats",
        "A stone sits; none stands on a point or hangs between its neighbours.",
        "The paper, section 3.7 (centroid above the supports); Welch and Post, The Stone Trust, "
        "rule 1 (stones level). The numbers: own definition",
        "share of the stones above the foot that rest on a point, or with their middle hardly over "
        "their seat or beyond it",
        Limit(0.05, 0.15), seats,
    ),
    Rule(
        "towers", "small on small",
        "Small stones fill between large ones; they make no tower.",
        "Adcock 1994, principle 5, says that large stones lie below. The rest: own definition",
        "most small stones on each other that lie on no large one",
        Limit(1, 2), towers, unit="stones",
    ),
    Rule(
        "voids", "hollow corners",
        "Fill what is hollow: no corner of a stone hangs over a void.",
        "The paper, section 2 (shards fill openings). The number: own definition",
        "share of the stones with a lower corner that has nothing under it",
        Limit(0.05, 0.15), voids,
    ),
    Rule(
        "wedge_sizes", "large wedges",
        "A wedge is a chip: what is as thick as a stone is a stone, and wants a bed of its own.",
        "rockinwalls.com, Pinning & Chinks, 2011 (pins that lift a large stone fall out or are "
        "crushed). The number: own definition",
        "area of the largest wedge over that of the stone on it",
        Limit(0.1, 0.25), wedge_sizes, by_limit=True,
    ),
    Rule(
        "level_top", "level top",
        "Keep the wall at an even height along its length.",
        "Adcock 1994, principle 6; the number is T_LEVEL of `drystone measure` with joints that "
        "are open at the top bridged. The limits: own definition",
        "mean deviation of the top from its mean height, in mean stone heights",
        Limit(0.15, 0.3), level_top,
    ),
    Rule(
        "flush_ends", "flush ends",
        "The ends of the wall are upright and in line.",
        "Own definition, like E_FLUSH of `drystone measure` but of the stones at the ends alone: a "
        "bed that is open from end to end, or an uneven top, is not a ragged end",
        "mean gap between the ends of the wall and its end lines, in mean stone widths",
        Limit(0.1, 0.2), flush_ends,
    ),
)  # fmt: skip

RULES: Mapping[str, Rule] = MappingProxyType({rule.name: rule for rule in _ALL})
"""All rules by name."""


@dataclass(frozen=True, eq=False)
class CraftReport:
    """What the rules find in a wall."""

    masonry: Masonry
    findings: Mapping[str, Finding]  # by name of the rule, in the order of `RULES`

    @property
    def broken(self) -> tuple[str, ...]:
        """Names of the rules that are broken."""
        return tuple(name for name, one in self.findings.items() if one.verdict == "broken")

    def report(self) -> dict[str, Any]:
        """Return everything for JSON."""
        masonry = self.masonry
        return {
            "stones": len(masonry.stones),
            "wedges": len(set(masonry.wedge_ids)),
            "mean_stone_height": masonry.mean_height,
            "mean_stone_width": masonry.mean_width,
            "settings": asdict(masonry.settings),
            "rules": {name: one.report(masonry.steps) for name, one in self.findings.items()},
            "unseen": UNSEEN,
        }


def look(masonry: Masonry, limits: Mapping[str, Limit] | None = None) -> CraftReport:
    """Judge a wall by the masons' rules; of an empty one nothing is judged.

    `limits` replace those of rules, by their names.  UsageError (E190): limits of no rule, or the
    wrong way round.

    Examples
    --------
    >>> import numpy as np
    >>> brick = np.array([[0, 0], [2, 0], [2, 1], [0, 1]])
    >>> places = [(0, 0), (2, 0), (0, 1), (2, 1)]
    >>> report = look(Masonry({i: brick + place for i, place in enumerate(places, 1)}))
    >>> report.findings["running_joints"].verdict, report.broken
    ('fair', ('cross_joints',))
    """
    given = dict(limits or {})
    strangers = sorted(set(given) - set(RULES))
    if strangers:
        what = f"there is no rule {', '.join(map(repr, strangers))}."
        cure = f"The rules are {', '.join(RULES)}."
        raise UsageError("E190", what, where="limits of craft", cure=cure)
    findings = {name: rule.find(masonry, given.get(name)) for name, rule in RULES.items()}
    return CraftReport(masonry, findings)
