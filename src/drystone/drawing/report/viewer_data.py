"""A wall as plain JSON for the viewer: "drystone-view/1".

Lengths are in ``unit``, x to the right (from the left end of a plan, else as in the image or block
model) and y up from the ground.
"""

from collections.abc import Collection, Iterable, Mapping, Sequence
from dataclasses import asdict
from importlib.metadata import version
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from drystone.drawing.assembly.parts import Assembly
from drystone.drawing.outlines import regions_box, wall_regions
from drystone.drawing.photo import read_photo
from drystone.drawing.report.view_parts import given_parts, part_digits, planned_parts
from drystone.drawing.report.view_statics import Statics, contacts, mechanisms, rounded
from drystone.drawing.words import content
from drystone.drawing.words.masons import masons_words
from drystone.errors import Notice
from drystone.model.wall import Labels
from drystone.statics.failing.wording import Noun
from drystone.statics.model import RigidBlockModel
from drystone.statics.result import LateralResistance

SCHEMA = "drystone-view/1"

View = dict[str, Any]
"""See docs/viewer.md for its keys."""

FORCES = (
    "Forces at the limit loads are those of the analysis; those under {} alone are one of "
    "many possible states, mixed of both so that the loads from the side cancel."
)


def view_of_assembly(
    assembly: Assembly,
    *,
    notices: Sequence[Notice] = (),
    timings: Mapping[str, float] | None = None,
) -> View:
    """Show a plan.

    Parameters
    ----------
    assembly : Assembly
        The plan as parts, for example from :func:`drystone.drawing.assembly.read.read_assembly`.
    notices : sequence of Notice
        What reading the stones and planning had to decide.
    timings : mapping of str to float, optional
        Seconds of each part of the work.

    Returns
    -------
    view : dict
        Plain JSON; equal arguments give an equal one.
    """
    plan = assembly.plan
    digits = part_digits(assembly.size)
    shapes = {part.id: part.corners for part in assembly.parts}
    wedges = frozenset(part.id for part in assembly.wedges)
    statics = Statics(shapes, assembly.model, assembly.resistance, "stone", wedges)
    source = plan.source
    photo = read_photo(assembly) if source.get("width_px") and source.get("height_px") else None
    lying = {part.id: assembly.source_corners(part) for part in assembly.stones if photo}
    crops = photo.viewer_crops(lying) if photo else {}
    return {
        **_beginning(
            f"Dry-stone wall from {source.get('path') or 'stones'}", "stone", assembly.unit
        ),
        "summary": content.summary(plan),
        "size": rounded(assembly.size, digits),
        "box": _box(shapes.values(), assembly.size, digits),
        "version": plan.version,
        "method": plan.method,
        "seed": plan.seed,
        "steps": len(plan.steps),
        "parts": planned_parts(assembly, crops, digits),
        "unused": list(plan.unused),
        **_of_statics(statics, {part.id: part.centroid for part in assembly.parts}, digits),
        "index_meanings": dict(content.INDICES),
        "metrics": metrics(content.cards(plan), source.get("sha256")),
        "inputs": [list(pair) for pair in content.inputs(plan)],
        "settings": [list(pair) for pair in content.flat_settings(plan.settings)],
        **_end(notices, timings, content.assumptions(plan)),
    }


