"""Stones and the walls that are to be built of them: one type for all studies."""

import tomllib
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path

from drystone.errors import UsageError
from drystone.model.stone import StoneSet
from drystone_lab.runs.spec import Changes, RunSpec, Scalar, StoneSource, generated, published


@dataclass(frozen=True)
class Target:
    """A stone set and the wall to be built of it."""

    name: str  # Of the wall; no other of a study has it
    source: StoneSource
    width: float  # width, height: Of the wall, source px; 0 for those of the source image
    height: float
    scale: float  # Working resolution over source resolution
    number: int = 0  # Of its row in Fig. 18 of the paper, or noise of its stones, %
    stand_in: bool = False  # True where the stones are not those of the paper
    suite: str = ""  # Of the public benchmark; empty for none
    instead: "Callable[[], Target] | None" = None  # Built where its stones are not at hand

    @property
    def noise(self) -> str:
        """Noise of its stones for people."""
        return f"{self.number} %{' gen.' * self.stand_in}"

    @property
    def said(self) -> str:
        """Whose stones they are, for people."""
        if not self.stand_in:
            return "published" if self.source.kind == "published" else "generated"
        return f"generated: not {'public' if 'Liu' in self.name else 'in the data folder'}"

    def here(self, data: Path | None) -> "Target":
        """Return it, or what is built in its place where its stones are not in the data folder."""
        if self.instead is None or self.source.is_there(data):
            return self
        return replace(self.instead(), scale=self.scale)

    def run(self, seed: int, *changes: tuple[str, Scalar], method: str = "paper") -> RunSpec:
        """Return a run by a method with some settings replaced."""
        return RunSpec(
            source=self.source, width=self.width, height=self.height, scale=self.scale,
            method=method, changes=changes, seed=seed,
        )  # fmt: skip

    def stones(self, data: Path | None) -> StoneSet | None:
        """Return the stones; None when published data that they need are not there."""
        return self.source.stones(data) if self.source.is_there(data) else None

    @property
    def working_px(self) -> str:
        """Width and height of the wall in working px, for people."""
        return f"{self.width * self.scale:.0f} x {self.height * self.scale:.0f}"

    def size(self, stones: StoneSet) -> tuple[float, float]:
        """Return the width and height of the wall, source px."""
        return self.run(0).size(stones)


R = Target("R", published("almeida/R.png"), 1435, 380, 0.2, 1)
PR = Target("PR", published("almeida/PR.png"), 556, 154, 0.5, 2)
IR = Target("IR", published("almeida/IR.png"), 1437, 373, 0.3, 3)
MASONS = (R, PR, IR)
"""Walls of the published stones of Almeida et al. (2021), whose masons' walls are known: as large
as what is free between the bounds of the paper's landscapes, 2 columns and 3 rows."""

R_FRAMED = replace(R, name="R framed", width=1445, height=395)
PR_560 = replace(PR, name="PR 560x160", width=560, height=160)
IR_FRAMED = replace(IR, name="IR framed", width=1443, height=383)
FRAMED = (R_FRAMED, PR_560, IR_FRAMED)
"""The same with the bounds, as the sizes that the paper prints: its images, not its walls."""

PR_FREE_596 = replace(PR, name="PR free in 600x160", width=596)
"""What is free of the image of the released example, 300 x 80 working px."""

PR_600 = replace(PR_560, name="PR 600x160", width=600)

LIU_4 = Target(
    "stand-in for wall 4 (Liu)",
    generated("rubble", 2018_4, count=40, width_px=600, height_px=300, courses=6),
    594, 316, 0.5, 4, stand_in=True,
)  # fmt: skip
LIU_5 = Target(
    "stand-in for wall 5 (Liu)", generated("polygon", 2018_5, count=30, noise=0.5), 880, 470,
    0.3, 5, stand_in=True,
)  # fmt: skip
"""The stones of Liu et al. (2018) are not public: rubble in courses, and polygons of much noise."""

FIVE = (*MASONS, LIU_4, LIU_5)
"""Fig. 18."""


def made_walls(path: Path) -> dict[str, tuple[Target, ...]]:
    """Return the walls of generated stones that a TOML file describes, by group.

    What the walls of a group have in common may stand beside them.
    """
    groups = tomllib.loads(path.read_text("utf-8"))
    return {
        group: tuple(
            Target(
                one["name"], generated(one["kind"], one["seed"], **one["settings"]), *one["size"]
            )
            for one in (about | wall for wall in about["walls"])
        )
        for group, about in groups.items()
    }


def generated_noise(noise: int, count: int = 26, scale: float = 0.3) -> Target:
    """Return generated stones, with a wall of which they are the same share as published ones.

    The noise is the deviation of the corners over the shorter side of the brick, %.  Published
    sets have 19 to 28 stones, .65 to .79 of their wall, whose aspect is 1.7 to 2.1.

    >>> wall = generated_noise(30)
    >>> round(wall.source.stones(None).total_area_px / (wall.width * wall.height), 3)
    0.696
    >>> round(wall.width / wall.height, 2)
    1.8
    """
    source = generated("polygon", 2018_00 + noise, count=count, noise=noise / 100)
    wall_px = source.stones(None).total_area_px / 0.696
    height = round((wall_px / 1.8) ** 0.5)
    width = round(wall_px / height)
    return Target(f"noise {noise} %", source, width, height, scale, noise, stand_in=True)


NOISES = tuple(range(10, 90, 10))
NOISY = tuple(
    Target(
        f"noise {noise} %",
        # The picture of 30 % was blended at a few edges: its other ids have 32 px at most.
        published(f"thangavelu/noise_{noise}.png", **({"least_px": 100} if noise == 30 else {})),
        0, 0, 0.3, noise,
        instead=partial(generated_noise, noise),
    )
    for noise in NOISES
)  # fmt: skip
"""Polygons of Thangavelu et al. (2018): the stones of finished walls, which have these sizes."""

BRICKS = Target("bricks", generated("brick", 0, count=9), 108, 36, 1.0)
"""What every study can do in a second or two."""

SEARCHED = (R_FRAMED, PR_600, PR_560, IR_FRAMED)

_MADE = made_walls(Path(__file__).with_name("walls.toml"))

JUDGED = (*SEARCHED, *NOISY, *_MADE["judged"])
"""Walls that are built up in the engine."""

UNSEEN = _MADE["unseen"]
"""Sets that no setting had been tuned on when they were measured; walls of their area over .8."""

TWO_SIDED: Changes = (("two_sided", True),)


def coarser(wall: Target, scale: float) -> Target:
    """Return a wall at a working scale that is not finer than this, for quick versions."""
    return replace(wall, scale=min(scale, wall.scale))


COARSE = (coarser(R, 0.1), coarser(PR, 0.25))
"""For quick versions: the many stones of IR take longest."""


def chosen(walls: Sequence[Target], only: Sequence[str], suite: str = "") -> tuple[Target, ...]:
    """Return the walls whose names begin with one of `only`; all without any."""
    names = [wall.name for wall in walls]
    for start in only:
        if not any(name.startswith(start) for name in names):
            what = f"no wall {f'of the suite {suite!r} ' if suite else ''}begins with {start!r}."
            cure = f"There are {'; '.join(names)}."
            raise UsageError("E138", what, where="--only", cure=cure)
    return tuple(wall for wall in walls if wall.name.startswith(tuple(only) or ""))
