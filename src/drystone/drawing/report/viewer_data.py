"""A wall as plain JSON for the viewer: "drystone-view/1".

Lengths are in ``unit``, x to the right (from the left end of a plan, else as in the image or block
model) and y up from the ground.
"""

import json
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import asdict
from importlib.metadata import version
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal

import numpy as np
from numpy.typing import NDArray

from drystone.drawing.assembly import Assembly, assembly_of_result
from drystone.drawing.outlines import regions_box, wall_regions
from drystone.drawing.palette import PLAIN_COLOUR, WEDGE_COLOUR, cluster_colour, text_colour
from drystone.drawing.photo import read_photo
from drystone.drawing.pictures.mechanism import motion_of
from drystone.drawing.sheet.words import beside_words, step_words, turn_words
from drystone.drawing.words import content
from drystone.drawing.words.analysis import STONES, ModelledWall, judge_wall
from drystone.errors import Notice, counted
from drystone.io.plan_json import plan_digest
from drystone.kernels.polygons import Points
from drystone.model.plan import Plan, Point, StoneStep
from drystone.model.settings import flat
from drystone.model.wall import Labels
from drystone.statics.failing.mechanism import Failure, Names
from drystone.statics.model import RigidBlockModel
from drystone.statics.result import LateralResistance, LimitResult, LimitStatus

if TYPE_CHECKING:
    from drystone.search.plan_result import PlanResult

SCHEMA = "drystone-view/1"

ViewerData = dict[str, Any]  # see docs/viewer.md for its keys
FORCES = (
    "Forces at the limit loads are those of the analysis; those under {} alone are one of "
    "many possible states, mixed of both so that the loads from the side cancel."
)
OUTCOMES = {
    LimitStatus.UNSTABLE: "It does not stand under its own weight.",
    LimitStatus.FAILED: "The analysis has no answer that could be certified.",
    LimitStatus.UNBOUNDED: "No load in this direction brings it down.",
}
PATTERNS = ("none", "rising", "falling", "dots", "level", "upright", "crossed", "grid")
"""Clusters that are apart in their colour only by a little are apart in their pattern."""


def view_of_result(
    result: "PlanResult", *, photo: Path | None = None, notices: Sequence[Notice] | None = None
) -> ViewerData:
    """Show a plan that was just made; see :func:`view_of_assembly`.

    `photo` shows the stones in the frame of the source image; `notices` are those of the result
    alone when missing.
    """
    return view_of_assembly(
        assembly_of_result(result, photo),
        notices=result.notices if notices is None else notices,
        timings={"planning": result.seconds},
    )


def view_of_assembly(
    assembly: Assembly,
    *,
    notices: Sequence[Notice] = (),
    timings: Mapping[str, float] | None = None,
) -> ViewerData:
    """Show a plan, with what reading stones and planning had to decide, and seconds by part.

    Plain JSON; equal arguments give an equal one.
    """
    plan = assembly.plan
    digits = part_digits(assembly.size)
    shapes = {part.id: part.corners for part in assembly.parts}
    names = Names("stone", frozenset(part.id for part in assembly.wedges), plan.step_by_id)
    wall = ModelledWall(assembly.model, shapes, names, tuple(notices))
    placed, metrics = len(plan.stone_steps), plan.metrics
    stands, summary = judge_wall(
        f"{placed} of {placed + len(plan.unused)} stones", wall, assembly.resistance,
        without_dilatancy={"left": metrics.alpha_left_coulomb,
                           "right": metrics.alpha_right_coulomb},
        can_fall=metrics.F_LR_coulomb == 0.0,
    )  # fmt: skip
    cards = content.cards(plan, stands=stands)
    # The wall as ordered, and all that sticks out of it.
    corners = np.concatenate([[(0.0, 0.0), assembly.size], *shapes.values()])
    return _view(
        wall, assembly.resistance, digits, cards,
        {part.id: part.centroid for part in assembly.parts}, plan=plan,
        title=f"Dry-stone wall from {content.source_name(plan) or 'stones'}", unit=assembly.unit,
        size=rounded(assembly.size, digits),
        box=rounded((*corners.min(axis=0), *corners.max(axis=0)), digits),
        parts=_planned_parts(assembly, digits), inputs=[list(one) for one in content.inputs(plan)],
        timings=[[name, round(seconds, 3)] for name, seconds in (timings or {}).items()],
        settings=[[".".join(path), json.dumps(value, ensure_ascii=False)]
                  for path, value in flat(plan.settings)],
        assumptions=content.assumptions(plan), summary=f"{summary}.", stands=stands,
    )  # fmt: skip