def view_of_wall(  # noqa: PLR0913 - what is said of a wall, all by keyword
    wall: Labels | Mapping[int, NDArray[np.float64]],
    model: RigidBlockModel,
    resistance: LateralResistance,
    *,
    title: str = "Wall",
    unit: Literal["px", "m", "units"] = "px",
    noun: Noun = "stone",
    wedges: Collection[int] = (),
    cards: Iterable[content.Card] = (),
    inputs: Iterable[tuple[str, str]] = (),
    settings: Mapping[str, Any] | None = None,
    notices: Sequence[Notice] = (),
    timings: Mapping[str, float] | None = None,
    load_case: str = content.TILTING,
    assumptions: Sequence[str] | None = None,
) -> View:
    """Show a wall that was not planned: its blocks have ids and no steps.

    Parameters
    ----------
    wall : (h, w) integer array, or mapping of int to (n, 2) float array
        What the blocks look like in the frame of the model: a label image, row 0 at the top, or
        polygons by id.
    model : RigidBlockModel
        Its blocks and contacts.
    resistance : LateralResistance
        Of the model, with mechanisms.
    title : str
        For people.
    unit : {"px", "m", "units"}
        Of lengths; "units" are those of a block model that says no other.
    noun : {"stone", "block"}
        What a block is called.
    wedges : collection of int
        Blocks that are wedges.
    cards : iterable of Card
        Further results, after those of the strength.
    inputs : iterable of (str, str)
        What the analysis was made from, names and values.
    settings : mapping, optional
        Every parameter of the analysis; tables in it become names with points.
    notices, timings
        As for :func:`view_of_assembly`.
    load_case : str
        Name of the loads of the analysis.
    assumptions : sequence of str, optional
        What the results rest on; None says those of the load case.

    Returns
    -------
    view : dict
        Plain JSON, as of a plan, with 0 ``steps``.
    """
    regions = wall_regions(wall)
    x0, y0, x1, y1 = regions_box(region.loops for region in regions)
    size = (x1 - x0, y1 - min(y0, 0.0))
    digits = part_digits(size)
    statics = Statics(wall, model, resistance, noun, wedges)
    many = f"{len(regions)} {noun}{'' if len(regions) == 1 else 's'}"
    return {
        **_beginning(title, noun, unit),
        "summary": f"{many}, {model.contact_count} contact points.",
        "size": rounded(size, digits),
        "box": rounded((x0, min(y0, 0.0), x1, y1), digits),
        "version": version("drystone"),
        "method": None,
        "seed": None,
        "steps": 0,
        "parts": given_parts(regions, model, wedges, digits),
        "unused": [],
        **_of_statics(
            statics, {region.id: region.centroid for region in regions}, digits, load_case
        ),
        "index_meanings": {},
        "metrics": metrics(
            (*content.strength_cards(content.Resisted.of(resistance), load_case), *cards), None
        ),
        "inputs": [list(pair) for pair in inputs],
        "settings": [list(pair) for pair in content.flat_settings(settings or {})],
        **_end(
            notices,
            timings,
            (*content.wall_assumptions(load_case), *content.model_assumptions(model))
            if assumptions is None
            else assumptions,
        ),
    }


def metrics(cards: Iterable[content.Card], sha256: str | None) -> list[Any]:
    """Return results with their meaning, and what walls of masons have."""
    return [{**asdict(card), "masons": masons_words(card.symbol, sha256)} for card in cards]


def _beginning(title: str, noun: Noun, unit: str) -> View:
    return {"schema": SCHEMA, "title": title, "noun": noun, "unit": unit}


def _of_statics(
    statics: Statics,
    centroids: Mapping[int, tuple[float, float]],
    digits: int,
    load_case: str = content.TILTING,
) -> View:
    failures = statics.failures()
    dead = content.dead_load(load_case)
    return {
        "mu": statics.model.mu,
        "contacts": contacts(statics, failures, digits + 1),
        "mechanisms": {
            side: {**found, "load": content.load_words(load_case, side)}
            for side, found in mechanisms(statics, failures, centroids).items()
        },
        "dead_load": dead,
        "forces_words": FORCES.format(dead),
    }


def _end(
    notices: Sequence[Notice], timings: Mapping[str, float] | None, assumptions: Sequence[str]
) -> View:
    return {
        "notices": [asdict(notice) for notice in notices],
        "timings": [[name, round(seconds, 3)] for name, seconds in (timings or {}).items()],
        "assumptions": list(assumptions),
    }


def _box(
    outlines: Iterable[NDArray[np.float64]], size: tuple[float, float], digits: int
) -> list[float]:
    """Return the box of the wall as ordered and of all that sticks out of it."""
    frame = np.array([[0.0, 0.0], size])
    corners = np.concatenate([frame, *outlines])
    box: list[float] = rounded((*corners.min(axis=0), *corners.max(axis=0)), digits)
    return box
