"""Reading what `analyse` and `measure` are given: a label image, a plan, or a block model."""

import math
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from drystone.contacts.given import polygons_from_json, read_mu
from drystone.errors import InputError, Notice, UsageError
from drystone.io.file_bytes import file_bytes
from drystone.io.file_errors import listed
from drystone.io.foreign import foreign
from drystone.io.json_text import json_of
from drystone.io.plan_folder import BLOCKS
from drystone.io.plan_json import read_plan
from drystone.io.wall_image import read_wall_image, read_wall_picture
from drystone.kernels.label_runs import label_runs
from drystone.kernels.polygons import Points, area_and_centroid
from drystone.model.plan import Plan
from drystone.model.wall import Labels
from drystone.statics.joints import loose_blocks
from drystone.statics.model import RigidBlockModel

_TOGETHER = "Keep the files of a plan together, or plan again."

CENTROID_PX = 0.01
"""Between centroids of a plan and of its block model, source px: rounding of either file only."""

IMAGE_PX = 0.5
"""Between centroids of a plan on pixels and of its image, working px, for a stone of any shape."""

RIM = 4.0
"""How much further the pixels of long and thin stones are off, as a share of their spread.

Pixels on the rim are all stone or none, and the longer and thinner a stone is the further that
moves its centroid.  A square may be off by 1.2 px with this; spikes and slivers that were drawn in
thousands of poses and scales came to .6 of what it allows."""


@dataclass(frozen=True, eq=False)
class GivenWall:
    """A wall from a file."""

    labels: Labels | None  # (h, w), None for a block model, which has no pixels
    plan: Plan | None = None  # when the file was a plan; its image is the wall image beside it
    blocks: dict[str, Any] | None = None
    """A block model as it was written, also that of a plan on outlines."""
    notices: tuple[Notice, ...] = ()  # what was made of the pixels of a label image

    @property
    def wedge_ids(self) -> frozenset[int]:
        """Labels that are wedges."""
        return frozenset(step.id for step in self.plan.wedge_steps) if self.plan else frozenset()

    @property
    def mu(self) -> float:
        """Coefficient of friction of the block model or the plan, or .58."""
        if self.blocks is not None:
            return read_mu(self.blocks, "mu", 0.58)
        return float(self.plan.settings.get("mu", 0.58)) if self.plan else 0.58


MOST_MPX = 200.0
"""Largest picture of a wall that is decoded, in millions of pixels."""


def read_wall(path: Path, *, background: int = 0) -> GivenWall:
    """Read a label image, a plan.json (with the wall image beside it), or a block model."""
    if path.is_dir():
        path /= "plan.json"
    if path.suffix.lower() != ".json":
        image, notices = read_wall_picture(path, background=background)
        return GivenWall(image, notices=notices)
    if background:
        what = f"a background of {background} is of a label image, and this is none."
        cure = "Leave --background (background in Python) out."
        raise UsageError("E118", what, where=str(path), cure=cure)
    content = _read_json(path)
    if isinstance(content, dict) and ("blocks" in content or "blocks_xywh" in content):
        return GivenWall(None, blocks=content)
    plan = read_plan(path)
    labels = read_image_of(plan, path.parent)
    if labels is None:
        what = f"there is no {image_name(plan)} beside the plan."
        cure = "Keep the files of a plan together, or give the label image itself."
        raise InputError("E133", what, where=str(path), cure=cure)
    if not shows(labels, plan):
        what = f"the {image_name(plan)} beside the plan shows other stones than the plan."
        cure = "Keep the files of a plan together, or give the label image itself."
        raise InputError("E133", what, where=str(path), cure=cure)
    if plan.settings.get("geometry") != "exact":
        _refuse_misplaced(labels, plan, path)
        return GivenWall(labels, plan)
    return GivenWall(labels, plan, _blocks_of(plan, path))


def shows(labels: Labels, plan: Plan) -> bool:
    """Say whether an image shows the stones and wedges of a plan and nothing else.

    Of a plan on outlines wedges may be missing that fill no pixel.
    """
    found = set(np.unique(labels).tolist()) - {0}
    wedges = {step.id for step in plan.wedge_steps}
    may_miss = wedges if plan.settings.get("geometry") == "exact" else set()
    return set(_ids(plan)) - may_miss <= found <= set(_ids(plan))


def image_name(plan: Plan) -> str:
    """Return the name of the wall image that is written with a plan (DESIGN 2)."""
    return "wall.png" if max(_ids(plan), default=0) <= 65535 else "wall.tif"


def read_image_of(plan: Plan, folder: Path) -> Labels | None:
    """Return the wall image in the folder of a plan; None when it is not there."""
    path = folder / image_name(plan)
    if not path.exists():
        return None
    # One that is far larger is not of the plan, and is not decoded to find that out.
    px = plan.width * plan.height * (plan.working_scale * (plan.px_per_m or 1.0)) ** 2
    return read_wall_image(path, planned=True, max_image_mpx=min(max(1.0, 4e-6 * px), MOST_MPX))


