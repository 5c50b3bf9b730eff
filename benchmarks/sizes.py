"""How much is timed."""

from dataclasses import dataclass

from drystone.planner.settings import METHODS, PlannerSettings

SCALES = {"medium": 1.0, "small": 0.5}
"""Working resolutions of the scenes; the small one is that of the paper, 280 x 80 px."""


@dataclass(frozen=True)
class Sizes:
    """How much is timed."""

    scenes: tuple[str, ...]  # Images
    counts: tuple[int, ...]  # Stones of the walls in the limit analysis
    generated: int | None = None  # Number of generated stones instead of published ones
    steps: int | None = None  # Steps that are taken by the slow planner too; None for a whole wall
    walls: int = METHODS["best"].search.budget  # Budget of the search, in method best
    repeats: int = 1  # Of whole walls
    traced: tuple[str, ...] = ("paper",)  # Methods whose memory is looked at

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
    "smoke": Sizes(("small",), (5,), generated=6, steps=1, walls=1),
}
