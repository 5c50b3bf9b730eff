"""What the walls of masons measure, for comparison."""

from dataclasses import dataclass

from drystone.io.published_sets import SETS


@dataclass(frozen=True)
class MasonsWall:
    """A wall of Almeida et al. (2021) as it was traced: F_SF, and F_AV and F_AH in per cent.

    Stones are regular, partly regular or irregular; they do not touch there, so no F_LR.
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
    """Say what F_SF, F_AV or F_AH is in walls of masons; None for a figure that is not known."""
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
