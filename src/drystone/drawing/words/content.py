"""What the report says: numbers of a plan with the words that explain them."""

import math
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Literal

from drystone.io.published import SETS
from drystone.model.plan import Plan
from drystone.settle.settings import SettleSettings
from drystone.statics.model import RigidBlockModel

UNDEFINED = "not defined"
FALLS = "does not stand"
ALPHA = "\N{GREEK SMALL LETTER ALPHA}"
TIMES = "\N{MULTIPLICATION SIGN}"
INDICES = {
    "SF": "shape factor: area over area of the bounding box; 1 is a rectangle",
    "LFR": "local filling ratio: how full the site is to the left and below; higher is better",
    "GDS": "geometrical dice score: how much it fills the height that is begun; higher is better",
    "NHR": "height beside the left neighbour's; 0 is a level course, lower is better",
    "IWR": "interlocking with the joints below; higher is better",
    "IS": "slope of the upper edge; positive falls inwards, higher is better",
    "LLC": "limit load coefficient: min(alpha) / mu after the step; higher is better",
}
TOUCHING = {
    "exact": "Stones touch where their outlines are within the contact tolerance, {contact_px:g} "
    "px of the image, of each other.",
    "raster": "Stones touch where their pixels have edges or corners in common; by their real "
    "outlines they may overlap, or not touch.",
}
TILTING = "tilting table"  # name of the load case of a plan
LIVE_LOAD = (
    "The live load is horizontal, acts at the centroids and is the same share of every stone's "
    "weight, as on a tilting table; the wall stands free on rigid ground."
)
ASSUMPTIONS = (
    "The wall is a flat section of unit thickness; what happens across it is not modelled.",
    "Stones are rigid and do not crush; their weight is in proportion to their area.",
    "Joints are dry: they carry pressure and friction, no tension.",
    "Friction follows Coulomb's law with an associative flow rule: joints that slide also open "
    "(dilatancy), so the load multipliers are in general an upper bound.",
    LIVE_LOAD,
    "Joints are two pixels wide at the working resolution when F_AV and F_AH are measured.",
)

Better = Literal["higher", "lower", ""]


@dataclass(frozen=True)
class ResultCard:
    """A result, its name and one sentence that explains it."""

    symbol: str
    name: str
    value: str
    better: Better
    sentence: str


def number(value: float | None, digits: int = 3) -> str:
    """Write a number, or that it is not defined: never 0 for a missing one."""
    if value is None or not math.isfinite(value):
        return UNDEFINED
    return f"{round(value, digits) + 0.0:.{digits}f}"


MERITS = {
    "F_AV": (2, "vertical arrangement, higher is better"),
    "F_AH": (2, "horizontal arrangement, lower is better"),
    "F_LR": (3, "lateral resistance / mu, higher is better"),
    "F_LR_coulomb": (3, "the same without dilatancy"),
    "T_LEVEL": (3, "unevenness of the top, lower is better"),
    "E_FLUSH": (3, "unevenness of the ends, lower is better"),
}
"""Digits and meaning of the figures of merit beside F_SF."""


def figure_rows(metrics: object) -> Iterator[tuple[str, str]]:
    """Yield the figures of merit that metrics have, one a line."""
    for name, (digits, said) in MERITS.items():
        if hasattr(metrics, name):
            yield name, f"{number(getattr(metrics, name), digits)}  {said}"


def inputs(plan: Plan) -> tuple[tuple[str, str], ...]:
    """Return what the plan was made from, as pairs of name and value."""
    source, unit = plan.source, plan.length_unit
    digits = 2 if unit == "m" else 1
    scale = f"{plan.px_per_m:g} px a metre" if plan.px_per_m else "unknown (lengths in source px)"
    return (
        ("Stones from", source_name(plan) or "an array in memory"),
        ("SHA-256 of the input", str(source.get("sha256") or UNDEFINED)),
        ("Stones in the input", str(source.get("stones", UNDEFINED))),
        ("Size of the image", f"{source.get('width_px')} {TIMES} {source.get('height_px')} px"),
        ("Building ended", plan.stopped),
        ("Wall", f"{plan.width:.{digits}f} {TIMES} {plan.height:.{digits}f} {unit}"),
        ("Scale", scale),
        ("Working resolution", f"{plan.working_scale:g} of the source's"),
        ("Geometry", str(plan.settings.get("geometry", "raster"))),
        ("Method", plan.method),
        ("Seed", str(plan.seed)),
        *([("Walls tried", str(plan.walls))] if plan.walls else []),
        ("drystone", f"version {plan.version}"),
    )


