"""Reading what `analyse`, `measure` and `craft` are given: a plan, a block model, or stones."""

import math
import reprlib
from collections.abc import Iterator, Mapping
from contextlib import suppress
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
import shapely

from drystone.contacts.blocks import pieces_apart
from drystone.contacts.given import polygons_from_json, read_mu
from drystone.errors import InputError, LabelImageError, Notice, UsageError, meant
from drystone.io.files import file_bytes, foreign, listed, naming
from drystone.io.images import check_size
from drystone.io.json_text import json_of
from drystone.io.masks import is_npz
from drystone.io.outlines_in.model import Area, OutlineFile, filled_area
from drystone.io.outlines_in.silhouettes import outer_edge, tidy_edge
from drystone.io.photo_beside import read_sidecar, scale_beside
from drystone.io.plan_folder import BLOCKS
from drystone.io.plan_json import read_plan
from drystone.io.read_settings import ReadSettings
from drystone.io.read_stones import outline_reader, read_stones, stones_and_outlines
from drystone.io.wall_image import painted, read_wall_picture
from drystone.kernels.label_runs import label_runs
from drystone.kernels.polygons import Points, area_and_centroid
from drystone.model.plan import Plan
from drystone.model.steps import piece_id
from drystone.model.stone import StoneSet, writable
from drystone.model.wall import Labels
from drystone.statics.joints import loose_blocks
from drystone.statics.model import GROUND, RigidBlockModel

_TOGETHER = "Keep the files of a plan together, or plan again."

CENTROID_PX = 0.01
"""Between centroids of a plan and of its block model, source px: rounding of either file only."""

IMAGE_PX = 0.5
"""Between centroids of a plan on pixels and of its image, working px, for a stone of any shape."""

RIM = 4.0
"""How much further the pixels of long and thin stones are off, as a share of their spread.

Pixels on the rim are all stone or none, and the longer and thinner a stone is the further that
moves its centroid.  A square may be off by 1.2 px with this; spikes and slivers that were drawn in
thousands of poses and scales came to 0.6 of what it allows."""


@dataclass(frozen=True, eq=False)
class GivenWall:
    """A wall from a file."""

    labels: Labels | None  # (h, w), None for a block model, which has no pixels
    plan: Plan | None = None  # when the file was a plan; its image is the wall image beside it
    blocks: dict[str, Any] | None = None
    """A block model as it was written, also that of a plan on outlines."""
    notices: tuple[Notice, ...] = ()  # what was left out, repaired or decided when it was read
    outlines: dict[int, Points] | None = None
    """Of a file of outlines, (n, 2) by id, closed, px of `labels`, y up from its lower edge."""
    px_per_m: float | None = None  # of stones whose file says so itself
    drawn: bool = False  # a drawing or mesh, whose px are those that it was drawn with

    @property
    def wedge_ids(self) -> frozenset[int]:
        """Labels that are wedges."""
        return frozenset(step.id for step in self.plan.wedge_steps) if self.plan else frozenset()

    @property
    def mu(self) -> float:
        """Coefficient of friction of the block model or the plan, or 0.58."""
        if self.blocks is not None:
            return read_mu(self.blocks, "mu", 0.58)
        return float(self.plan.settings.get("mu", 0.58)) if self.plan else 0.58


MOST_PX = 200_000_000
"""Of a picture of a wall."""

PLAN = "plan.json"

_OF_MASKS = (1, 255, 65535)
"""The value of all stones of a mask, whose pieces are stones; another one is an id."""

_TRACED = (
    "Trace its stones first with `drystone trace PHOTO -o DIR`, as in "
    "docs/for-engineers.md#from-a-photograph-of-a-wall; a label image of its stones is read, too."
)
_CURES = {
    "E102": _TRACED,
    "E111": "Give the folder of a plan, one of one-stone masks of the whole wall, or a file.",
    "E113": "A wall is a plan.json, a block model (blocks), a label image, or outlines of its "
    "stones (labelme, COCO, GeoJSON, DXF, SVG ...).",
}
"""What helps with a wall, by code; the cures of readers are for stones on the ground."""
_STONES = "Stones are read from"
_SEGMENTED = (
    "find the stones in it with `drystone segment PHOTO`",
    "trace them with `drystone trace`, as in docs/for-engineers.md#from-a-photograph-of-a-wall",
)


