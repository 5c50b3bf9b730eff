"""From a wall file to the rigid block model that is asked for; its size and scarce contacts."""

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import partial
from typing import Any

import numpy as np

from drystone.contacts.blocks import ImageModel, model_from_labels
from drystone.contacts.gaps import gap_spread, model_with_closed_gaps, settle_gaps
from drystone.contacts.given import model_from_json, polygons_from_json
from drystone.contacts.outlines import model_from_outlines, outlines_of_labels
from drystone.contacts.scarce import scarce_contacts
from drystone.contacts.settled import SETBACK
from drystone.drawing.words.analysis import ModelledWall, Shapes
from drystone.errors import InputError, Notice, UsageError
from drystone.io.walls import GivenWall
from drystone.model.wall import Labels
from drystone.statics.failing.mechanism import Noun
from drystone.statics.joints import with_head_friction
from drystone.statics.limit import lateral_resistance
from drystone.statics.loads import LoadCase, load_case
from drystone.statics.model import RigidBlockModel
from drystone.statics.result import LateralResistance


@dataclass(frozen=True)
class ModelRequest:
    """What touches what, how rough it is, and what it carries, as it is asked for."""

    mu: tuple[float, float] | None  # range of the coefficient of friction; None: the wall's
    mu_head: float | None  # that of head joints, when it is another
    contacts: str  # taken from "pixels" or "outlines"
    close_gaps: str | None  # how wide gaps may be that bear, or "settle"
    case: LoadCase

    @property
    def as_planned(self) -> bool:
        """Whether loads and head joints are those that F_LR of a plan is of: a tilting table."""
        return self.case.is_plain and self.mu_head is None


def modelled(wall: GivenWall, asked: ModelRequest, where: str) -> ModelledWall:
    """Make the model that the options ask for."""
    mu = wall.mu if asked.mu is None else sum(asked.mu) / 2.0
    if wall.blocks is not None:
        found = _given(wall, wall.blocks, mu, asked)
    else:
        assert wall.labels is not None  # noqa: S101 - a wall without blocks has an image
        found = _drawn(wall, wall.labels, mu, asked)
        found = replace(found, notices=(*wall.notices, *found.notices))
    if asked.mu_head is not None:
        if wall.blocks is None:
            found = replace(found, model=with_head_friction(found.model, asked.mu_head))
        said = f"friction {asked.mu_head:g}"
        found = replace(found, remarks={**found.remarks, "head joints": said})
    if all(block.fixed for block in found.model.blocks):
        raise InputError(
            "E303",
            "there is no free block in it, so there is nothing to analyse.",
            where=where,
            cure="Give a block that is not fixed.",
        )
    return found


def _given(wall: GivenWall, blocks: dict[str, Any], mu: float, asked: ModelRequest) -> ModelledWall:
    if asked.close_gaps is not None or asked.contacts != "pixels":
        what = "a block model has no pixels to take contacts from."
        cure = "Leave --close-gaps and --contacts out."
        if wall.plan is not None:
            what = "this plan is one of outlines, whose contacts are known."
            cure = "Leave --close-gaps and --contacts out, or give its wall image."
        raise UsageError("E138", what, cure=cure)
    if asked.mu is not None:
        blocks = {**blocks, "mu": mu}
    if asked.mu_head is not None:
        blocks = {**blocks, "mu_head": asked.mu_head}
    remarks = {}
    bare = None if wall.plan is None else wall.plan.metrics.F_LR_no_setback
    if bare is not None and asked.mu is None and asked.as_planned:
        remarks["contacts"] = f"set back; F_LR {bare:.3f} with contacts up to the ends of faces"
    model, shapes = model_from_json(blocks), polygons_from_json(blocks)
    noun: Noun = "block" if wall.plan is None else "stone"
    return ModelledWall(model, shapes, noun, wall.wedge_ids, remarks=remarks)


