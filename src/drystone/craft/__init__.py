"""A wall as a mason looks at it: rules that name stones and steps.

:func:`look` takes a :class:`Masonry`, made of outlines, a label image or a plan, and judges it by
fifteen rules (docs/craft.md).
"""

from drystone.craft.finding import Limit
from drystone.craft.look import RULES, look
from drystone.craft.masonry import Masonry
from drystone.craft.settings import CraftSettings

__all__ = ["RULES", "CraftSettings", "Limit", "Masonry", "look"]