def view_of_wall(
    wall: Labels | Mapping[int, NDArray[np.float64]],
    model: RigidBlockModel,
    resistance: LateralResistance,
    *,
    title: str = "Wall",
    unit: Literal["px", "m", "units"] = "px",
    names: Names = STONES,
    cards: Iterable[content.ResultCard] = (),
    load_case: str = content.TILTING,
    verdict: tuple[bool | None, str] | None = None,
) -> ViewerData:
    """Show a wall that was not planned: its blocks have ids and no steps.

    `wall` is what the blocks look like in the frame of the model: a label image, row 0 at the top,
    or polygons by id.  Lengths in "units" are those of a block model that says no other; `names`
    say what its blocks are called, and which of them are wedges.  `cards` are further results,
    after those of the strength, of a wall that stands.  `load_case` is the name of its loads;
    `verdict` is that of a :class:`~drystone.drawing.words.analysis.Card`, where more is known than
    the resistance.

    The view is as of a plan, with 0 ``steps``; what it was made from is for whoever knows.
    """
    regions = wall_regions(wall)
    x0, y0, x1, y1 = regions_box(region.loops for region in regions)
    size = (x1 - x0, y1 - min(y0, 0.0))
    digits = part_digits(size)
    shown = ModelledWall(model, wall, names)
    count = sum(region.id not in names.wedges for region in regions)
    stands, summary = verdict or judge_wall(
        counted(count, names.noun), shown, resistance, load_case=load_case
    )
    results = () if stands is False else (
        *content.strength_cards(resistance.value, resistance.left.alpha, resistance.right.alpha,
                                load_case=load_case),
        *cards,
    )  # fmt: skip
    parts = [
        _part(
            region.id, "wedge" if region.id in names.wedges else "stone", region.loops,
            region.centroid, digits, number=region.id,
            size=rounded(np.ptp(np.concatenate(region.loops), axis=0), digits),
            neighbours=model.touched_by(region.id),
        )
        for region in regions
    ]  # fmt: skip
    return _view(
        shown, resistance, digits, results,
        {region.id: region.centroid for region in regions}, load_case, title=title, unit=unit,
        size=rounded(size, digits), box=rounded((x0, min(y0, 0.0), x1, y1), digits), parts=parts,
        inputs=[], timings=[], settings=[],
        assumptions=content.wall_assumptions(model, load_case),
        summary=f"{summary}.", stands=stands,
    )  # fmt: skip


def _view(
    wall: ModelledWall,
    resistance: LateralResistance,
    digits: int,
    cards: Iterable[content.ResultCard],
    centroids: Mapping[int, Point],
    load_case: str = content.TILTING,
    plan: Plan | None = None,
    **said: Any,
) -> ViewerData:
    """Return all keys; results come with their meaning and with what walls of masons have."""
    ends = (resistance.left, resistance.right)
    failures, dead = wall.failures(ends), content.dead_load(load_case)
    sha256 = None if plan is None else plan.source.get("sha256")
    return {
        **said,
        "version": version("drystone") if plan is None else plan.version,
        "method": plan and plan.method,
        "seed": None if plan is None else plan.seed,
        "plan": plan and plan_digest(plan),
        "steps": 0 if plan is None else len(plan.steps),
        "unused": [] if plan is None else list(plan.unused),
        "schema": SCHEMA,
        "noun": wall.names.noun,
        "mu": wall.model.mu,
        "contacts": _contacts(wall.model, _forces_by_case(*ends), failures, digits + 1),
        "mechanisms": {
            end.direction: {
                **_mechanism(wall, end, failures.get(end.direction), centroids),
                "load": content.load_words(load_case, end.direction),
            }
            for end in ends
        },
        "dead_load": dead,
        "forces_words": FORCES.format(dead),
        "notices": [asdict(notice) for notice in wall.notices],
        "index_meanings": {} if plan is None else dict(content.INDICES),
        "metrics": [
            {**asdict(card), "masons": content.masons_words(card.symbol, sha256)} for card in cards
        ],
        "assumptions": list(said["assumptions"]),
    }


def part_digits(size: tuple[float, float]) -> int:
    """Return the digits of lengths at which a hundred-thousandth of a wall is left out.

    >>> part_digits((280.0, 80.0)), part_digits((1.4, 0.4))
    (2, 4)
    """
    longest = max(*size, 1e-9)
    return max(0, 4 - int(np.floor(np.log10(longest))))


def _planned_parts(assembly: Assembly, digits: int) -> list[ViewerData]:
    source = assembly.plan.source
    photo = read_photo(assembly) if source.get("width_px") and source.get("height_px") else None
    lying = {part.id: assembly.source_corners(part) for part in assembly.stones}
    crops = photo.viewer_crops(lying) if photo else {}
    made = []
    for part in assembly.parts:
        step = part.plan_step
        shown = _part(
            part.id, part.kind, [part.corners], part.centroid, digits, part.cluster,
            step=part.step, number=part.step if part.kind == "stone" else None,
            angle_deg=round(part.angle_deg, 3) + 0.0, size=rounded(part.size, digits),
            neighbours=list(assembly.neighbours(part.id)), under=part.under,
            wedges=[wedge.id for wedge in assembly.wedges_after(part)],
            words=step_words(assembly, part), crop=crops.get(part.id),
            alpha_left=_short(step.alpha_left), alpha_right=_short(step.alpha_right),
        )  # fmt: skip
        if isinstance(step, StoneStep):
            shown["side"] = step.side
            shown["indices"] = {name: _short(value) for name, value in step.indices.items()}
            shown["source"] = rounded(lying[part.id], 2)
            shown["turn"] = turn_words(part.angle_deg)
            shown["beside"] = beside_words(assembly, part)
        made.append(shown)
    return made


