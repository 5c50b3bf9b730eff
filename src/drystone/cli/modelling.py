"""From a wall file to the rigid block model that `drystone analyse` looks at."""

import argparse
import math
from dataclasses import replace
from functools import partial
from typing import Any

from drystone.cli.loads import is_plain, is_range, load_case
from drystone.contacts.blocks import ImageModel, model_from_labels
from drystone.contacts.gap_spread import closed_gap_spread
from drystone.contacts.gaps import model_with_closed_gaps, settle_gaps
from drystone.contacts.given import model_from_json, polygons_from_json
from drystone.contacts.outlines import model_from_outlines, outlines_of_labels
from drystone.contacts.settled import SETBACK
from drystone.drawing.words.analysis import ModelledWall
from drystone.errors import InputError, UsageError
from drystone.io.walls import GivenWall
from drystone.model.wall import Labels
from drystone.statics.joints import with_head_friction
from drystone.statics.limit import lateral_resistance
from drystone.statics.model import RigidBlockModel
from drystone.statics.result import LateralResistance


def modelled(wall: GivenWall, arguments: argparse.Namespace) -> ModelledWall:
    """Make the model that the options ask for."""
    mu = _mu(wall, arguments)
    if wall.blocks is not None:
        found = _given(wall, wall.blocks, mu, arguments)
    else:
        assert wall.labels is not None  # noqa: S101 - a wall without blocks has an image
        found = _drawn(wall, wall.labels, mu, arguments)
    if arguments.mu_head is not None:
        if wall.blocks is None:
            found = replace(found, model=with_head_friction(found.model, arguments.mu_head))
        said = f"friction {arguments.mu_head:g}"
        found = replace(found, remarks={**found.remarks, "head joints": said})
    if all(block.fixed for block in found.model.blocks):
        raise InputError(
            "E303",
            "there is no free block in it, so there is nothing to analyse.",
            where=arguments.wall_path,
            cure="Give a block that is not fixed.",
        )
    return found


def _mu(wall: GivenWall, arguments: argparse.Namespace) -> float:
    """Return the friction of the options, the middle of their range, or that of the wall."""
    if arguments.mu is not None:
        low, high = arguments.mu
        return float(low + high) / 2.0
    return wall.mu


def _given(
    wall: GivenWall, blocks: dict[str, Any], mu: float, arguments: argparse.Namespace
) -> ModelledWall:
    if arguments.close_gaps is not None or arguments.contacts != "pixels":
        what = "a block model has no pixels to take contacts from."
        cure = "Leave --close-gaps and --contacts out."
        if wall.plan is not None:
            what = "this plan is one of outlines, whose contacts are known."
            cure = "Leave --close-gaps and --contacts out, or give its wall image."
        raise UsageError("E138", what, cure=cure)
    if arguments.mu is not None:
        blocks = {**blocks, "mu": mu}
    if arguments.mu_head is not None:
        blocks = {**blocks, "mu_head": arguments.mu_head}
    remarks = {}
    bare = None if wall.plan is None else wall.plan.metrics.F_LR_no_setback
    if bare is not None and arguments.mu is None and _as_planned(arguments):
        remarks["contacts"] = f"set back; F_LR {bare:.3f} with contacts up to the ends of faces"
    return ModelledWall(
        model_from_json(blocks),
        polygons_from_json(blocks),
        "block" if wall.plan is None else "stone",
        wall.wedge_ids,
        remarks=remarks,
    )


def _drawn(
    wall: GivenWall, labels: Labels, mu: float, arguments: argparse.Namespace
) -> ModelledWall:
    if arguments.close_gaps is not None:
        return _with_closed_gaps(wall, labels, mu, arguments)
    picture = model_from_labels(labels, mu)
    if arguments.contacts == "pixels":
        return ModelledWall(picture.model, labels, "stone", wall.wedge_ids, picture.notices)
    outlines = outlines_of_labels(labels[: picture.ground_row])
    # What a picture weighs it weighs by its pixels, not by what smoothing made of them.
    bare = replace(model_from_outlines(outlines, mu), blocks=picture.model.blocks)
    found = model_from_outlines(outlines, mu, setback=SETBACK)
    said = "from sub-pixel outlines, set back"
    if _as_planned(arguments):
        strength = lateral_resistance(bare).value
        with_ends = "falls" if strength is None else f"F_LR {strength:.3f}"
        said += f"; {with_ends} with contacts up to the ends of faces"
    return ModelledWall(
        replace(bare, interfaces=found.interfaces),
        outlines,
        "stone",
        wall.wedge_ids,
        picture.notices,
        {"contacts": said},
    )


def _as_planned(arguments: argparse.Namespace) -> bool:
    """Whether loads and head joints are those that F_LR of a plan is of: a tilting table."""
    return is_plain(arguments) and arguments.mu_head is None


def _with_closed_gaps(
    wall: GivenWall, labels: Labels, mu: float, arguments: argparse.Namespace
) -> ModelledWall:
    if arguments.contacts != "pixels":
        raise UsageError("E138", "--close-gaps goes with --contacts pixels only.")
    reach = _reach(arguments.close_gaps)
    picture: ImageModel
    if reach is None:
        labels, moved = settle_gaps(labels)
        picture = model_from_labels(labels, mu)
        farthest = max((max(abs(dx), abs(dy)) for dx, dy in moved.values()), default=0)
        done = f"{len(moved)} stones lowered by up to {farthest} px; "
    else:
        picture = model_with_closed_gaps(labels, reach, mu)
        done = ""
    drawn = labels if reach is not None else _labels(wall)
    spread = closed_gap_spread(drawn, reach, mu, partial(_resistance, arguments))
    remarks = {"gaps": f"{done}{spread.words()}"}
    return ModelledWall(picture.model, labels, "stone", wall.wedge_ids, picture.notices, remarks)


def _resistance(arguments: argparse.Namespace, model: RigidBlockModel) -> LateralResistance:
    """Analyse a variant under the loads and the friction of the options."""
    if arguments.mu_head is not None:
        model = with_head_friction(model, arguments.mu_head)
    if is_range(arguments):  # its answer is no resistance: the spread is that of the tilting table
        return lateral_resistance(model)
    model, loads = load_case(arguments, model)
    return lateral_resistance(model, loads)


def _labels(wall: GivenWall) -> Labels:
    assert wall.labels is not None  # noqa: S101 - only walls with an image come here
    return wall.labels


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