def read_wall(path: Path, settings: ReadSettings | None = None) -> GivenWall:
    """Read a plan (with the wall image beside it), a block model, or whatever stones are read from.

    A label image keeps every pixel of every id, unless settings of reading say otherwise; outlines
    stay outlines.
    """
    settings = settings or ReadSettings()
    if path.is_dir():
        if not (path / PLAN).exists() and any(path.iterdir()):
            return _stones(path, settings)
        path /= PLAN
    if path.suffix.lower() != ".json":
        return _stones(path, settings)
    content = _read_json(path)
    keys = content.keys() if isinstance(content, dict) else set()
    model = not keys.isdisjoint({"blocks", "blocks_xywh"})
    # Of any version: what is, or once was, a plan.
    named = bool(keys) and str(content.get("schema", "")).startswith("drystone-plan")
    if not (model or named or keys >= {"steps", "source"}):
        return _stones(path, settings)
    if asked := [name for name, _ in replace(settings, px_per_m=None).changed()]:
        options = ", ".join(f"--{name.removesuffix('_px').replace('_', '-')}" for name in asked)
        what = f"this is a {'block model' if model else 'plan'}, which says itself what its stones"
        cure = f"Leave {'it' if len(asked) == 1 else 'them'} out; it is for pictures and outlines."
        raise UsageError(
            "E118", f"{what} are: {options} has no meaning.", where=str(path), cure=cure
        )
    if model:
        return GivenWall(None, blocks=content, notices=_unknown_keys(content))
    plan = read_plan(path)
    if not plan.steps:
        cure = "Plan again with other stones, or a larger wall."
        raise InputError("E104", "the plan has no stones.", where=str(path), cure=cure)
    labels = read_image_of(plan, path.parent)
    if labels is None or not shows(labels, plan):
        what = f"the {image_name(plan)} beside the plan shows other stones than the plan."
        if labels is None:
            what = f"there is no {image_name(plan)} beside the plan."
        cure = "Keep the files of a plan together, or give the label image itself."
        raise InputError("E133", what, where=str(path), cure=cure)
    if plan.settings.get("geometry") != "exact":
        _refuse_misplaced(labels, plan, path)
        return GivenWall(labels, plan)
    return GivenWall(labels, plan, _blocks_of(plan, labels, path))


_KEYS = {
    "": ("blocks", "blocks_xywh", "mu", "mu_head", "friction", "interfaces", "px_per_m"),
    "blocks": ("id", "polygon", "density", "fixed", "held", "angle_deg", "source_centroid"),
    "friction": ("between", "mu"),
    "interfaces": ("between", "points", "normal", "mu"),
}
"""Of a block model itself, and of the entries of its lists; those that plans write among them.

`px_per_m` goes with poses, and counts px of their source: lengths of a plan are in metres then."""

_REMARKS = ("comment", "meta", "name")
"""Keys that anything may have, as it may have those that begin with _."""


def _unknown_keys(content: Mapping[str, Any]) -> tuple[Notice, ...]:
    """Name the keys of a block model that mean nothing (W307), each where it comes first."""
    found, cures = dict[tuple[str, str], str](), dict[str, None]()
    posed = False
    for part, known in _KEYS.items():
        entries = content.get(part) if part else [content]
        for place, entry in enumerate(entries if isinstance(entries, list) else (), 1):
            for key in entry if isinstance(entry, dict) else ():
                posed = posed or key == "source_centroid"
                if key not in (*known, *_REMARKS) and not key.startswith("_"):
                    where = f" ({part}, entry {place})" if part else ""
                    found.setdefault((part, key), f"{reprlib.repr(key)}{where}")
                    cures[meant(key, known).strip()] = None
    if "px_per_m" in content and not posed:
        found["", "px_per_m"] = "'px_per_m'"
        cures["`drystone analyse --px-per-m` takes units in a metre."] = None
    if not found:
        return ()
    cure = " ".join(filter(None, cures)) or f"Keys of your own: {', '.join(_REMARKS)}, or _KEY."
    return (
        Notice("W307", f"keys that a block model does not have: {listed(found.values())}.", cure),
    )


def _stones(path: Path, settings: ReadSettings) -> GivenWall:
    """Read the stones of a wall; what is wrong with them is cured otherwise than on the ground."""
    try:
        return _wall_of_stones(path, settings)
    except InputError as error:
        if error.code in _CURES and (error.code == "E102" or error.cure.startswith(_STONES)):
            error.cure = _CURES[error.code]
        error.cure = error.cure.replace(*_SEGMENTED)
        raise


