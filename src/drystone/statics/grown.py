"""What the analysis of a growing wall answers, and what it can be asked (§4.1)."""

from dataclasses import dataclass
from typing import Protocol

from drystone.statics.model import RigidBlockModel
from drystone.statics.result import LateralResistance


@dataclass(frozen=True, eq=False)
class Grown:
    """Resistance of a wall with one more stone.

    Parameters
    ----------
    resistance : LateralResistance
        As :func:`drystone.statics.limit.lateral_resistance` gives it, to the last digits.
    solved_cold : bool
        True when a warm answer had no certificate, so that all was solved again from the start.
    """

    resistance: LateralResistance
    solved_cold: bool = False


class GrowingAnalysis(Protocol):
    """Limit analysis of a wall on the tilting table, ready for one more stone; immutable.

    Answers depend on the wall and on how it has grown, and not on what else was asked, in which
    order, or in which thread.
    """

    @property
    def model(self) -> RigidBlockModel:
        """The wall."""
        ...

    @property
    def grown(self) -> Grown:
        """Resistance of the wall."""
        ...

    def resistance_with(self, model: RigidBlockModel) -> Grown:
        """Return the resistance of the wall with one more stone, a candidate; nothing changes.

        Parameters
        ----------
        model : RigidBlockModel
            Made from :attr:`model` by :meth:`RigidBlockModel.with_added`, as
            :func:`drystone.statics.contacts.blocks.model_with` does.  Any other model is
            answered too, without the gain in time.
        """
        ...

    def extended(self, model: RigidBlockModel) -> "GrowingAnalysis":
        """Return the analysis of the wall with one more stone, the chosen one.

        Its `grown` equals what `resistance_with` returns for the same model, bit by bit.
        """
        ...
