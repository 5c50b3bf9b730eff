"""COCO: a JSON file of annotations with polygons or run lengths, for one image or for many."""

from collections import Counter
from collections.abc import Mapping, Sequence
from pathlib import PurePath
from typing import Any

from drystone.errors import InputError, Notice
from drystone.io.listed import listed, short
from drystone.io.outlines_in.fill import Room, check_reach
from drystone.io.outlines_in.model import (
    Area,
    OutlinedStone,
    OutlineFile,
    PlacedMask,
    entry,
    left_aside,
    number_in,
    ring,
    side_px,
)
from drystone.io.outlines_in.nested import without_nested
from drystone.io.outlines_in.run_lengths import is_runs, mask_of, size_of
from drystone.io.read_settings import ReadSettings

_OF_MODEL = ("predicted_iou", "stability_score")


def is_coco(content: object) -> bool:
    """Tell COCO by its keys."""
    return isinstance(content, Mapping) and isinstance(content.get("annotations"), list)


def read_coco(content: Mapping[str, Any], where: str, settings: ReadSettings) -> OutlineFile:
    """Read the annotations of one image.

    Polygons of one annotation are united, which is COCO's own rule: it has no holes but in run
    lengths.  Files that the automatic masks of SAM were released in have ``image`` instead of
    ``images``, and are read as :mod:`~drystone.io.outlines_in.sam` says.
    """
    chosen, image = _chosen(content, where, settings.image)
    with entry(where, "the list of categories"):
        categories = {c.get("id"): str(c.get("name", "")) for c in content.get("categories") or ()}
    shown = categories if len(categories) > 1 else {}
    stones, sizes, aside, masks_of_crowds = [], set(), Counter[str](), 0
    room = Room(where, int(settings.max_image_mpx * 1e6))
    only_crowds = all(map(_is_crowd, chosen))
    for number, found in enumerate(chosen):
        with entry(where, f"annotation {found.get('id', number)}"):
            segmentation = found.get("segmentation")
            if _is_crowd(found):
                # CVAT (datumaro) calls every mask a crowd; the attributes are its own, too.
                if not is_runs(segmentation) or not (only_crowds or "attributes" in found):
                    aside["crowd regions (several stones as one)"] += 1
                    continue
                masks_of_crowds += 1
            if not segmentation:
                aside["annotations without an outline"] += 1
                continue
            areas, masks = shape_of(segmentation, room)
            if is_runs(segmentation):
                sizes.add(size_of(segmentation))
            name = shown.get(found.get("category_id"), "")
            stones.append(OutlinedStone(number_in(found.get("id")), name, areas, masks))
    size = size_in(image, sizes, where)
    notices: list[Notice] = left_aside(aside)
    if masks_of_crowds:
        text = f"{masks_of_crowds} masks are marked as crowds, as CVAT marks all: a stone each."
        notices.append(Notice("W119", text, "Skip the ids of those that are several stones."))
    if any(name in found for found in chosen for name in _OF_MODEL):
        check_reach(stones, where, room.max_px)
        stones, nested = without_nested(stones, where, settings.skip)
        notices += nested
    return OutlineFile(tuple(stones), size_px=size, notices=tuple(notices), names_images=True)


def _is_crowd(found: Mapping[str, Any]) -> bool:
    return found.get("iscrowd") not in (None, 0, "0", "")


def shape_of(segmentation: Any, room: Room) -> tuple[tuple[Area, ...], tuple[PlacedMask, ...]]:
    """Return a segmentation as areas or as a mask, which takes of the room."""
    if is_runs(segmentation):
        mask = mask_of(segmentation, room)
        return (), () if mask is None else (mask,)
    polygons = []
    for flat in segmentation:
        if len(flat) % 2:
            raise ValueError("a polygon has an odd number of coordinates")
        polygons.append(Area((ring(list(zip(flat[0::2], flat[1::2], strict=True))),)))
    return tuple(polygons), ()


def size_in(
    image: Mapping[str, Any] | None, masks: set[tuple[int, int]], where: str
) -> tuple[int, int] | None:
    """Return the size that the image and all run lengths agree on; E114 when they do not."""
    sizes = set(masks)
    with entry(where, "the image"):
        if image is not None and image.get("width") and image.get("height"):
            sizes.add((side_px(image["width"]), side_px(image["height"])))
        if len(sizes) > 1:
            found = listed(f"{width} x {height}" for width, height in sorted(sizes))
            raise ValueError(f"its sizes differ: {found} px")
    return sizes.pop() if sizes else None


def _chosen(
    content: Mapping[str, Any], where: str, name: str
) -> tuple[list[Mapping[str, Any]], Mapping[str, Any] | None]:
    """Return the annotations of the image that was asked for, or of the only one."""
    annotations = content["annotations"]
    images = content.get("images") or ()
    if isinstance(content.get("image"), Mapping):
        images = ({**content["image"], "id": None},)
    with entry(where, "the list of images"):
        if not all(isinstance(found, Mapping) for found in annotations):
            raise TypeError("annotations are no objects")
        known = {image.get("id"): image for image in images}
        names = {i: str(image.get("file_name", i)) for i, image in known.items()}
        used = list(dict.fromkeys(found.get("image_id") for found in annotations))
    if name:
        used = [i for i in known if name in (names[i], PurePath(names[i]).name, str(i))]
        if len(used) != 1:
            raise image_needed(f"no image or several are called {name!r}", where, names.values())
    if len(used) > 1:
        raise image_needed(
            f"stones of {len(used)} images are in it", where, [names.get(i, str(i)) for i in used]
        )
    only = used[0] if used else None
    image = known.get(only) or (next(iter(known.values())) if len(known) == 1 else None)
    return [found for found in annotations if found.get("image_id") == only], image


def image_needed(what: str, where: str, names: Sequence[str] | Any) -> InputError:
    """Make the error for several images in one file (E115)."""
    return InputError(
        "E115", f"{what}.", where=where,
        cure="Say which one with --image NAME (ReadSettings.image); there are "
        f"{listed(map(short, names))}.",
    )  # fmt: skip
