"""Stones and the walls that are to be built of them: one type for all studies."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path

from drystone.errors import UsageError
from drystone.model.stone import StoneSet
from drystone_lab.runs.spec import Changes, RunSpec, Scalar, StoneSource, generated, published


@dataclass(frozen=True)
class Target:
    """A stone set and the wall to be built of it."""

    name: str  # Of the wall; no other of a study has it
    source: StoneSource  # The stones; generated ones where the paper's are not public
    width: float  # width, height: Of the wall, source px; 0 for those of the source image
    height: float
    scale: float  # Working resolution over source resolution
    number: int = 0  # Of its row in Fig. 18 of the paper, or noise of its stones, %
    stand_in: bool = False  # True where the stones are not those of the paper
    suite: str = ""  # Of the public benchmark; empty for none

    def run(self, seed: int, *changes: tuple[str, Scalar], method: str = "paper") -> RunSpec:
        """Return a run by a method with some settings replaced."""
        return RunSpec(
            source=self.source, width=self.width, height=self.height, scale=self.scale,
            method=method, changes=changes, seed=seed,
        )  # fmt: skip

    def stones(self, data: Path | None) -> StoneSet | None:
        """Return the stones; None when published data that they need are not there."""
        return self.source.stones(data) if self.source.is_there(data) else None

    def size(self, stones: StoneSet) -> tuple[float, float]:
        """Return the width and height of the wall, source px."""
        source = stones.source
        return self.width or float(source.width_px), self.height or float(source.height_px)


R = Target("R", published("almeida/R.png"), 1445, 395, 0.2, 1)
PR = Target("PR", published("almeida/PR.png"), 560, 160, 0.5, 2)
IR = Target("IR", published("almeida/IR.png"), 1443, 383, 0.3, 3)
PR_560 = replace(PR, name="PR 560x160")
PR_600 = replace(PR, name="PR 600x160", width=600)
MASONS = (R, PR, IR)
"""Walls of the published stones of Almeida et al. (2021), whose masons' walls are known."""

LIU_4 = Target(
    "stand-in for wall 4",
    generated("rubble", 2018_4, count=40, width_px=600, height_px=300, courses=6),
    594, 316, 0.5, 4, stand_in=True,
)  # fmt: skip
LIU_5 = Target(
    "stand-in for wall 5", generated("polygon", 2018_5, count=30, noise=0.5), 880, 470, 0.3, 5,
    stand_in=True,
)  # fmt: skip
"""The stones of Liu et al. (2018) are not public: rubble in courses, and polygons of much noise."""

FIVE = (*MASONS, LIU_4, LIU_5)
"""Fig. 18."""

NOISY = tuple(
    Target(f"noise {noise} %", published(f"thangavelu/noise_{noise}.png"), 0, 0, 0.3, noise)
    for noise in (10, 20, 40, 50, 70)
)
"""Published polygons of Thangavelu et al. (2018)."""

BRICKS = Target("bricks", generated("brick", 0, count=9), 108, 36, 1.0)
"""What every study can do in a second or two."""

SEARCHED = (R, PR_600, PR_560, IR)

JUDGED = (
    *SEARCHED,
    *NOISY,
    Target(
        "Fourier",
        generated("fourier", 0, count=40, smallest_radius_px=15, largest_radius_px=35, D2=0.2),
        400, 200, 0.6,
    ),
    Target("polygons", generated("polygon", 0, count=30, noise=0.2), 800, 460, 0.3),
)  # fmt: skip
"""Walls that are built up in the engine."""

UNSEEN = (
    Target(
        "Fourier, 45",
        generated("fourier", 9301, count=45, smallest_radius_px=16, largest_radius_px=34, D2=0.15),
        621, 200, 0.6,
    ),
    Target("polygons 20 %, 40", generated("polygon", 9302, count=40, noise=0.2), 1462, 400, 0.3),
    Target("polygons 60 %, 40", generated("polygon", 9303, count=40, noise=0.6), 1462, 400, 0.25),
    Target(
        "rubble, 60",
        generated("rubble", 9304, count=60, width_px=900, height_px=300, courses=5), 990, 300, 0.5,
    ),
    Target(
        "rubble, 120",
        generated("rubble", 9305, count=120, width_px=1400, height_px=420, courses=7),
        1437, 450, 0.45,
    ),
    Target(
        "bricks, 48", generated("brick", 9306, count=40, height_px=24, aspect=2.5, halves=8),
        550, 144, 0.6,
    ),
)  # fmt: skip
"""Sets that no setting had been tuned on when they were measured; walls of their area over .8."""

TWO_SIDED: Changes = (("two_sided", True),)


def coarser(wall: Target, scale: float) -> Target:
    """Return a wall at a working scale that is not finer than this, for quick versions."""
    return replace(wall, scale=min(scale, wall.scale))


def chosen(walls: Sequence[Target], only: Sequence[str], suite: str = "") -> tuple[Target, ...]:
    """Return the walls whose names begin with one of `only`; all without any."""
    names = [wall.name for wall in walls]
    for start in only:
        if not any(name.startswith(start) for name in names):
            raise UsageError(
                "E138",
                f"no wall {f'of the suite {suite!r} ' if suite else ''}begins with {start!r}.",
                where="--only",
                cure=f"There are {'; '.join(names)}.",
            )
    return tuple(wall for wall in walls if wall.name.startswith(tuple(only) or ""))