def _wall_of_stones(path: Path, settings: ReadSettings) -> GivenWall:
    data, name = b"", writable(path.name)
    with naming(name), suppress(OSError):  # what cannot be read is no file of outlines
        data = b"" if path.is_dir() else file_bytes(path)
        reader = outline_reader(data, name)
        if reader is not None:
            return _outlined(*stones_and_outlines(reader, data, name, settings))
    image = not path.is_dir() and not is_npz(data)
    if image and not replace(settings, background=0, px_per_m=None).changed():
        try:
            labels, notices = read_wall_picture(path, background=settings.background)
        except LabelImageError as error:
            if error.code != "E101":  # a mask with blended edges is one too
                raise
        else:
            ids = np.unique(labels[labels > 0]).tolist()
            if len(ids) > 1 or ids[0] not in _OF_MASKS or not pieces_apart(labels):
                height, width = labels.shape
                scale = scale_beside(read_sidecar(path), (width, height), path)
                return GivenWall(labels, notices=notices, px_per_m=scale)
    return _painted(read_stones(path, settings=settings))


def _painted(stones: StoneSet) -> GivenWall:
    labels, said = painted(stones)
    return GivenWall(labels, notices=(*stones.notices, *said), px_per_m=stones.source.px_per_m)


def _outlined(stones: StoneSet, file: OutlineFile) -> GivenWall:
    outlines = wall_outlines(file, stones)
    if outlines is None:
        return _painted(stones)
    below_px = min(stone.bottom_px for stone in stones)
    # That outlines were cut at the edges of their image is of pixels: blocks are not.
    notices = tuple(n for n in stones.notices if "outside the image, cut off" not in n.message)
    if file.ground is not None:
        tilt = math.degrees(math.atan(np.divide(*(file.ground[1] - file.ground[0])[::-1])))
        buried = listed(sorted({stone.id for stone in stones} - outlines.keys()))
        said = f"The ground was drawn: the wall is turned by {tilt:.2f} degrees and cut off at it"
        said += f", and {buried} left out" if buried else ""
        notices = (*notices, Notice("W301", f"{said}. It stands on its lowest point."))
    elif below_px > 0 and not file.y_up:
        said = f"The lowest point is {below_px} px above the lower edge of the image"
        notices = (*notices, Notice("W301", f"{said}: the wall stands on it."))
    return GivenWall(
        outlines_painted(outlines),
        notices=notices,
        outlines=outlines,
        px_per_m=stones.source.px_per_m,
        drawn=file.unit_m is not None,
    )


def shows(labels: Labels, plan: Plan) -> bool:
    """Say whether an image shows the stones and wedges of a plan and nothing else.

    Of a plan on outlines wedges may be missing that fill no pixel.
    """
    found = set(np.unique(labels).tolist()) - {0}
    planned = set(map(piece_id, plan.steps))
    exact = plan.settings.get("geometry") == "exact"
    may_miss = {step.id for step in plan.wedge_steps} if exact else set()
    return planned - may_miss <= found <= planned


def image_name(plan: Plan) -> str:
    """Return the name of the wall image that is written with a plan (DESIGN 2)."""
    return "wall.png" if max(map(piece_id, plan.steps), default=0) <= 65535 else "wall.tif"


def read_image_of(plan: Plan, folder: Path) -> Labels | None:
    """Return the wall image in the folder of a plan; None when it is not there."""
    path = folder / image_name(plan)
    if not path.exists():
        return None
    # One that is far larger is not of the plan, and is not decoded to find that out.
    px = plan.width * plan.height * (plan.working_scale * (plan.px_per_m or 1.0)) ** 2
    most_mpx = min(max(1.0, 4e-6 * px), MOST_PX / 1e6)
    return read_wall_picture(path, planned=True, max_image_mpx=most_mpx)[0]


def read_blocks_of(plan: Plan, folder: Path) -> Any:
    """Return what blocks.json beside a plan on outlines holds; None when it is not there."""
    path = folder / BLOCKS
    if plan.settings.get("geometry") != "exact" or not path.exists():
        return None
    content = _read_json(path, _TOGETHER)
    return {} if content is None else content  # a null is there, and is no block model


