"""A wall of outlines must also stand with fewer and less able contacts (DESIGN 4.9).

The limit analysis lets friction act wherever outlines are near each other.  In the world upright
faces grip only what was pressed between them before, and a gap that counts as a contact may be
open.  So every action must leave a wall that stands, under its own weight, without friction on
upright faces and with half the contact tolerance; its load multipliers are those with all.
"""

from dataclasses import replace

from drystone.model.outlines import Outlined, Outlines
from drystone.settle.settings import SettleSettings
from drystone.statics.contacts.settled import model_with_outlines
from drystone.statics.model import RigidBlockModel


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
    added = model_with_outlines(model, blocks, outlines, 0.5 * settings.contact_px).added
    assert added is not None  # noqa: S101 - it was made by adding
    interfaces = tuple(
        replace(interface, mu=0.0) if abs(interface.normal[1]) < settings.steep else interface
        for interface in added.interfaces
    )
    return model.with_added(added.blocks, interfaces)
