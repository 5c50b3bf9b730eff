"""From a wall file to the rigid block model that is asked for; its size and scarce contacts."""

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from types import MappingProxyType
from typing import Any

import numpy as np
import shapely

from drystone.contacts.blocks import ImageModel, model_from_labels
from drystone.contacts.gaps import (
    GapSweep,
    gap_sweep,
    model_with_closed_gaps,
    scarce_contacts,
    settle_gaps,
)
from drystone.contacts.given import model_from_json, polygons_from_json, refuse_astray
from drystone.contacts.outlines import CONTACT_TOLERANCE, model_of_traced, outlines_of_labels
from drystone.contacts.settled import SETBACK
from drystone.drawing.outlines import wall_regions
from drystone.drawing.words.analysis import STONES, ModelledWall, Shapes
from drystone.errors import InputError, Notice, UsageError, counted
from drystone.io.files import listed
from drystone.io.walls import GivenWall
from drystone.model.overlap import deepest_overlap, shape_of
from drystone.model.stone_size import median_sides, sizes_of
from drystone.model.wall import Labels
from drystone.statics.failing.mechanism import Names, Noun
from drystone.statics.joints import with_head_friction
from drystone.statics.limit import lateral_resistance
from drystone.statics.loads import LoadCase, force_at, load_case
from drystone.statics.model import RigidBlockModel
from drystone.statics.result import LateralResistance

FAR = 0.1
"""Farther from their block than this share of its size, the root of its area, forces are named."""


@dataclass(frozen=True)
class ModelRequest:
    """What touches what, how rough it is, and what it carries, as it is asked for."""

    mu: tuple[float, float] | None  # range of the coefficient of friction; None: the wall's
    mu_head: float | None  # that of head joints, when it is another
    contacts: str  # taken from "pixels" or "outlines"
    close_gaps: str | None  # how wide gaps may be that bear, "auto" or "settle"
    case: LoadCase

    @property
    def as_planned(self) -> bool:
        """Whether loads and head joints are those that F_LR of a plan is of: a tilting table."""
        return self.case.is_plain and self.mu_head is None


def modelled(wall: GivenWall, asked: ModelRequest, where: str) -> ModelledWall:
    """Make the model that the options ask for."""
    mu = wall.mu if asked.mu is None else sum(asked.mu) / 2.0
    noun: Noun = "block" if wall.blocks is not None and wall.plan is None else "stone"
    steps = {} if wall.plan is None else wall.plan.step_by_id
    if wall.blocks is not None:
        found = _given(wall, wall.blocks, mu, asked)
    else:
        assert wall.labels is not None  # noqa: S101 - a wall without blocks has an image
        found = _drawn(wall, wall.labels, mu, asked)
        found = replace(found, notices=(*wall.notices, *found.notices))
    found = replace(found, names=Names(noun, wall.wedge_ids, steps))
    found = _rubbed(found, asked)
    if all(block.fixed for block in found.model.blocks):
        what = "there is no free block in it, so there is nothing to analyse."
        raise InputError("E303", what, where=where, cure="Give a block that is not fixed.")
    return found


def _rubbed(wall: ModelledWall, asked: ModelRequest) -> ModelledWall:
    """Give head joints the friction that is asked for, and say which joints have their own.

    W309 for an option that no joint takes its friction from; E138 for friction that varies so.
    """
    model, remarks, idle = wall.model, dict(wall.remarks), []
    own = [face.mu for face in model.interfaces if face.mu is not None]
    if own:
        upto = f" to {max(own):g}" if max(own) > min(own) else ""
        joints = f"{len(own)} of {counted(len(model.interfaces), 'joint')}"
        remarks["own friction"] = f"{joints}, mu = {min(own):g}{upto}"
    if asked.mu_head is not None:
        rubbed = with_head_friction(model, asked.mu_head)
        if rubbed.interfaces == model.interfaces:  # the same objects
            idle.append("--mu-head")
        else:
            model, remarks["head joints"] = rubbed, f"friction {asked.mu_head:g}"
    if asked.mu is not None and model.mu_idle:
        idle.append("--mu")
        if asked.mu[0] < asked.mu[1]:
            what = "samples would not differ in friction: every joint has one of its own."
            raise UsageError("E138", what, where="--mu", cure="Leave it out.")
    what = f"no joint takes its friction from {' or '.join(idle)}."
    cure = "Joints keep what the file gives them; --mu-head is of joints nearer to upright."
    notices = (*wall.notices, *([Notice("W309", what, cure)] if idle else ()))
    return replace(wall, model=model, remarks=remarks, notices=notices)


