"""What the walls of masons measure, for comparison."""

from dataclasses import dataclass

from drystone.io.published_sets import SETS


@dataclass(frozen=True)
class MasonsWall:
    """A wall of Almeida et al. (2021) as it was traced; stones do not touch there, so no F_LR.

    Parameters
    ----------
    name : {"R", "PR", "IR"}
        Of the stones: regular, partly regular, irregular.
    F_SF : float
        Filling.
    F_AV, F_AH : float
        Interlocking and waviness of courses, per cent.
    """

    name: str
    F_SF: float
    F_AV: float
    F_AH: float


WALLS = (
    MasonsWall("R", 0.846, 33.9, 0.59),
    MasonsWall("PR", 0.808, 29.5, 1.50),
    MasonsWall("IR", 0.850, 23.8, 3.69),
)
"""Measured as docs/paper.md has them."""


def masons_wall(sha256: str | None) -> MasonsWall | None:
    """Return the mason's wall of the same stones, known by the hash of their file."""
    names = {file.sha256: file.name for file in SETS["almeida"].files}
    found = names.get(sha256 or "")
    return next((wall for wall in WALLS if found == f"almeida/{wall.name}.png"), None)


def masons_words(symbol: str, sha256: str | None) -> str | None:
    """Say what a figure of merit is in walls of masons; None for one that is not known.

    Parameters
    ----------
    symbol : str
        ``"F_SF"``, ``"F_AV"`` or ``"F_AH"``; of others nothing is known.
    sha256 : str or None
        Of the file that the stones are from.

    Examples
    --------
    >>> masons_words("F_AV", None)
    '23.8 to 33.9 % in three walls of masons, of other stones'
    """
    if symbol not in ("F_SF", "F_AV", "F_AH"):
        return None
    digits, unit = {"F_SF": (3, ""), "F_AV": (1, " %"), "F_AH": (2, " %")}[symbol]
    same = masons_wall(sha256)
    if same is not None:
        own = getattr(same, symbol)
        return f"{own:.{digits}f}{unit} in the mason's own wall of these stones ({same.name})"
    values = [getattr(wall, symbol) for wall in WALLS]
    least, most = (f"{value:.{digits}f}" for value in (min(values), max(values)))
    return f"{least} to {most}{unit} in three walls of masons, of other stones"
