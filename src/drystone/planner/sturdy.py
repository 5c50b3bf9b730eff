"""A wall of outlines must also stand with fewer and less able contacts (DESIGN 4.9).

The limit analysis lets friction act wherever outlines are near each other.  In the world upright
faces grip only what was pressed between them before, a gap that counts as a contact may be open,
and friction has scatter.  So every action must leave a wall that stands, under its own weight,
with half the contact tolerance, without friction on upright faces, and with three quarters of it
on the others; its load multipliers are those with all.
"""

from dataclasses import replace

from drystone.model.outlines import Outlined, Outlines
from drystone.settle.settings import SettleSettings
from drystone.statics.contacts.joints import slippery
from drystone.statics.contacts.settled import model_of_outlines, model_with_outlines
from drystone.statics.model import RigidBlockModel

GRIP = 0.75
"""Share of the friction with which a wall must stand."""


def sturdy_model_with(
    model: RigidBlockModel, blocks: list[Outlined], outlines: Outlines, settings: SettleSettings
) -> RigidBlockModel:
    """Return the sturdy model of a wall with one more stone and its wedges.

    Parameters
    ----------
    model : RigidBlockModel
        The sturdy model of the wall without them.
    blocks : list of (int, (n, 2) float array)
        Ids and outlines of the stone and its wedges.
    outlines : Outlines
        Of the wall.
    settings : SettleSettings
        Contact tolerance, and which faces are upright.
    """
    added = model_with_outlines(
        model, blocks, outlines, 0.5 * settings.contact_px, settings.setback
    ).added
    assert added is not None  # noqa: S101 - it was made by adding
    return model.with_added(
        added.blocks, slippery(added.interfaces, model.mu, settings.steep, GRIP)
    )


def sturdy_model_of(outlines: Outlines, mu: float, settings: SettleSettings) -> RigidBlockModel:
    """Return the sturdy model of a whole wall.

    Parameters
    ----------
    outlines : Outlines
        Of the wall.
    mu : float
        Coefficient of friction.
    settings : SettleSettings
        Contact tolerance, and which faces are upright.
    """
    model = model_of_outlines(outlines, mu, 0.5 * settings.contact_px, settings.setback)
    return replace(model, interfaces=slippery(model.interfaces, mu, settings.steep, GRIP))