def _given(wall: GivenWall, blocks: dict[str, Any], mu: float, asked: ModelRequest) -> ModelledWall:
    if asked.close_gaps is not None or asked.contacts != "pixels":
        what, more = "a block model has no pixels to take contacts from.", ""
        if wall.plan is not None:
            what = "this plan is one of outlines, whose contacts are known."
            more = ", or give its wall image"
        cure = f"Leave --close-gaps and --contacts out{more}."
        raise UsageError("E138", what, cure=cure)
    if asked.mu is not None:
        blocks = {**blocks, "mu": mu}
    if asked.mu_head is not None:
        blocks = {key: value for key, value in blocks.items() if key != "mu_head"}
    remarks = {}
    bare = None if wall.plan is None else wall.plan.metrics.F_LR_no_setback
    if bare is not None and asked.mu is None and asked.as_planned:
        remarks["contacts"] = f"set back; F_LR {bare:.3f} with contacts up to the ends of faces"
    model, outlines = model_from_json(blocks), polygons_from_json(blocks)
    if "interfaces" in blocks:
        refuse_astray(model, outlines)
    touching = {frozenset((face.block, face.other)) for face in model.interfaces}
    pairs = [one["between"] for one in blocks.get("friction", ())]
    idle = [f"{one} and {other}" for one, other in pairs if frozenset((one, other)) not in touching]
    what = f"blocks do not touch, so their friction is left aside: {listed(idle)}."
    cure = "Correct the ids, or where the blocks lie."
    notices = (*wall.notices, *([Notice("W306", what, cure)] if idle else ()))
    # What is found without dilatancy goes by the order of blocks: `plan` has them sorted.
    return ModelledWall(model.in_order(), outlines, notices=notices, remarks=remarks)


def _drawn(wall: GivenWall, labels: Labels, mu: float, asked: ModelRequest) -> ModelledWall:
    if asked.close_gaps is not None:
        return _with_closed_gaps(wall, labels, mu, asked)
    if asked.contacts == "pixels" and wall.outlines is not None:
        model, notices = model_of_traced(wall.outlines, mu), _overlapping(wall)
        return ModelledWall(model, wall.outlines, notices=notices, joints="drawn")
    picture = model_from_labels(labels, mu)
    if asked.contacts == "pixels":
        return ModelledWall(picture.model, labels, notices=picture.notices, joints="drawn")
    outlines = wall.outlines or outlines_of_labels(labels[: picture.ground_row])
    notices = picture.notices if wall.outlines is None else _overlapping(wall)
    bare = model_of_traced(outlines, mu)
    if wall.outlines is None:
        # What a picture weighs it weighs by its pixels, not by what smoothing made of them.
        bare = replace(bare, blocks=picture.model.blocks)
    found = model_of_traced(outlines, mu, setback=SETBACK)
    said = f"from {'sub-pixel ' if wall.outlines is None else ''}outlines, set back"
    if asked.as_planned:
        strength = lateral_resistance(bare).value
        with_ends = "falls" if strength is None else f"F_LR {strength:.3f}"
        said += f"; {with_ends} with contacts up to the ends of faces"
    model, remarks = replace(bare, interfaces=found.interfaces), {"contacts": said}
    return ModelledWall(model, outlines, STONES, notices, remarks, joints="outlines")


def _overlapping(wall: GivenWall) -> tuple[Notice, ...]:
    """Say which drawn stones lie deepest in each other, if so deep that they do not bear (W308)."""
    shapes = [(stone, shape_of(drawn[:-1])) for stone, drawn in (wall.outlines or {}).items()]
    depth, pair = deepest_overlap(shapes)
    if pair is None or depth <= CONTACT_TOLERANCE:
        return ()
    metres = "" if wall.px_per_m is None else f" ({1000.0 * depth / wall.px_per_m:.2g} mm)"
    what = (
        f"outlines of stones lie in each other, {pair[0]} and {pair[1]} by {depth:.2g} px{metres}: "
        f"edges bear up to {CONTACT_TOLERANCE:g} px deep."
    )
    cure = "Draw them side by side; or --close-gaps auto takes for contacts where pixels meet."
    return (Notice("W308", what, cure),)


