"""How large a wall is, and which of its stones touch too little."""

from collections.abc import Mapping

import numpy as np

from drystone.contacts.scarce import scarce_contacts
from drystone.drawing.words.analysis import ModelledWall, Shapes
from drystone.errors import Notice

LISTED = 8
"""So many stones are named."""


def size_words(shapes: Shapes, per_unit_m: float | None) -> str | None:
    """Say how wide and high a wall is, in metres; None without a scale or a block."""
    if per_unit_m is None or not len(shapes):
        return None
    if isinstance(shapes, Mapping):
        corners = np.concatenate(list(shapes.values()))
        width, height = np.ptp(corners, axis=0).tolist()
    else:
        rows, cols = np.nonzero(shapes)
        width, height = float(np.ptp(cols) + 1), float(np.ptp(rows) + 1)
    return f"{width * per_unit_m:.2f} m wide, {height * per_unit_m:.2f} m high"


def scarcity(wall: ModelledWall, per_unit_m: float | None) -> Notice | None:
    """Name the stones with fewer than two contact points (W305)."""
    few = scarce_contacts(wall.model, wall.shapes)
    if not few:
        return None
    named = ", ".join(str(one.block) for one in few[:LISTED])
    more = ", …" if len(few) > LISTED else ""
    gaps = [one.gap for one in few if np.isfinite(one.gap)]
    noun = wall.noun if len(few) == 1 else f"{wall.noun}s"
    have = "has" if len(few) == 1 else "have"
    said = f"{len(few)} {noun} {have} fewer than two contact points: {named}{more}."
    if not gaps:
        return Notice("W305", said)
    pixels = not isinstance(wall.shapes, Mapping)
    unit = " px" if pixels else ""
    metres = "" if per_unit_m is None else f" ({1000.0 * per_unit_m * min(gaps):.0f} mm)"
    said += f" The narrowest gap beside them is {min(gaps):.3g}{unit}{metres}."
    if not pixels:
        return Notice("W305", said)
    reach = int(np.ceil(np.median(gaps)))
    which = "it" if len(few) == 1 else "half of them"
    return Notice("W305", said, f"--close-gaps {reach}px lets {which} bear on the next one.")