def unsupported(model: RigidBlockModel, wall: GivenWall, *, swept: bool = False) -> Notice | None:
    """Name the blocks that no chain of contacts connects with the ground (W302).

    `swept`: the gaps that could be closed are.
    """
    loose = loose_blocks(model)
    if not loose:
        return None
    said = f"{len(loose)} of {len(model.blocks)}"
    polygons = {} if wall.blocks is None else polygons_from_json(wall.blocks)
    height = min((float(one[:, 1].min()) for one in polygons.values()), default=None)
    if height is not None and not on_ground(model):
        cure = "Move the wall down to y = 0, the ground, or give what carries it as fixed."
        return Notice("W302", f"blocks in the air: {said}, the lowest at y = {height:g}.", cure)
    why = "touch neither the ground nor a block that is connected with it"
    cure = "Only edges that meet bear on each other: "
    if wall.blocks is not None:
        cure += "move blocks until they touch."
    elif swept:
        cure = "Trace what carries them, or leave them out with --skip."
    else:
        cure += "--close-gaps auto of `drystone analyse` looks for the gaps to close."
    return Notice("W302", f"{said} blocks {why}: {listed(loose)}.", cure)


def on_ground(model: RigidBlockModel) -> bool:
    """Tell whether anything stands on the ground, or is fixed like it."""
    fixed = any(block.fixed for block in model.blocks)
    return fixed or any(face.other == GROUND for face in model.interfaces)


def _blocks_of(plan: Plan, labels: Labels, path: Path) -> dict[str, Any]:
    """Return the block model beside a plan on outlines; E133 when it is not that of the plan."""
    blocks = read_blocks_of(plan, path.parent)
    # A hole that is kept moves the centroid of its stone, by less than half of its length.
    most = 0.5 if plan.source.get("reading", {}).get("holes") == "keep" else 0.0
    if blocks is None:
        what = f"there is no {BLOCKS} beside the plan."
    elif not isinstance(blocks, dict):
        what = f"the {BLOCKS} beside the plan is not a block model."
    elif set(polygons := polygons_from_json(blocks)) != set(planned := _planned(plan)):
        what = f"the {BLOCKS} beside the plan has other stones than the plan."
    elif not all(
        math.dist(_centroid(polygon), planned[block])
        <= CENTROID_PX / (plan.px_per_m or 1.0) + most * float(np.ptp(polygon, axis=0).max())
        for block, polygon in polygons.items()
    ):
        what = f"the {BLOCKS} beside the plan has its stones in other places than the plan."
    elif other := next((o for o in _differing(plan, blocks, labels) if o[1] != o[2]), None):
        what = "{} is {} by the plan, {} beside it.".format(*other)
    else:
        return blocks
    raise InputError("E133", what, where=str(path), cure=_TOGETHER)


def _differing(
    plan: Plan, blocks: Mapping[str, Any], labels: Labels
) -> Iterator[tuple[str, Any, Any]]:
    """Yield entries of a plan with their values, and those of the block model and the image.

    Blocks of other hands, or of before, have no scale and no poses; the image has its size.
    """
    yield "settings.mu", plan.settings.get("mu", 0.58), read_mu(blocks, "mu", 0.58)
    yield "units.px_per_m", plan.px_per_m, blocks.get("px_per_m", plan.px_per_m)
    to_px = plan.working_scale * (plan.px_per_m or 1.0)
    size, found = [plan.width * to_px, plan.height * to_px], list(labels.shape[::-1])
    if max(abs(px - side) for px, side in zip(found, size, strict=True)) > 1.0:
        yield f"the size of {image_name(plan)} (wall times units)", size, found
    given = {block["id"]: block for block in blocks.get("blocks", ())}
    for step in plan.stone_steps:
        pose = {"angle_deg": step.angle_deg, "source_centroid": list(step.source_centroid)}
        for key, value in pose.items():
            entry = f"{key} of step {step.step} (stone {step.stone})"
            yield entry, value, given.get(step.stone, {}).get(key, value)


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
    area = np.bincount(which, lengths)
    x, y = (np.bincount(which, at * lengths) / area for at in (middle, row))
    # About the centroids, so that nothing is lost far from the origin; 1/12 is a pixel's own.
    away = (middle - x[which]) ** 2 + lengths**2 / 12 + (row - y[which]) ** 2 + 1 / 12
    allowed = IMAGE_PX + RIM * np.bincount(which, away * lengths) / area**2
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