def _with_closed_gaps(
    wall: GivenWall, labels: Labels, mu: float, asked: ModelRequest
) -> ModelledWall:
    """Close gaps up to a width, or settle stones; say F_LR so, and in brackets otherwise.

    That is with half and twice the width, or with stones pushed to either side.
    """
    if asked.contacts != "pixels":
        what = "--close-gaps works only with --contacts pixels."
        raise UsageError("E138", what, cure="Leave one of them out.")
    if asked.close_gaps == "auto":
        return _with_swept_gaps(wall, labels, mu, asked)
    if asked.close_gaps == "settle":
        shown, moved = settle_gaps(labels)
        farthest = max((max(abs(dx), abs(dy)) for dx, dy in moved.values()), default=0)
        done = f"{counted(len(moved), 'stone')} lowered by up to {farthest} px; "
        found = {
            "stones settled": model_from_labels(shown, mu),
            "stones pushed left": model_from_labels(settle_gaps(labels, "left")[0], mu),
            "stones pushed right": model_from_labels(settle_gaps(labels, "right")[0], mu),
        }
    else:
        reach, shown, moved, done = _reach(asked.close_gaps or ""), labels, {}, ""
        found = {
            f"gaps up to {width:g} px closed": model_with_closed_gaps(labels, width, mu)
            for width in (reach, reach / 2.0, 2.0 * reach)
        }
    chosen, *others = (
        f"{_strength_words(asked, picture.model)} with {name}" for name, picture in found.items()
    )
    made = _made(wall, shown, next(iter(found.values())), moved)
    figure = "alpha" if asked.case.load == "points" else "F_LR"
    remarks = {"gaps": f"{done}{figure} {chosen} ({', '.join(others)})"}
    return replace(made, remarks=remarks, joints="drawn")


def _strength_words(asked: ModelRequest, model: RigidBlockModel) -> str:
    """Say F_LR, or alpha of forces at points as they are given."""
    both = _resistance(asked, model)
    value, ends = both.value, [both.left, both.right]
    if asked.case.load == "points":
        value, ends = both.right.alpha, [both.right]
    if value is not None:
        return f"{value:.3f}".removeprefix("0")
    unknown = next((end.status for end in ends if end.alpha is None), None)
    # Without friction F_LR, which is over mu, is not defined.
    return "not defined" if unknown is None else str(unknown)


def _with_swept_gaps(
    wall: GivenWall, labels: Labels, mu: float, asked: ModelRequest
) -> ModelledWall:
    """Close the gaps that have to be closed, and say how the answer depends on their width."""
    made: dict[int, ModelledWall] = {}

    def at(width: int) -> LateralResistance:
        made[width] = _made(wall, labels, model_with_closed_gaps(labels, width, mu))
        return _resistance(asked, made[width].model)

    # Ranks instead of ids, which may be large: stones are 1 and on.
    ranks = np.unique(labels, return_inverse=True)[1].reshape(labels.shape) + (labels.min() > 0)
    _, usual_px = median_sides((one.length_px, one.width_px) for one in sizes_of(ranks))
    sweep = gap_sweep(at, usual_px)
    remarks = dict(sweep_rows(sweep, usual_px, wall.px_per_m))
    return replace(made[sweep.chosen_px], remarks=remarks, joints="swept", sweep=sweep)


def sweep_rows(sweep: GapSweep, usual_px: float, per_m: float | None) -> Iterator[tuple[str, str]]:
    """Say from where a wall stands, and how the load multiplier depends on the width."""
    chosen, first = sweep.chosen_px, sweep.stands_from_px
    if first is None:
        yield "gaps", f"does not stand with gaps up to {chosen} px closed, the widest tried"
        return
    said = f"up to {chosen} px closed; the same again: --close-gaps {chosen}px"
    yield "gaps", said if chosen else "none closed: the wall stands as it is drawn"
    if first:
        yield "  stands", f"with gaps of {first} px and more closed, not with {first - 1} px"
    for width, stands, alpha in sweep.tried:
        if stands or width == first - 1:
            known = "does not stand" if not stands else "no limit"
            yield f"  {width} px", known if alpha is None else f"alpha = {alpha:.4f}"
    low, high = sweep.within() or (None, None)
    if low is not None and high is not None:
        widest = max(width for width, *_ in sweep.tried if width <= sweep.upto_px)
        upto = f"from {chosen} to {widest} px alpha is {low:.3f} to {high:.3f}"
        hangs = "it hangs on the width: measure the joints" if not sweep.steady else "steady"
        yield "  how sure", f"{hangs}; {upto}"
    if chosen:
        share = 100.0 * chosen / usual_px
        length = "" if per_m is None else f" ({100.0 * chosen / per_m:.2g} cm)"
        yield "  width", f"{chosen} px{length} is {share:.0f} % of the height of a usual stone"


def sweep_report(sweep: GapSweep) -> dict[str, Any]:
    """Return the same as JSON; an alpha of null is that of a wall that falls, or has no limit."""
    return {
        "chosen_px": sweep.chosen_px,
        "stands_from_px": sweep.stands_from_px,
        "steady": sweep.steady,
        "tried": [
            {"px": width, "stands": stands, "alpha": alpha} for width, stands, alpha in sweep.tried
        ],
    }