def assumptions(plan: Plan) -> tuple[str, ...]:
    """Return what the results of a plan rest on."""
    contact_px = plan.settings.get("settle", {}).get("contact_px", SettleSettings().contact_px)
    return (
        *ASSUMPTIONS,
        TOUCHING[str(plan.settings.get("geometry", "raster"))].format(contact_px=contact_px),
    )


def wall_assumptions(model: RigidBlockModel, load_case: str = TILTING) -> tuple[str, ...]:
    """Return what the analysis of a wall that was not planned rests on.

    The last ones are what only this model has: what holds blocks, and friction of single joints.

    >>> wall_assumptions(RigidBlockModel((), ()), "point loads")[-1]
    'Load case: point loads. The wall stands free on rigid ground, but for what is fixed.'
    """
    load, even = LIVE_LOAD, "in proportion to their area"
    if load_case != TILTING:
        load = (
            f"Load case: {load_case}. The wall stands free on rigid ground, but for what is fixed."
        )
    said = [*ASSUMPTIONS[: ASSUMPTIONS.index(LIVE_LOAD)], load]
    if len({block.density for block in model.blocks if not block.fixed}) > 1:
        said = [one.replace(even, "their area times their density") for one in said]
    fixed = [block.id for block in model.blocks if block.fixed]
    if fixed:
        said.append(f"Fixed like the ground: {', '.join(map(str, fixed))}.")
    held = [f"{block.id} ({', '.join(block.held)})" for block in model.blocks if block.held]
    if held:
        said.append(f"Held by guides: {', '.join(held)}.")
    if any(face.mu is not None for face in model.interfaces):
        said.append(
            "Some joints have a coefficient of friction of their own, which they keep when mu "
            "is varied."
        )
    return tuple(said)


def load_words(load_case: str, side: str) -> str:
    """Name the live load to one side.

    >>> load_words("tilting table", "left"), load_words("point loads", "left")
    ('Horizontal load to the left', 'Live load reversed')
    """
    along = "Live load"
    if is_horizontal(load_case):
        along = "Load along the base" if ", tilted by " in load_case else "Horizontal load"
    return f"{along} {side_words(load_case, side)}"


def side_words(load_case: str, side: str) -> str:
    """Say which way the live load acts.

    >>> side_words("tilting table", "left"), side_words("point loads", "left")
    ('to the left', 'reversed')
    """
    if is_horizontal(load_case):
        return f"to the {side}"
    return "as given" if side == "right" else "reversed"


def dead_load(load_case: str) -> str:
    """Name what acts always.

    >>> dead_load("growing with height"), dead_load("tilting table, tilted by 5°")
    ('own weight', 'dead load')
    """
    more = ", tilted by " in load_case or ", dead forces " in load_case
    return "dead load" if more else "own weight"


def is_horizontal(load_case: str) -> bool:
    """Say whether the live load of a case is sideways, and its sum alpha times the weight."""
    return load_case.startswith((TILTING, "growing with height"))


def source_name(plan: Plan) -> str:
    """Return what the stones were found in: the photograph, else the file that was read."""
    photograph = plan.source.get("photograph") or {}
    return str(photograph.get("name") or plan.source.get("path") or "")


def cards(plan: Plan, *, stands: bool | None = True) -> tuple[ResultCard, ...]:
    """Return the results, the ones to look at first at the front; no strength of what falls."""
    if stands is False:
        return _layout(plan)
    metrics, without = plan.metrics, ""
    if metrics.F_LR_coulomb is not None:
        without = f" {number(metrics.F_LR_coulomb)} without dilatancy, the least that was found."
    ends = (metrics.alpha_left, metrics.alpha_right)
    return (*strength_cards(metrics.F_LR, *ends, without), *_layout(plan))