def read_blocks_of(plan: Plan, folder: Path) -> Any:
    """Return what blocks.json beside a plan on outlines holds; None when it is not there."""
    path = folder / BLOCKS
    if plan.settings.get("geometry") != "exact" or not path.exists():
        return None
    content = _read_json(path, _TOGETHER)
    return {} if content is None else content  # a null is there, and is no block model


def unsupported(model: RigidBlockModel) -> Notice | None:
    """Name the blocks that no chain of contacts connects with the ground (W302)."""
    loose = loose_blocks(model)
    if not loose:
        return None
    return Notice(
        "W302",
        f"{len(loose)} of {len(model.blocks)} blocks touch neither the ground nor a block that is "
        f"connected with it: {listed(loose)}.",
        "Only edges that meet bear on each other: close the gaps that are drawn between stones.",
    )


def _blocks_of(plan: Plan, path: Path) -> dict[str, Any]:
    """Return the block model beside a plan on outlines; E133 when it is not that of the plan."""
    blocks = read_blocks_of(plan, path.parent)
    if blocks is None:
        what = f"there is no {BLOCKS} beside the plan."
    elif not isinstance(blocks, dict):
        what = f"the {BLOCKS} beside the plan is no block model."
    elif set(polygons := polygons_from_json(blocks)) != set(_ids(plan)):
        what = f"the {BLOCKS} beside the plan has other stones than the plan."
    elif not _where_planned(plan, polygons):
        what = f"the {BLOCKS} beside the plan has its stones in other places than the plan."
    else:
        return blocks
    raise InputError("E133", what, where=str(path), cure=_TOGETHER)


def _where_planned(plan: Plan, polygons: Mapping[int, Points]) -> bool:
    """Say whether all polygons have their centroids where those of the plan are."""
    planned, allowed = _planned(plan), CENTROID_PX / (plan.px_per_m or 1.0)
    return all(
        math.dist(_centroid(polygon), planned[block]) <= allowed
        for block, polygon in polygons.items()
    )


def _refuse_misplaced(labels: Labels, plan: Plan, path: Path) -> None:
    """Refuse an image with a stone or wedge where the plan on pixels has none of it (E133)."""
    unit = 1.0 / (plan.working_scale * (plan.px_per_m or 1.0))
    planned = _planned(plan)
    for block, (centroid, allowed_px) in _seen(labels).items():
        x, y = planned[block]
        if not math.dist(centroid, (x / unit, y / unit)) <= allowed_px:
            shown = f"{image_name(plan)} beside the plan shows {block}"
            what = f"the {shown} in another place than the plan has it."
            raise InputError("E133", what, where=str(path), cure=_TOGETHER)


def _seen(labels: Labels) -> dict[int, tuple[tuple[float, float], float]]:
    """Return where the pixels of each id lie, and how far off they may be; working px, y up."""
    runs = label_runs(labels)
    ids, which = np.unique(runs.labels, return_inverse=True)
    lengths = runs.lengths.astype(float)
    middle, row = (runs.begins + runs.ends) / 2, labels.shape[0] - runs.rows - 0.5

    def sums(values: NDArray[np.float64]) -> NDArray[np.float64]:
        return np.bincount(which, values * lengths, minlength=ids.size).astype(float)

    area = sums(np.ones(which.size))
    x, y = sums(middle) / area, sums(row) / area
    # About the centroids, so that nothing is lost far from the origin; 1/12 is a pixel's own.
    spread = sums((middle - x[which]) ** 2 + lengths**2 / 12 + (row - y[which]) ** 2 + 1 / 12)
    allowed = IMAGE_PX + RIM * spread / area**2
    places = zip(x.tolist(), y.tolist(), strict=True)
    return dict(zip(ids.tolist(), zip(places, allowed.tolist(), strict=True), strict=True))


def _planned(plan: Plan) -> dict[int, tuple[float, float]]:
    """Return the centroids of all stones and wedges by the plan, in its units."""
    planned = {step.stone: step.centroid for step in plan.stone_steps}
    return planned | {step.id: _centroid(np.array(step.polygon)) for step in plan.wedge_steps}


def _centroid(polygon: Points) -> tuple[float, float]:
    """Return the centroid of a polygon; one without an area is nowhere."""
    try:
        _, x, y = area_and_centroid(polygon)
    except ZeroDivisionError:
        return math.nan, math.nan
    return x, y


def _ids(plan: Plan) -> list[int]:
    stones = [step.stone for step in plan.stone_steps]
    return stones + [step.id for step in plan.wedge_steps]


def _read_json(
    path: Path, cure: str = "Give a label image, the plan.json of a plan, or a block model."
) -> Any:
    def refused(what: str) -> InputError:
        return InputError("E132", what, where=str(path), cure=cure)

    try:
        data = file_bytes(path)
    except OSError as error:
        raise refused(f"cannot be read ({error.strerror}).") from error
    with foreign(lambda why: refused(f"is no JSON ({why}).")):
        return json_of(data.decode("utf-8-sig"))