def _made(
    wall: GivenWall,
    labels: Labels,
    picture: ImageModel,
    moved: Mapping[int, tuple[int, int]] = MappingProxyType({}),
) -> ModelledWall:
    """Give outlines the contacts that were found on their pixels; pixels have them already."""
    if wall.outlines is None:
        return ModelledWall(picture.model, labels, notices=picture.notices)
    shapes = {
        i: outline + (moved.get(i, (0, 0)) * np.array([1.0, -1.0]))
        for i, outline in wall.outlines.items()
    }
    blocks = model_of_traced(shapes).blocks
    return ModelledWall(replace(picture.model, blocks=blocks), shapes)


def _resistance(asked: ModelRequest, model: RigidBlockModel) -> LateralResistance:
    """Analyse a variant under the loads and the friction of the options."""
    if asked.mu_head is not None:
        model = with_head_friction(model, asked.mu_head)
    if asked.case.is_range:  # its answer is no resistance: the spread is that of the tilting table
        return lateral_resistance(model)
    model, loads = load_case(asked.case, model)
    return lateral_resistance(model, loads)


def _reach(text: str) -> float:
    """Read the width of `--close-gaps`."""
    try:
        reach = float(text.removesuffix("px"))
    except ValueError:
        reach = math.nan
    if not 0 < reach < math.inf:
        what = f"{text!r} is not a width in px, nor 'auto' or 'settle'."
        raise UsageError("E138", what, where="--close-gaps", cure="Give one of them.")
    return reach


def size_words(shapes: Shapes, per_unit_m: float | None) -> str | None:
    """Say how wide and high a wall is, in metres; None without a scale or a block."""
    if per_unit_m is None or not len(shapes):
        return None
    if isinstance(shapes, Mapping):
        corners = np.concatenate(list(shapes.values()))
        width, height = np.ptp(corners, axis=0).tolist()
    else:
        rows, cols = np.nonzero(shapes)
        width, height = float(np.ptp(cols) + 1), float(np.ptp(rows) + 1)
    return f"{width * per_unit_m:.3g} m wide, {height * per_unit_m:.3g} m high"


def far_forces(
    wall: ModelledWall, given: GivenWall, case: LoadCase, per_unit_m: float | None
) -> Notice | None:
    """Name the forces that act farther from their block than a tenth of its size (W310).

    `wall` is what is made of the one `given`, and has the blocks that the case names.
    """
    unit = "px" if per_unit_m is None else f"px, {1.0 / per_unit_m:g} to a metre"
    if given.blocks is not None:
        unit = "lengths of the block model" if given.plan is None else given.plan.length_unit
    far, forces = [], [*case.dead, *case.live]
    shapes = {region.id: region for region in wall_regions(wall.shapes)} if forces else {}
    for text in forces:
        block, at, _ = force_at(text, "a force")
        bodies = [shapely.Polygon(loop) for loop in shapes[block].loops]
        size = math.sqrt(max(one.area for one in bodies))
        if shapely.distance(bodies, shapely.Point(at)).min() > FAR * size:
            left, low, right, high = shapely.total_bounds(bodies)
            box = f"x {left:.4g} to {right:.4g}, y {low:.4g} to {high:.4g}"
            far.append(f"{text.partition(':')[0]} ({wall.names.listed([block])}: {box})")
    if not far:
        return None
    what = f"forces act far from their blocks: {listed(far)}."
    return Notice("W310", what, f"Give points in {unit}, y up from the ground.")


def scarcity(wall: ModelledWall, per_unit_m: float | None) -> Notice | None:
    """Name the stones with fewer than two contact points (W305)."""
    few = scarce_contacts(wall.model, wall.shapes)
    if not few:
        return None
    named = listed(one.block for one in few)
    gaps = [one.gap for one in few if np.isfinite(one.gap)]
    have = "has" if len(few) == 1 else "have"
    said = f"{counted(len(few), wall.names.noun)} {have} fewer than two contact points: {named}."
    if not gaps:
        return Notice("W305", said)
    unit = "" if wall.joints == "known" else " px"
    metres = "" if per_unit_m is None else f" ({1000.0 * per_unit_m * min(gaps):.0f} mm)"
    said += f" The narrowest gap there is {min(gaps):.3g}{unit}{metres}."
    cure = "--close-gaps auto looks for the width from which the wall stands."
    return Notice("W305", said, _CURES.get(wall.joints, cure))


_CURES = {
    "known": "",
    "swept": "Are stones missing beside them? --skip leaves out what is not a stone of the wall.",
    "outlines": "Leave --contacts out: --close-gaps auto looks for the width that lets them bear.",
}
"""What to do about stones that touch too little, by what is known of the joints."""
