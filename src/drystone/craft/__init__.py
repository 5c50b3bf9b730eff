"""A wall as a mason looks at it: rules that name stones and steps.

:func:`look` takes a :class:`Masonry`, made of outlines, a label image or a plan, and judges it by
fifteen rules (docs/craft.md).
"""

from drystone.craft.finding import Case, Finding, Limit, Rule
from drystone.craft.look import RULES, CraftReport, look
from drystone.craft.masonry import Masonry
from drystone.craft.settings import CraftSettings

__all__ = [
    "RULES",
    "Case",
    "CraftReport",
    "CraftSettings",
    "Finding",
    "Limit",
    "Masonry",
    "Rule",
    "look",
]
