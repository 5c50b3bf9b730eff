"""The block model beside a plan of outlines is that of its poses (E238)."""

from collections.abc import Iterator, Mapping
from typing import Any

import numpy as np
import shapely

from drystone.contacts.given import model_from_json, polygons_from_json
from drystone.errors import DrystoneError
from drystone.kernels.polygons import Points
from drystone.model.plan import Plan
from drystone.model.steps import Problem, piece_name
from drystone.statics.model import Interface, RigidBlockModel
from drystone.verify.replay import Replay

FILE = "blocks.json"

NEAR_PX = 0.01
"""So far apart, source px, outlines and contact points may be: rounding of either file."""

SAME_WAY = 1e-3
"""Between unit normals: that much a short edge turns when its ends are rounded."""


def check_blocks(
    content: Any, plan: Plan, replay: Replay, model: RigidBlockModel | None
) -> Iterator[Problem]:
    """Compare a block model with the plan of outlines that it lies beside (E238).

    `content` is that of blocks.json, or words that say why it has none.  `model` is that of the
    whole wall as it was built again, source px; None leaves contacts out.
    """
    if not isinstance(content, Mapping):
        why = f": {content}" if isinstance(content, str) else "."
        yield _problem(f"{FILE} is not a block model{why}")
        return
    try:
        polygons, claimed = polygons_from_json(content), model_from_json(content)
    except DrystoneError as error:
        yield _problem(f"{FILE} is not a block model: {error.where}: {error.what}")
        return
    px = plan.px_per_m or 1.0
    outlines = {block: corners * px for block, corners in polygons.items()}
    yield from _check_outlines(outlines, replay)
    # Of another density, or not free to move: no plan has them.
    odd = [b.id for b in claimed.blocks if b.density != 1.0 or b.fixed or b.held]
    if odd:
        named = ", ".join(map(str, odd))
        yield _problem(f"of another density, fixed or held in {FILE}: {named}.")
    mu = replay.settings.mu
    if any(abs(claimed.friction(face) - mu) > 1e-9 for face in claimed.interfaces):
        yield _problem(f"friction in {FILE} is not mu = {mu:g}.")
    if model is not None:
        theirs, ours = _by_pair(claimed, px), _by_pair(model, 1.0)
        for pair in sorted({*theirs, *ours}):
            if not _same(theirs.get(pair, []), ours.get(pair, [])):
                name = f"{pair[0] or 'the ground'} and {pair[1]}"
                said = f"the contacts between {name} in {FILE} are not those of their outlines."
                yield _problem(said)


def _check_outlines(outlines: Mapping[int, Points], replay: Replay) -> Iterator[Problem]:
    """Compare ids and polygons, source px."""
    pieces = {piece.id: piece for piece in replay.pieces}
    for block in sorted(set(outlines) - set(pieces)):
        yield _problem(f"{FILE} has a block {block}, which the plan does not place.")
    for block, piece in pieces.items():
        name, step = piece_name(piece.step), piece.step.step
        if block not in outlines:
            yield _problem(f"{name} is not in {FILE}.", step)
        elif piece.corners is not None:
            lines = [shapely.LinearRing(corners) for corners in (outlines[block], piece.corners)]
            off = float(shapely.hausdorff_distance(*lines))
            if not off <= NEAR_PX:
                said = f"the outline of {name} in {FILE} is {off:.3g} source px from its pose."
                yield _problem(said, step)


def _by_pair(model: RigidBlockModel, px: float) -> dict[tuple[int, int], list[Interface]]:
    """Return the interfaces of each pair in source px, normals into the larger id."""
    found: dict[tuple[int, int], list[Interface]] = {}
    for face in model.interfaces:
        low, high = sorted((face.block, face.other))
        (x, y), sign = face.normal, 1.0 if face.block == high else -1.0
        turned = Interface(high, low, face.points * px, (sign * x, sign * y))
        found.setdefault((low, high), []).append(turned)
    return found


def _same(claimed: list[Interface], found: list[Interface]) -> bool:
    """Say whether two lists hold the same contacts, in any order."""
    both = ((claimed, found), (found, claimed))
    met = (any(_meets(one, other) for other in those) for these, those in both for one in these)
    return len(claimed) == len(found) and all(met)


def _meets(one: Interface, other: Interface) -> bool:
    if one.points.shape != other.points.shape or not np.allclose(
        one.normal, other.normal, rtol=0.0, atol=SAME_WAY
    ):
        return False
    ways = (other.points, other.points[::-1])
    return any(float(np.hypot(*(one.points - way).T).max()) <= NEAR_PX for way in ways)


def _problem(message: str, step: int | None = None) -> Problem:
    return Problem("E238", step, message)