def _read_json(
    path: Path, cure: str = "Give a label image, the plan.json of a plan, or a block model."
) -> Any:
    def refused(what: str) -> InputError:
        return InputError("E132", what, where=str(path), cure=cure)

    try:
        data = file_bytes(path)
    except OSError as error:
        missing = isinstance(error, FileNotFoundError)
        why = "there is no such file." if missing else f"cannot be read ({error.strerror})."
        raise refused(why) from error
    with foreign(lambda why: refused(f"is not valid JSON ({why}).")):
        return json_of(data.decode("utf-8-sig"))


def wall_outlines(file: OutlineFile, stones: StoneSet) -> dict[int, Points] | None:
    """Return the outlines of the stones that were read, (n, 2) by id, counter-clockwise and closed.

    They are in px, y up from the lowest point; of a file in px x is that of its image.  Ground that
    the file draws is level, and what is wholly under it is not there.  Holes are filled, and of a
    stone in several pieces the largest counts, as when its pixels are read.  None when some stone
    is known by pixels only.
    """
    known = {stone.id or 0: stone for stone in file.stones}
    ids = [stone.id for stone in stones]
    if any(i not in known or known[i].masks or not known[i].areas for i in ids):
        return None
    scale = 1.0 if file.unit_m is None else file.unit_m * (stones.source.px_per_m or 1.0)
    sign = 1.0 if file.y_up else -1.0
    try:
        # A px is the measure of what is near, whatever the unit of the file.
        edges = {i: outer_edge(known[i].rings, near=1e-9 / scale) for i in ids}
    except ValueError:  # crossings without end
        return None
    found = {i: edge * (scale, sign * scale) for i, edge in edges.items() if edge is not None}
    if len(found) < len(ids):
        return None
    if file.ground is not None:
        found = _on_ground(found, file.ground * (1.0, -1.0))
    corners = np.concatenate(list(found.values()))
    # Of an image the left edge is that of the wall, but for what reaches beyond it.
    left = corners[:, 0].min()
    left = left if file.unit_m or file.y_up else min(0.0, np.floor(left))
    origin = np.array([left, corners[:, 1].min()])
    tidy = {i: tidy_edge(shapely.Polygon(outline - origin)) for i, outline in found.items()}
    outlines = {i: outline for i, outline in tidy.items() if outline is not None}
    return outlines if len(outlines) == len(found) else None


def outlines_painted(outlines: Mapping[int, Points]) -> Labels:
    """Return the label image whose lower left corner is the origin of outlines in px.

    Where they overlap the smaller stone is seen.  E110 where it would fill the memory.
    """
    corners = np.concatenate(list(outlines.values()))
    width, height = (max(1, math.ceil(side - 1e-9)) for side in corners.max(axis=0).tolist())
    check_size(width, height, MOST_PX, "Is a corner far away from the wall? Correct it.")
    labels = np.zeros((height, width), np.uint32)
    size = {i: shapely.Polygon(outline).area for i, outline in outlines.items()}
    for i in sorted(outlines, key=lambda one: (-size[one], one)):
        ring = outlines[i][:-1] * (1.0, -1.0) + (0.0, float(height))
        placed = filled_area(Area((ring,), "nonzero"))
        if placed is None:
            continue
        top, left, bottom, right = placed.sides
        labels[top:bottom, left:right][placed.mask] = i
    return labels


def _on_ground(rings: Mapping[int, Points], ground: Points) -> dict[int, Points]:
    """Turn rings until the ground is level; what is buried under it is cut off, or left out."""
    along = ground[1] - ground[0]
    cos, sin = along / np.hypot(*along) * np.sign(along[0])
    above = {}
    for i, ring in rings.items():
        corners = (ring - ground[0]) @ [[cos, -sin], [sin, cos]] + ground[0]
        turned = shapely.make_valid(shapely.Polygon(corners))
        left, _, right, top = turned.bounds
        seen = turned & shapely.box(left, ground[0, 1], right, max(top, ground[0, 1]))
        parts = [part for part in shapely.get_parts(seen) if part.area > 0.0]
        if parts:
            above[i] = np.array(max(parts, key=shapely.area).exterior.coords)[:-1]
    if not above:
        what = "no stone is above the ground that was drawn."
        raise LabelImageError("E104", what, cure="Draw the ground under the wall.")
    return above