def _part(
    part_id: int,
    kind: str,
    loops: Iterable[Points],
    centroid: Point,
    digits: int,
    cluster: int | None = None,
    **known: Any,
) -> ViewerData:
    """Return a stone or wedge; of what was not planned there is no step and no source."""
    colour, pattern = WEDGE_COLOUR if kind == "wedge" else PLAIN_COLOUR, PATTERNS[0]
    if cluster is not None:
        colour, pattern = cluster_colour(cluster), PATTERNS[(cluster - 1) % len(PATTERNS)]
    unknown = ("step", "angle_deg", "turn", "beside", "under", "crop", "side", "source",
               "alpha_left", "alpha_right")  # fmt: skip
    return {
        "id": part_id,
        "kind": kind,
        "name": f"{kind}_{part_id:03d}",
        "points": [rounded(loop, digits) for loop in loops],
        "centroid": rounded(centroid, digits + 1),
        "cluster": cluster,
        "colour": colour,
        "text_colour": text_colour(colour),
        "pattern": pattern,
        **dict.fromkeys(unknown),
        "wedges": [],
        "words": "",
        "indices": {},
        **known,
    }


def _forces_by_case(left: LimitResult, right: LimitResult) -> dict[str, NDArray[np.float64]]:
    """Return normal and tangential forces of the load cases that have them.

    Under its own weight alone a wall has many states of forces.  One is given: the mixture of
    those at the two limit loads in which the live loads cancel, which is in equilibrium and
    within friction as both are.
    """
    ends = (left, right)
    found = {str(end.direction): end.forces for end in ends if end.forces is not None}
    if len(found) == 2 and left.alpha is not None and right.alpha is not None:
        total = left.alpha + right.alpha
        share = right.alpha / total if total > 0 else 0.5
        return {"self": share * found["left"] + (1 - share) * found["right"], **found}
    return found


def _contacts(
    model: RigidBlockModel,
    cases: Mapping[str, NDArray[np.float64]],
    failures: Mapping[str, Failure],
    digits: int,
) -> list[ViewerData]:
    """Return where blocks touch, what the joints carry, and what they do in the mechanisms.

    The normal points into the first block of ``between``.  Forces are [normal, tangential] at
    every point, shares of the weight of all free blocks; the tangent of a normal (x, y) is (y, -x).
    """
    weight = sum(block.weight for block in model.blocks if not block.fixed) or 1.0
    made, start = [], 0
    for interface in model.interfaces:
        at = slice(start, start + len(interface.points))
        start = at.stop
        made.append(
            {
                "between": [interface.block, interface.other],
                "points": rounded(interface.points, digits),
                "normal": rounded(interface.normal, 5),
                "forces": {case: rounded(f[at] / weight, 6) for case, f in cases.items()},
                "kinds": {side: list(f.contact_kinds[at]) for side, f in failures.items()},
            }
        )
    return made


def _mechanism(
    wall: ModelledWall, end: LimitResult, failure: Failure | None, centroids: Mapping[int, Point]
) -> ViewerData:
    """Return how the wall fails to one side.

    ``velocity`` by id is that of the centroids: to the right, up, turning counter-clockwise, rad.
    By ``scale`` it becomes displacements of a size that is seen.
    """
    said = (OUTCOMES.get(end.status), failure.words if failure else "")
    words = " ".join(filter(None, said))
    alpha = None if end.alpha is None else round(end.alpha, 6) + 0.0
    found: ViewerData = {"status": str(end.status), "alpha": alpha, "words": words}
    mechanism = end.mechanism
    if mechanism is None:
        return {**found, "velocity": None, "scale": 0.0}
    shown = motion_of(wall.shapes, mechanism).displacement
    largest = float(np.abs(mechanism.velocity).max(initial=0.0))
    scale = float(np.abs(shown).max(initial=0.0)) / largest if largest else 0.0
    known = {block.id: np.array(block.centroid) for block in wall.model.blocks}
    velocity = {}
    for block, (vx, vy, turning) in zip(mechanism.block_ids, mechanism.velocity, strict=True):
        # A mechanism has the velocity of the block's own centroid.
        arm_x, arm_y = np.array(centroids[block]) - known[block]
        twist = (vx - turning * arm_y, vy + turning * arm_x, turning)
        if any(abs(value) > 1e-9 for value in twist):
            velocity[str(block)] = [float(f"{value:.7g}") for value in twist]
    return {**found, "velocity": velocity, "scale": float(f"{scale:.7g}")}


def rounded(values: Any, digits: int) -> Any:
    """Return numbers as nested lists of few digits; never -0."""
    return (np.round(np.asarray(values, float), digits) + 0.0).tolist()


def _short(value: float | None) -> float | None:
    return None if value is None or not np.isfinite(value) else round(float(value), 4) + 0.0
