"""Walls that several items of the paper share (§5.1, §5.2)."""

from dataclasses import dataclass, replace

from drystone_lab.runs.source import Scalar, StoneSource, generated, published
from drystone_lab.runs.spec import RunSpec


@dataclass(frozen=True)
class PaperWall:
    """A wall of Fig. 18.

    Parameters
    ----------
    number : int
        Of its row there.
    name : str
        Of the stones.
    source : StoneSource
        The stones; generated ones where the paper's are not public.
    width, height : float
        Of the wall, source px.
    scale : float
        At which it has the paper's size in px.
    stand_in : bool
        True where the stones are not the paper's.
    """

    number: int
    name: str
    source: StoneSource
    width: float
    height: float
    scale: float
    stand_in: bool = False

    def run(self, seed: int, *changes: tuple[str, Scalar], method: str = "paper") -> RunSpec:
        """Return a run: the paper's method with some settings replaced."""
        return RunSpec(
            source=self.source, width=self.width, height=self.height, scale=self.scale,
            method=method, changes=changes, seed=seed,
        )  # fmt: skip


R = PaperWall(1, "R", published("almeida/R.png"), 1445, 395, 0.2)
PR = PaperWall(2, "PR", published("almeida/PR.png"), 560, 160, 0.5)
IR = PaperWall(3, "IR", published("almeida/IR.png"), 1443, 383, 0.3)

LIU_4 = PaperWall(
    4, "stand-in for wall 4",
    generated("rubble", 2018_4, count=40, width_px=600, height_px=300, courses=6),
    594, 316, 0.5, stand_in=True,
)  # fmt: skip
LIU_5 = PaperWall(
    5, "stand-in for wall 5", generated("polygon", 2018_5, count=30, noise=0.5), 880, 470, 0.3,
    stand_in=True,
)  # fmt: skip
"""The stones of Liu et al. (2018) are not public: rubble in courses, and polygons of much noise."""

MASONS = (R, PR, IR)
WALLS = (*MASONS, LIU_4, LIU_5)

TWO_SIDED = ("two_sided", True)


def coarser(wall: PaperWall, scale: float) -> PaperWall:
    """Return a wall at a working scale that is not finer than this, for quick versions."""
    return replace(wall, scale=min(scale, wall.scale))
