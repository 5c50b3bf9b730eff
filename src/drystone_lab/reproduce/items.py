"""The paper's tables and figures by name."""

from collections.abc import Mapping
from importlib import import_module
from types import MappingProxyType
from typing import TYPE_CHECKING, cast

from drystone.errors import UsageError

if TYPE_CHECKING:  # names are listed without waiting for matplotlib
    from drystone_lab.reproduce.item import PaperItem

ITEMS: Mapping[str, tuple[str, str]] = MappingProxyType(
    {
        "table1": ("what each system looks at (§2)", "method.TABLE1"),
        "fig3-4": ("Algorithm 1 on a real run (§3.2)", "method.WORKFLOW"),
        "fig5": ("clusters of the stones PR (§3.4)", "fig5.CLUSTERS"),
        "fig6-7": ("the indices, good and bad, on real stones (§3.5)", "fig6_7.INDICES"),
        "fig8": ("feasible positions of a stone (§3.6)", "fig8.POSITIONS"),
        "beta": ("the threshold of GDS in Eq. 12: 0, 0.5, 0.7, 0.9 (§3.6)", "ways.BETA"),
        "fig9": ("an unstable stone, turned and wedged (§3.7)", "fig9.STABILISING"),
        "fig10": ("who passes which filter of Algorithm 2 (§3.8)", "method.SELECTION"),
        "fig11": ("two rigid blocks in contact (§4.1)", "method.RIGID"),
        "fig12": ("Pic-to-Ri: from pixels to rigid blocks (§4.2)", "fig12.PIC_TO_RI"),
        "fig13": ("the masons' walls, and with their gaps closed (§5.1)", "masons.FIG13"),
        "fig14-15": ("the base case PR and its mechanisms (§5.1)", "base_case.BASE_CASE"),
        "fig16": ("sampling: uniform, two-fold, full batch (§5.1)", "ways.SAMPLING"),
        "fig17": ("shortest paths along the joints (§5.2)", "fig17.PATHS"),
        "table2": ("walls 1-5: fixed seed, best of 20, masons; with fig18 (§5.2)", "table2.TABLE2"),
        "variants": ("the paper's method and what it could have been (§5.2)", "ways.VARIANTS"),
        "fig19": ("wedges of walls 3 and 5 (§5.2)", "base_case.WEDGES"),
        "fig20": ("stabilisation: filling against area of wedges (§5.2)", "ways.STABILISATION"),
        "fig21": ("walls built from both ends (§5.2)", "ways.BOTH_ENDS"),
        "fig22-24": ("polygons of eight noise levels, ten walls each (§5.3)", "noise.NOISE"),
        "fig25": ("orientations in steps of 10 degrees (§5.3)", "noise.TURNED"),
        "fig26-27": ("Fourier stones of four kinds, twenty walls each (§5.3)", "rounded.ROUNDED"),
        "fig28": ("time of a step by part, variant and full batch (§6.1)", "times.STEPS"),
        "growth": ("time against the numbers of stones Q and of clusters K (§6.2)", "times.GROWTH"),
        "fig29": ("resolutions 0.5 to 2: walls and times (§6.3)", "times.RESOLUTION"),
        "figB30-32": ("walls of the stones of Fig. 18 by other methods (B.1)", "ways.ALL_METHODS"),
        "figB33": ("91 irregular stones (B.2)", "appendix.IRREGULAR"),
        "figB34": ("bricks of aspect 2 and 3 (B.2)", "appendix.BRICKS"),
    }
)
"""What each shows, and where in this package it is; in the order of the paper."""

ALSO: Mapping[str, str] = MappingProxyType(
    {
        "fig3": "fig3-4", "fig4": "fig3-4", "fig6": "fig6-7", "fig7": "fig6-7", "fig14": "fig14-15",
        "fig15": "fig14-15",
        "fig18": "table2", "fig22": "fig22-24", "fig23": "fig22-24", "fig24": "fig22-24",
        "fig26": "fig26-27", "fig27": "fig26-27", "figB30": "figB30-32", "figB31": "figB30-32",
        "figB32": "figB30-32",
    }
)  # fmt: skip
"""Other names, of those that are made together."""

ALL = "all"


def item_names(asked: str) -> tuple[str, ...]:
    """Return the names of the items that are meant.

    >>> item_names("fig18"), len(item_names("all"))
    (('table2',), 28)
    """
    if asked == ALL:
        return tuple(ITEMS)
    name = ALSO.get(asked, asked)
    if name not in ITEMS:
        raise UsageError(
            "E138",
            f"the paper has no {asked!r} that can be made again.",
            where="reproduce",
            cure=f"Name one of {', '.join(ITEMS)}, or all; `drystone reproduce --list` explains.",
        )
    return (name,)


def item_named(name: str) -> "PaperItem":
    """Return one of :data:`ITEMS`."""
    module, _, item = ITEMS[name][1].partition(".")
    return cast("PaperItem", getattr(import_module(f"drystone_lab.reproduce.{module}"), item))
