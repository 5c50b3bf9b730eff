"""Friction of some interfaces only, and blocks that nothing carries."""

from collections.abc import Iterable
from dataclasses import replace
from math import cos, radians, sin

from drystone.statics.model import GROUND, Interface, RigidBlockModel


def is_head_joint(interface: Interface) -> bool:
    """Whether an interface is nearer to upright than to level: its normal lies flatter than 45°."""
    x, y = interface.normal
    return abs(x) > abs(y)


def with_head_friction(model: RigidBlockModel, mu: float) -> RigidBlockModel:
    """Give the head joints a coefficient of friction; 0 for open, dirty or wet ones.

    Joints that have one of their own keep it.
    """
    heads = (
        replace(face, mu=mu) if face.mu is None and is_head_joint(face) else face
        for face in model.interfaces
    )
    return replace(model, interfaces=tuple(heads))


def slippery(
    interfaces: Iterable[Interface],
    mu: float,
    steep: float | None = None,
    grip: float = 1.0,
    tilt_deg: float = 0.0,
) -> tuple[Interface, ...]:
    """Take the friction off upright faces; the others keep the share `grip`, 0 to 1, of theirs.

    Upright faces grip only what was pressed between them before, which weight alone does not do. A
    face is upright when its normal goes up or down by less than `steep`, 0 to 1.  Unless given, it
    is when it stands within its friction angle of the vertical, and nearer to upright than to
    level: there, and only there, can friction lift the block under the face.  `tilt_deg` turns
    gravity, and with it the vertical, towards +x.
    """
    changed, right, rise = [], cos(radians(tilt_deg)), sin(radians(tilt_deg))
    for interface in interfaces:
        own = mu if interface.mu is None else interface.mu
        x, y = interface.normal
        across, up = right * x + rise * y, right * y - rise * x
        upright = abs(up) < (min(own, 1.0) * abs(across) if steep is None else steep)
        changed.append(replace(interface, mu=0.0 if upright else grip * own))
    return tuple(changed)


def loose_blocks(model: RigidBlockModel) -> tuple[int, ...]:
    """Return the blocks that no chain of contacts connects with the ground or a fixed block."""
    touching: dict[int, set[int]] = {}
    for interface in model.interfaces:
        touching.setdefault(interface.block, set()).add(interface.other)
        touching.setdefault(interface.other, set()).add(interface.block)
    reached = {GROUND} | {block.id for block in model.blocks if block.fixed}
    new: Iterable[int] = set(reached)
    while new:
        new = set().union(*(touching.get(block, set()) for block in new)) - reached
        reached |= new
    return tuple(block.id for block in model.blocks if block.id not in reached)
