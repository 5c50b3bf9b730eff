"""Load cases of the limit analysis: dead + alpha live, as forces on the blocks (Eq. 23).

The paper's tilting table is one of them.  Every case is made of forces at centroids, so cases
add up: ``Loads(weight(model) + point_load(model, 7, (3, 2), (0, -5)), live)``.
"""

import re
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from math import cos, isfinite, radians, sin, sqrt

import numpy as np

from drystone.errors import InputError, UsageError
from drystone.statics.model import GROUND, Block, RigidBlockModel
from drystone.statics.result import Floats

LISTED = 8
"""So many blocks are named."""

LARGEST_FORCE = 1e7
"""In mean weights, and its inverse is the smallest: solvers leave out numbers below 1e-9."""

ROUNDING = 1e-12
"""Less is left of forces that cancel, as a share of the largest."""

_NUMBER = r"([-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?)"
_POINT_LOAD = re.compile(rf"(\d+)@{_NUMBER},{_NUMBER}:{_NUMBER},{_NUMBER}")


@dataclass(frozen=True, eq=False)
class Loads:
    """What acts on the blocks: dead + alpha live.

    Both are (n, 3): horizontal force, vertical force (up) and moment (counter-clockwise) about the
    centroid of each block of the model, in its order.  Units: weights of the model; moments times
    its unit of length.  What acts on fixed blocks does not matter.
    """

    dead: Floats
    live: Floats
    name: str = "loads"
    tilt_deg: float = 0.0  # by which weight is turned, as in :func:`weight`

    def __post_init__(self) -> None:
        both = self.dead, self.live
        numbers = [getattr(one, "dtype", np.dtype(object)).kind in "iuf" for one in both]
        shaped = all(numbers) and self.dead.shape == self.live.shape == (*self.dead.shape[:1], 3)
        if not shaped or not np.isfinite(both).all():
            what = "dead and live are not two arrays of finite numbers, (n, 3)."
            raise InputError("E308", what, where="loads", cure="Correct them.")


def weight(model: RigidBlockModel, angle_deg: float = 0.0) -> Floats:
    """Return the weight of every block, (n, 3), turned towards +x with a base that is tilted."""
    angle = radians(angle_deg)
    weights = np.array([block.weight for block in model.blocks])
    return np.column_stack((sin(angle) * weights, -cos(angle) * weights, np.zeros(len(weights))))


def tilting_table(model: RigidBlockModel) -> Loads:
    """Weight, and alpha times every weight towards +x (§4.1).

    On a table tilted by an angle the horizontal share of weight is its tangent, so the blocks
    come down at atan(alpha_right).
    """
    live = weight(model)[:, [1, 0, 2]] * np.array([-1.0, 1.0, 1.0])
    return Loads(weight(model), live, "tilting table")


def growing_with_height(model: RigidBlockModel) -> Loads:
    """Weight, and a load towards +x that grows with the height above the ground.

    Each block is pushed by alpha w y / y_mean, with y_mean the height of the common centre of mass,
    so that alpha is the whole push over the whole weight, as for the tilting table.  Heights count
    from the lowest point at which free blocks stand on the ground or on what is fixed.  Without a
    free block above it it is an InputError (E307).
    """
    dead = weight(model)
    free = np.array([not block.fixed for block in model.blocks], bool)
    loose = {block.id for block in model.blocks if not block.fixed}
    seats = [
        face.points[:, 1].min()
        for face in model.interfaces
        if len(loose & {face.block, face.other}) == 1
        and face.normal[1] * (1 if face.block in loose else -1) > 0.0
    ]
    heights = np.array([block.centroid[1] for block in model.blocks]) - min(seats, default=0.0)
    push = -dead[:, 1] * np.maximum(heights, 0.0)
    if not push[free].sum() > 0:
        what = "no free block lies above the ground, so no load can grow with height."
        raise InputError("E307", what, where="load case", cure="Use the tilting table.")
    push *= -dead[free, 1].sum() / push[free].sum()
    zeros = np.zeros(len(push))
    return Loads(dead, np.column_stack((push, zeros, zeros)), "growing with height")


