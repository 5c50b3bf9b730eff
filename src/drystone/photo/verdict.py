"""Whether a photograph as a whole is one that stones can be found in: the first thing to say."""

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np

from drystone.errors import Notice
from drystone.photo.segment import FoundStones
from drystone.photo.segment_doubts import Doubt

CLEAR = 5.0
"""Contrast of the usual outline over what the ground itself varies: from here on it is plain.

Photographs of river beds, walls and rooms have .8 to 4.7, stones on tarpaulin, cloth, wood, gravel
and grass 6.2 and more."""

LITTLE, VERY_LITTLE = 0.05, 0.01
"""Shares of the photograph that are stone, least on varied ground and on any."""

VARIED = 4.0
"""What a ground varies in CIELAB, robust standard deviation, that is more than cloth or wood."""

UNEVEN = 0.85
"""How much darker the darkest place of the ground is lit: beyond, stones there get lost."""

SHEET = 0.35
"""Share of the photograph from which on a stone may be the sheet that stones lie on."""

LEFT_OUT, LEFT_OUT_SHARE = 2.0, 0.1
"""What was left out over what was found, and over the photograph, that is more than some stones."""

FEW = 3
"""So many stones are looked at one by one."""


@dataclass(frozen=True)
class Verdict:
    """What speaks against all that was found; empty when nothing does."""

    reasons: tuple[str, ...]

    @property
    def doubtful(self) -> bool:
        """Whether a person must look before anything is built of it."""
        return bool(self.reasons)

    @property
    def notices(self) -> tuple[Notice, ...]:
        """The reasons as a notice."""
        if not self.reasons:
            return ()
        return (Notice("W183", f"doubtful: {'; '.join(self.reasons)}.", _CURE),)


_CURE = (
    "Look at preview.png. Lay the stones apart on a plain sheet of another colour and photograph "
    "nothing else, or crop the photograph to it; masks of a river bed or a wall come from other "
    "programs (docs/photographs.md)."
)


def verdict_of(found: FoundStones, doubts: Iterable[Doubt] = ()) -> Verdict:
    """Judge what was found by the whole picture: ground, shares, contrast, and doubts."""
    areas = np.bincount(found.labels.ravel(), minlength=2)[1:]
    shown = found.labels.size
    stone = float(areas.sum()) / shown
    varies = float(found.ground.spread.max())
    contrast = float(np.median(found.contrast))
    reasons = []
    if contrast < CLEAR * varies:
        reasons.append(
            f"the ground is not plain (its colour varies by {varies:.0f}, and what was found "
            f"differs from it by {contrast:.0f}, in CIELAB)"
        )
    if found.ground.uneven > UNEVEN:
        percent = 100 * (1 - found.ground.uneven)
        reasons.append(
            f"the light is very uneven (the darkest ground has {percent:.0f} % of the brightest)"
        )
    if areas.max() > SHEET * shown:
        percent = 100 * float(areas.max()) / shown
        reasons.append(
            f"stone {int(areas.argmax()) + 1} takes up {percent:.0f} % of the photograph and may "
            "be the sheet that the stones lie on"
        )
    if stone < (LITTLE if varies > VARIED else VERY_LITTLE):
        reasons.append(
            f"only {100 * stone:.2g} % of the photograph was taken for stones, which may be paint, "
            "dirt or light"
        )
    left_out = sum(one.area_px for one in found.left_out) / shown
    if left_out > max(LEFT_OUT * stone, LEFT_OUT_SHARE):
        reasons.append(
            f"{100 * left_out:.0f} % of the photograph differs from the ground and was left out, "
            f"{100 * stone:.0f} % was taken for stones"
        )
    doubted = {one for doubt in doubts for one in doubt.stones}
    if found.count >= FEW and len(doubted) > found.count / 2:
        reasons.append(f"{len(doubted)} of {found.count} stones are in doubt")
    return Verdict(tuple(reasons))
