"""How much is timed."""

from dataclasses import dataclass

from drystone.planner.settings import METHODS, PlannerSettings

SCALES = {"medium": 1.0, "small": 0.5}
"""Working resolutions of the scenes; the small one is that of the paper, 280 x 80 px."""


@dataclass(frozen=True)
class Sizes:
    """How much is timed.

    Parameters
    ----------
    scenes : tuple of str
        Images.
    counts : tuple of int
        Stones of the walls in the limit analysis.
    generated : int or None
        Number of generated stones instead of published ones.
    steps : int or None
        Steps that are taken by the slow planner too; None for a whole wall.
    walls : int
        Budget of the search, in method best.
    repeats : int
        Of whole walls.
    traced : tuple of str
        Methods whose memory is looked at.
    """

    scenes: tuple[str, ...]
    counts: tuple[int, ...]
    generated: int | None = None
    steps: int | None = None
    walls: int = METHODS["best"].search.budget
    repeats: int = 1
    traced: tuple[str, ...] = ("paper",)

    def settings(self, method: str) -> PlannerSettings:
        """Return the settings of a method; "paper, full batch" tries all stones in every step."""
        name, _, full = method.partition(",")
        changes: dict[str, object] = {"sampling": "full"} if full else {}
        if name == "best":
            changes["search"] = {"budget": self.walls}
        return METHODS[name].updated(changes)


SIZES = {
    "full": Sizes(("small", "medium", "large"), (10, 30, 60), repeats=3, traced=("paper", "best")),
    "quick": Sizes(("small",), (10, 30), steps=12),
    "smoke": Sizes(("small",), (5,), generated=8, steps=2, walls=1),
}