def point_load(
    model: RigidBlockModel, block: int, point: tuple[float, float], force: tuple[float, float]
) -> Floats:
    """Return a force on the block of an id at a point, (n, 3), to add to dead or live loads.

    The force is to the right and up, in weights of the model (area times density); the point is in
    the wall frame.  A block that is not there or is fixed is an InputError (E306), and so is a
    force or its moment that is far too small or too large beside the weight of a free block (E308).
    """
    row, found = _block(model, block)
    if found.fixed:
        what = f"block {block} is fixed, so a force on it loads nothing."
        cure = f"Name a free one: {_listed(b for b in model.blocks if not b.fixed)}."
        raise InputError("E306", what, where="load case", cure=cure)
    arm_x, arm_y = point[0] - found.centroid[0], point[1] - found.centroid[1]
    forces = np.zeros((len(model.blocks), 3))
    forces[row] = (*force, arm_x * force[1] - arm_y * force[0])
    free = [other for other in model.blocks if not other.fixed]
    mean, size = np.mean([(one.weight, sqrt(one.area)) for one in free], axis=0).tolist()
    most = float(np.abs(forces[row] / (mean, mean, mean * size)).max())
    if most and not 1.0 / LARGEST_FORCE <= most <= LARGEST_FORCE:
        what = f"a force on block {block}, or its moment, is {most:.1g} times the mean weight."
        cure = f"Give from 1e-7 to 1e7 times {mean:.3g}, an area times density."
        raise InputError("E308", what, where="load case", cure=cure)
    return forces


def support_settlement(model: RigidBlockModel, block: int) -> tuple[RigidBlockModel, Loads]:
    """Let a fixed block give way downwards, and find what holds it (settlement of a support).

    The support becomes weightless and free to move up and down, and alpha times the weight of all
    free blocks presses it up: a unit of alpha is that weight.  The least alpha, of
    :func:`drystone.statics.limit.load_range`, is the reaction below which the wall comes down with
    the settling support, and its mechanism is how; the greatest is what lifts it.  (Kinematics of
    settlement as in limit analysis of masonry, with the reaction of the moving support as the
    unknown.)  The block no longer stands on the ground.  One that is not there or not fixed is an
    InputError (E306).
    """
    row, found = _block(model, block)
    if not found.fixed:
        what = f"block {block} is not fixed, so it is not a support that can settle."
        fixed = [other for other in model.blocks if other.fixed]
        cure = f"Name a fixed one: {_listed(fixed)}."
        if not fixed:
            cure = 'Say "fixed": true of the support, in a block model.'
        raise InputError("E306", what, where="load case", cure=cure)
    carried = [other.weight for other in model.blocks if not other.fixed]
    # Weightless in this case: as heavy as the others, so that it does not spoil their units.
    usual = float(np.mean(carried)) if carried else found.area
    guided = replace(found, fixed=False, held=("x", "turn"), area=usual, density=1.0)
    blocks = (*model.blocks[:row], guided, *model.blocks[row + 1 :])
    others = (GROUND, *(other.id for other in model.blocks if other.fixed and other.id != block))
    resting = [{block, other} for other in others]
    kept = tuple(i for i in model.interfaces if {i.block, i.other} not in resting)
    released = RigidBlockModel(blocks, kept, model.mu)
    dead = weight(released)
    dead[row] = 0.0
    live = np.zeros_like(dead)
    live[row, 1] = sum(carried)
    return released, Loads(dead, live, f"settlement of block {block}")


def _block(model: RigidBlockModel, block: int) -> tuple[int, Block]:
    for row, found in enumerate(model.blocks):
        if found.id == block:
            return row, found
    cure = f"There are {_listed(model.blocks)}."
    raise InputError("E306", f"there is no block {block}.", where="load case", cure=cure)