def strength_cards(
    ratio: float | None,
    left: float | None,
    right: float | None,
    without_dilatancy: str = "",
    load_case: str = TILTING,
) -> tuple[ResultCard, ...]:
    """Return what is said of a wall's strength under the loads of a case: F_LR and alphas.

    F_LR is of loads sideways: others are no shares of the weight, and reversed they are others.
    """
    sideways = is_horizontal(load_case)
    of_one = "At 1 the whole wall would slide on the ground before it comes apart."
    if load_case != TILTING:
        of_one = f"The load case is: {load_case}."
    sides = sorted({"left": left, "right": right}.items(), reverse=not sideways)
    lateral = ResultCard(
        "F_LR", "Lateral resistance", number(ratio), "higher",
        f"The smaller load multiplier over the coefficient of friction. {of_one}"
        f"{without_dilatancy}",
    )  # fmt: skip
    return (
        *([lateral] if sideways else ()),
        *(ResultCard(f"{ALPHA} {side}",
                     f"Load multiplier (adequacy factor) {side_words(load_case, side)}",
                     number(alpha), "higher", _multiplier_means(load_case, side))
          for side, alpha in sides),
    )  # fmt: skip


def _multiplier_means(load_case: str, side: str) -> str:
    """Say what a load multiplier is a multiple of."""
    words = load_words(load_case, side)
    if not is_horizontal(load_case):
        return f"{words}: so many times it is the most that the wall carries."
    load = "load along the base" if words.startswith("Load") else "horizontal load"
    return (
        f"A {load} of this share of the wall's weight, pushing to the {side}, is the most that it "
        "carries."
    )


def _layout(plan: Plan) -> tuple[ResultCard, ...]:
    metrics, unit = plan.metrics, plan.length_unit
    factor, square = (1e4, "cm²") if unit == "m" else (1.0, "px²")
    area = number(factor * metrics.wedge_area, 1)
    wedges = f"{len(plan.wedge_steps)} ({area} {square})" if plan.wedge_steps else "0"
    longer, wavy = (
        UNDEFINED if share is None else f"{number(share, 2)} %"
        for share in (metrics.F_AV, metrics.F_AH)
    )
    return (
        ResultCard("F_SF", "Filling", number(metrics.F_SF), "higher",
             "Area of the placed stones, without wedges, over the area of the wall. "
             "1 leaves no gaps."),
        ResultCard("F_AV", "Interlocking", longer, "higher",
             "How much longer than a straight line the shortest ways along joints from top to "
             "ground are. The more, the less joints run through."),
        ResultCard("F_AH", "Waviness of courses", wavy, "lower",
             "How much longer than a straight line the shortest ways along joints from end to end "
             "are. 0 means straight courses."),
        ResultCard("T_LEVEL", "Unevenness of the top", number(metrics.T_LEVEL), "lower",
             "Mean deviation of the top from its mean height, in mean heights of a stone. "
             "0 is a level top."),
        ResultCard("E_FLUSH", "Gaps at the ends", number(metrics.E_FLUSH), "lower",
             "Mean gap between the wall and its two end lines, in mean widths of a stone. "
             "0 means upright ends on the lines."),
        ResultCard("", "Wedges", wedges, "lower",
             "Small stones pushed in under others, and their area. Each has to be found or cut."),
    )  # fmt: skip


MASONS_WALLS = {
    "R": {"F_SF": 0.846, "F_AV": 33.9, "F_AH": 0.59},
    "PR": {"F_SF": 0.808, "F_AV": 29.5, "F_AH": 1.50},
    "IR": {"F_SF": 0.850, "F_AV": 23.8, "F_AH": 3.69},
}
"""Walls of Almeida et al. (2021), of regular, partly regular and irregular stones, as docs/paper.md
has them traced: F_AV and F_AH in per cent.  Stones do not touch there, so there is no F_LR."""


def masons_words(symbol: str, sha256: str | None) -> str | None:
    """Say what F_SF, F_AV or F_AH is in walls of masons; None for a figure that is not known."""
    if symbol not in ("F_SF", "F_AV", "F_AH"):
        return None
    digits, unit = {"F_SF": (3, ""), "F_AV": (1, " %"), "F_AH": (2, " %")}[symbol]
    # The file that was read is known by its hash.
    names = {file.sha256: file.name for file in SETS["almeida"].files}
    for name, own in MASONS_WALLS.items():
        if names.get(sha256 or "") == f"almeida/{name}.png":
            said = "in the mason's own wall of these stones"
            return f"{own[symbol]:.{digits}f}{unit} {said} ({name})"
    values = [wall[symbol] for wall in MASONS_WALLS.values()]
    least, most = (f"{value:.{digits}f}" for value in (min(values), max(values)))
    return f"{least} to {most}{unit} in three walls of masons, of other stones"