def _drawn(wall: GivenWall, labels: Labels, mu: float, asked: ModelRequest) -> ModelledWall:
    if asked.close_gaps is not None:
        return _with_closed_gaps(wall, labels, mu, asked)
    picture = model_from_labels(labels, mu)
    if asked.contacts == "pixels":
        return ModelledWall(picture.model, labels, "stone", wall.wedge_ids, picture.notices)
    outlines = outlines_of_labels(labels[: picture.ground_row])
    # What a picture weighs it weighs by its pixels, not by what smoothing made of them.
    bare = replace(model_from_outlines(outlines, mu), blocks=picture.model.blocks)
    found = model_from_outlines(outlines, mu, setback=SETBACK)
    said = "from sub-pixel outlines, set back"
    if asked.as_planned:
        strength = lateral_resistance(bare).value
        with_ends = "falls" if strength is None else f"F_LR {strength:.3f}"
        said += f"; {with_ends} with contacts up to the ends of faces"
    model, remarks = replace(bare, interfaces=found.interfaces), {"contacts": said}
    return ModelledWall(model, outlines, "stone", wall.wedge_ids, picture.notices, remarks)


def _with_closed_gaps(
    wall: GivenWall, labels: Labels, mu: float, asked: ModelRequest
) -> ModelledWall:
    if asked.contacts != "pixels":
        raise UsageError("E138", "--close-gaps goes with --contacts pixels only.")
    drawn, done = labels, ""
    reach = _reach(asked.close_gaps or "")
    picture: ImageModel
    if reach is None:
        labels, moved = settle_gaps(labels)
        picture = model_from_labels(labels, mu)
        farthest = max((max(abs(dx), abs(dy)) for dx, dy in moved.values()), default=0)
        done = f"{len(moved)} stones lowered by up to {farthest} px; "
    else:
        picture = model_with_closed_gaps(labels, reach, mu)
    spread = gap_spread(drawn, reach, mu, partial(_resistance, asked))
    remarks = {"gaps": f"{done}{spread}"}
    return ModelledWall(picture.model, labels, "stone", wall.wedge_ids, picture.notices, remarks)


def _resistance(asked: ModelRequest, model: RigidBlockModel) -> LateralResistance:
    """Analyse a variant under the loads and the friction of the options."""
    if asked.mu_head is not None:
        model = with_head_friction(model, asked.mu_head)
    if asked.case.is_range:  # its answer is no resistance: the spread is that of the tilting table
        return lateral_resistance(model)
    model, loads = load_case(asked.case, model)
    return lateral_resistance(model, loads)


def _reach(text: str) -> float | None:
    """Read `--close-gaps`; None to settle."""
    if text == "settle":
        return None
    try:
        reach = float(text.removesuffix("px"))
    except ValueError:
        reach = math.nan
    if not 0 < reach < math.inf:
        raise UsageError("E138", f"{text!r} is no width in px, nor 'settle'.", where="--close-gaps")
    return reach


LISTED = 8  # so many stones are named


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
    return f"{width * per_unit_m:.2f} m wide, {height * per_unit_m:.2f} m high"


def scarcity(wall: ModelledWall, per_unit_m: float | None) -> Notice | None:
    """Name the stones with fewer than two contact points (W305)."""
    few = scarce_contacts(wall.model, wall.shapes)
    if not few:
        return None
    named = ", ".join(str(one.block) for one in few[:LISTED])
    more = ", …" if len(few) > LISTED else ""
    gaps = [one.gap for one in few if np.isfinite(one.gap)]
    noun = wall.noun if len(few) == 1 else f"{wall.noun}s"
    have = "has" if len(few) == 1 else "have"
    said = f"{len(few)} {noun} {have} fewer than two contact points: {named}{more}."
    if not gaps:
        return Notice("W305", said)
    pixels = not isinstance(wall.shapes, Mapping)
    unit = " px" if pixels else ""
    metres = "" if per_unit_m is None else f" ({1000.0 * per_unit_m * min(gaps):.0f} mm)"
    said += f" The narrowest gap beside them is {min(gaps):.3g}{unit}{metres}."
    if not pixels:
        return Notice("W305", said)
    reach = int(np.ceil(np.median(gaps)))
    which = "it" if len(few) == 1 else "half of them"
    return Notice("W305", said, f"--close-gaps {reach}px lets {which} bear on the next one.")
