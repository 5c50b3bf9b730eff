"""A wall of outlines must also stand with fewer and less able contacts (DESIGN 4.9).

The limit analysis lets friction act wherever outlines are near each other.  In the world upright
faces grip only what was pressed between them before, a gap that counts as a contact may be open,
and friction has scatter.  So every action must leave a wall that stands, under its own weight,
with half the contact tolerance, without friction on upright faces, and with three quarters of it
on the others; its load multipliers are those with all.

And the new stone must not be held by its own squeeze (DESIGN 4.8): let go between the others, with
all its friction, it must stay (:mod:`drystone.statics.flow.release`).
"""

from dataclasses import replace

import numpy as np
from scipy.optimize import nnls

from drystone.contacts.settled import model_of_outlines, model_with_outlines
from drystone.model.outlines import Outlined, Outlines
from drystone.settle.settings import SettleSettings
from drystone.statics.flow.release import AT_REST, fall_of, masses
from drystone.statics.joints import slippery
from drystone.statics.lp.program import Floats, assemble
from drystone.statics.model import RigidBlockModel

GRIP = 0.75
"""Share of the friction with which a wall must stand."""

ROUNDS = 12
"""In so many rounds a single stone that is let go comes to rest or falls."""


def sturdy_model_with(
    model: RigidBlockModel, blocks: list[Outlined], outlines: Outlines, settings: SettleSettings
) -> RigidBlockModel:
    """Return the sturdy model of a wall with one more stone and its wedges.

    `model` is that of the wall without them, `blocks` are theirs, source px.
    """
    added = model_with_outlines(
        model, blocks, outlines, 0.5 * settings.contact_px, settings.setback
    ).added
    assert added is not None  # noqa: S101 - it was made by adding
    return model.with_added(
        added.blocks, slippery(added.interfaces, model.mu, settings.steep, GRIP)
    )


def sturdy_model_of(outlines: Outlines, mu: float, settings: SettleSettings) -> RigidBlockModel:
    """Return the sturdy model of a whole wall."""
    model = model_of_outlines(outlines.blocks, mu, 0.5 * settings.contact_px, settings.setback)
    return replace(model, interfaces=slippery(model.interfaces, mu, settings.steep, GRIP))


def falls_when_let_go(model: RigidBlockModel) -> bool:
    """Return whether the last stone of a wall starts to fall from between the others.

    The model is made by adding the stone and its wedges, which are let go; all else is held.
    """
    assert model.added is not None  # noqa: S101 - it was made by adding
    touching = {interface.block for interface in model.added.interfaces}
    touching |= {interface.other for interface in model.added.interfaces}
    new = {block.id for block in model.added.blocks}
    held = (replace(b, fixed=True) for b in model.blocks if b.id in touching - new)
    alone = RigidBlockModel((*held, *model.added.blocks), model.added.interfaces, model.mu)
    program = assemble(alone)
    # Most stones come to rest in the rounds of `fall_of` alone, which are quick on small arrays.
    edges = program.matrix[:, 1:].toarray()
    if not edges.size:
        return True  # nothing is touched; SciPy would abort the process on a system of no columns
    if _comes_to_rest(masses(alone, program), -program.rhs, edges):
        return False
    return fall_of(alone, program, ROUNDS) is not None


def _comes_to_rest(masses: Floats, dead: Floats, edges: Floats) -> bool:
    """Go through the rounds of `fall_of` on small arrays: a wall asks that of every stone.

    Gauss's principle is the problem of the least distance, solved as non-negative least squares
    (Lawson and Hanson 1974, chapter 23.4).
    """
    root = np.sqrt(masses)
    falling = dead / root
    first, second = edges[:, ::2] / root[:, None], edges[:, 1::2] / root[:, None]
    faces, along = (first + second) / 2.0, (first - second) / 2.0
    slip = np.zeros(faces.shape[1])
    one = np.append(np.zeros(len(dead)), 1.0)
    for _ in range(ROUNDS):
        system = np.vstack((faces, -slip - falling @ faces))
        rest = system @ nnls(system, one)[0] - one
        moves = falling - rest[:-1] / rest[-1]
        if falling @ moves < AT_REST:
            return True
        faces, slip = np.hstack((first, second)), np.tile(np.abs(moves @ along), 2)
    return False
