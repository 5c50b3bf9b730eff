"""What the paper says beside what was found, a row each; and trends by rank."""

from collections.abc import Sequence
from dataclasses import dataclass

from scipy.stats import spearmanr

from drystone_lab.table import Table

LEVEL = 0.05
"""A trend is one that equal chances would give less often than this."""

FEWEST = 4
"""Pairs without which there is no talk of a trend: three ranks fall in line by chance too often."""


@dataclass(frozen=True)
class Finding:
    """One claim of the paper.

    Parameters
    ----------
    claim : str
        In short, with its place.
    found : str
        Of our walls, with computed numbers.
    holds : bool or None
        Whether that agrees; None where it cannot be told.
    """

    claim: str
    found: str
    holds: bool | None


@dataclass(frozen=True)
class Trend:
    """Spearman's correlation of the ranks.

    Parameters
    ----------
    rho : float
        -1 ... 1.
    p : float
        Chance of a |rho| as large without any relation (t distribution).
    count : int
        Pairs.
    """

    rho: float
    p: float
    count: int

    @property
    def clear(self) -> bool:
        """True when chance alone would hardly give it."""
        return self.p < LEVEL

    def words(self) -> str:
        """Return it for a sentence.

        Examples
        --------
        >>> Trend(-0.5, 0.012345, 24).words()
        'rho -0.50, p 0.012, n 24'
        """
        return f"rho {self.rho:.2f}, p {self.p:.2g}, n {self.count}"


def trend(pairs: Sequence[tuple[float, float | None]]) -> Trend | None:
    """Correlate the ranks of two figures.

    Parameters
    ----------
    pairs : sequence of (float, float or None)
        One of them over the other; those with a None are left out.

    Returns
    -------
    Trend or None
        None with less than :data:`FEWEST` pairs, or where either is always the same.

    Examples
    --------
    >>> trend([(1, 2.0), (2, 3.0), (3, 5.0), (4, 4.0), (5, None)])
    Trend(rho=0.8, p=0.2, count=4)
    """
    x = [pair[0] for pair in pairs if pair[1] is not None]
    y = [pair[1] for pair in pairs if pair[1] is not None]
    if len(x) < FEWEST or len({*x}) < 2 or len({*y}) < 2:
        return None
    found = spearmanr(x, y)
    return Trend(round(float(found.statistic), 6), float(f"{found.pvalue:.3g}"), len(x))


def findings_table(title: str, findings: Sequence[Finding]) -> Table:
    """Return claims and findings as a table."""
    rows = tuple((each.claim, each.found, each.holds) for each in findings)
    return Table(title, ("the paper", "here", "agrees"), rows)


def agreeing(findings: Sequence[Finding]) -> str:
    """Say of how many claims the walls agree with the paper.

    Examples
    --------
    >>> agreeing([Finding("low walls", "2 px", True), Finding("cheap", "not told", None)])
    'Of 1 claim of the paper that can be told, 1 agrees.'
    """
    told = [each for each in findings if each.holds is not None]
    right = sum(each.holds is True for each in told)
    if not told:
        return "None of the paper's claims can be told."
    claims, agree = "claim" if len(told) == 1 else "claims", "agrees" if right == 1 else "agree"
    return f"Of {len(told)} {claims} of the paper that can be told, {right} {agree}."


def sentences(findings: Sequence[Finding]) -> tuple[str, ...]:
    """Return a paragraph a finding, and how many agree."""
    verdicts = {True: "Agrees", False: "Differs", None: "Cannot be told"}
    each = (f"{verdicts[one.holds]}: {one.claim} Here: {one.found}" for one in findings)
    return (agreeing(findings), *each)
