"""The paper's choice of one wall from several trials (§5.2)."""

from collections.abc import Sequence
from math import floor

from drystone_lab.runs.outcome import Outcome

EXACT = 6
"""Decimals of a load multiplier that every solver agrees on; halves are rounded up after that."""


def best_trial(outcomes: Sequence[Outcome]) -> int:
    """Return the place of the wall with the highest filling and multiplier, to one decimal.

    The paper chooses "the wall with the highest filling ratio and kinematics multiplier (rounded
    to one decimal place)".  Taken here in the order in which they are named, both to one decimal,
    or the second would never count; between walls that are equal then the full figures decide, in
    the same order, and then the earlier trial.  Multipliers are over mu, as those that the paper
    prints seem to be (Fig. 14: .79, above any mu that it names): F_LR.

    Parameters
    ----------
    outcomes : sequence of Outcome
        At least one.
    """
    return max(range(len(outcomes)), key=lambda place: (*_merit(outcomes[place]), -place))


def tenths(value: float) -> int:
    """Round to one decimal, halves up; in tenths.

    Examples
    --------
    >>> tenths(0.45), tenths(0.4499999999), tenths(0.44)
    (5, 5, 4)
    """
    return floor(10 * round(value, EXACT) + 0.5)


def _merit(outcome: Outcome) -> tuple[float, float, float, float]:
    resistance = outcome.figures["F_LR"]
    filled = float(outcome.figures["F_SF"] or 0.0)
    if resistance is None:
        return tenths(filled), -1.0, filled, 0.0
    return tenths(filled), tenths(resistance), filled, round(resistance, EXACT)
