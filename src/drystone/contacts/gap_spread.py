"""What closing the gaps of a picture does to the lateral load (DESIGN 4.8)."""

from collections.abc import Callable
from dataclasses import dataclass

from drystone.contacts.blocks import model_from_labels
from drystone.contacts.gaps import model_with_closed_gaps, settle_gaps
from drystone.model.wall import Labels
from drystone.statics.limit import lateral_resistance
from drystone.statics.model import RigidBlockModel
from drystone.statics.result import LateralResistance, LimitStatus


@dataclass(frozen=True)
class GapVariant:
    """F_LR for one way to treat the gaps."""

    name: str  # ``"gaps up to 4 px closed"``, ``"stones settled"``, ``"stones pushed left"``
    f_lr: float | None  # None unless both directions are optimal
    status: str  # of the direction that has no load multiplier, or "optimal"


@dataclass(frozen=True)
class GapSpread:
    """F_LR with the gaps treated as asked for, and what it would be otherwise."""

    chosen: GapVariant
    others: tuple[GapVariant, ...]

    def words(self) -> str:
        """Say it in a sentence without an end."""
        others = ", ".join(f"{_said(variant)} with {variant.name}" for variant in self.others)
        return f"F_LR {_said(self.chosen)} with {self.chosen.name} ({others})"


Analyse = Callable[[RigidBlockModel], LateralResistance]


def closed_gap_spread(
    labels: Labels,
    reach_px: float | None,
    mu: float = 0.58,
    analyse: Analyse = lateral_resistance,
) -> GapSpread:
    """Compute F_LR with gaps closed at a reach, at half and twice of it, or settled.

    `reach_px` is above 0; None settles stones, and compares with stones pushed to either side.
    """
    if reach_px is None:
        pictures = {
            "stones settled": model_from_labels(settle_gaps(labels)[0], mu),
            "stones pushed left": model_from_labels(settle_gaps(labels, "left")[0], mu),
            "stones pushed right": model_from_labels(settle_gaps(labels, "right")[0], mu),
        }
    else:
        pictures = {
            f"gaps up to {reach:g} px closed": model_with_closed_gaps(labels, reach, mu)
            for reach in (reach_px, reach_px / 2.0, 2.0 * reach_px)
        }
    chosen, *others = (_variant(name, analyse(p.model)) for name, p in pictures.items())
    return GapSpread(chosen, tuple(others))


def _variant(name: str, both: LateralResistance) -> GapVariant:
    told = next((r for r in (both.left, both.right) if r.alpha is None), both.left)
    return GapVariant(name, both.value, str(told.status))


def _said(variant: GapVariant) -> str:
    if variant.f_lr is not None:
        return f"{variant.f_lr:.3f}".removeprefix("0")
    # Without friction F_LR, which is over mu, is not defined.
    return "not defined" if variant.status == LimitStatus.OPTIMAL else variant.status