def _listed(blocks: Iterable[Block]) -> str:
    ids = [str(block.id) for block in blocks]
    more = f" and {len(ids) - LISTED} more" if len(ids) > LISTED else ""
    return ", ".join(ids[:LISTED]) + more if ids else "there is none"


@dataclass(frozen=True)
class LoadCase:
    """A load case by the words that ask for it, as `drystone analyse` has them."""

    load: str  # what grows
    tilt: float  # turns gravity towards the right, degrees
    dead: Sequence[str]  # forces at points, as they are written
    live: Sequence[str]
    settle: int | None

    def __post_init__(self) -> None:
        unheard = ""
        if self.is_range and self.tilt:
            unheard = "--tilt goes with loads on a standing wall only."
        elif self.settle is not None and self.load != "tilting":
            unheard = "--settle is a load case of its own; leave --load out."
        elif self.live and self.load != "points":
            unheard = "--live goes with --load points only."
        if unheard:
            raise UsageError("E138", unheard, where="loads")

    @property
    def is_plain(self) -> bool:
        """Whether the case is the tilting table, and nothing else acts."""
        return self.load == "tilting" and not (self.tilt or self.dead or self.settle is not None)

    @property
    def is_range(self) -> bool:
        """Whether alpha = 0 means nothing in this case, so that a range is the answer."""
        return self.settle is not None or self.load == "gravity"


def load_case(case: LoadCase, model: RigidBlockModel) -> tuple[RigidBlockModel, Loads]:
    """Return the loads of a case, and the model for them."""
    if case.settle is not None:
        model, loads = support_settlement(model, case.settle)
    elif case.load == "height":
        loads = growing_with_height(model)
    elif case.load == "gravity":
        # The least alpha is the share of its weight with which the wall still carries the others:
        # 1 / alpha is the safety against being too light.  The greatest is mostly unbounded.
        loads = Loads(weight(model) * 0.0, weight(model), "gravity factor")
    elif case.load == "points":
        if not case.live:
            cure = "Add --live ID@X,Y:FX,FY once or more."
            raise UsageError("E138", "--load points needs forces.", cure=cure)
        forces = np.array([point_load(model, *force_at(text, "--live")) for text in case.live])
        live = np.sum(forces, axis=0)
        arm = sqrt(np.mean([block.area for block in model.blocks]))
        total, largest = (np.abs(one / (1.0, 1.0, arm)).max() for one in (live, forces))
        if total <= ROUNDING * largest:
            what = "the live load is nothing: its forces are 0, or cancel."
            raise InputError("E308", what, where="load case", cure="Correct them.")
        loads = Loads(weight(model), live, f"point loads ({' '.join(case.live)})")
    else:
        loads = tilting_table(model)
    if case.tilt:
        turned = weight(model, case.tilt) - weight(model)
        name = f"{loads.name}, tilted by {case.tilt:g}°"
        loads = replace(loads, dead=loads.dead + turned, name=name, tilt_deg=case.tilt)
    for text in case.dead:
        loads = replace(loads, dead=loads.dead + point_load(model, *force_at(text, "--dead")))
    if case.dead:
        loads = replace(loads, name=f"{loads.name}, dead forces ({' '.join(case.dead)})")
    return model, loads


def force_at(text: str, option: str) -> tuple[int, tuple[float, float], tuple[float, float]]:
    """Read ID@X,Y:FX,FY: a block, the point where a force acts on it, and the force (E138)."""
    found = _POINT_LOAD.fullmatch(text)
    if found is None:
        cure = "Write ID@X,Y:FX,FY, as in 7@120,85:0,-200."
        raise UsageError("E138", f"{text!r} is not a force at a point.", where=option, cure=cure)
    x, y, fx, fy = (float(part) for part in found.groups()[1:])
    if not all(isfinite(number) for number in (x, y, fx, fy)):
        raise UsageError("E138", f"{text!r} is not finite.", where=option, cure="Give numbers.")
    return int(found.group(1)), (x, y), (fx, fy)
