"""What is said of walls that were shaken, and the unit of the noise."""

from dataclasses import dataclass
from typing import Any

from drystone.io.walls import GivenWall
from drystone.statics.result import LimitStatus
from drystone.statics.scatter.scatter import Quantiles, Scatter


@dataclass(frozen=True)
class Unit:
    """What noise is given in.

    Parameters
    ----------
    name : str
        For people.
    lengths : float
        How many lengths of the model it is.
    """

    name: str
    lengths: float = 1.0

    def words(self, noise: float) -> str:
        """Say how large a noise is that is known in lengths of the model."""
        return f"{noise / self.lengths:g} {self.name}"


@dataclass(frozen=True, eq=False)
class ScatterCard:
    """What the shaken walls carry.

    Parameters
    ----------
    scatter : Scatter
        The walls.
    unit : Unit
        Of the noise, as it was given.
    """

    scatter: Scatter
    unit: Unit

    def rows(self) -> list[tuple[str, str]]:
        """Return names and values, one a line."""
        counts = self.scatter.counts
        rows = [("scatter", self._shaken())]
        for name, quantiles in self._quantiles():
            if quantiles is not None:
                low, median, high = quantiles
                rows.append((f"  {name}", f"{median:.3f} (5 % to 95 %: {low:.3f} to {high:.3f})"))
        share = self.scatter.falling_share
        if share is not None:
            said = f"{counts[LimitStatus.UNSTABLE]} walls, {100 * share:.0f} %"
            which = "have a limit" if counts[LimitStatus.UNBOUNDED] else "stand"
            rows.append(("  do not stand", f"{said}; the figures above are of those that {which}"))
        for status, name in ((LimitStatus.UNBOUNDED, "unbounded"), (LimitStatus.FAILED, "failed")):
            if counts[status]:
                rows.append((f"  {name}", f"{counts[status]} walls, without a number"))
        return rows

    def report(self) -> dict[str, Any]:
        """Return the same as JSON, with every sample."""
        found = self.scatter
        value = found.value
        return {
            "samples": found.settings.samples,
            "seed": found.seed,
            "mu": found.mu.tolist(),
            "status": [str(status) for status in found.status],
            "alpha_left": found.alpha_left.tolist(),
            "alpha_right": found.alpha_right.tolist(),
            "F_LR": None if value is None else value.tolist(),
            "alpha_5_50_95": found.alpha_quantiles,
            "F_LR_5_50_95": found.value_quantiles,
        }

    def _quantiles(self) -> list[tuple[str, Quantiles | None]]:
        found = self.scatter
        return [("min alpha", found.alpha_quantiles), ("F_LR", found.value_quantiles)]

    def _shaken(self) -> str:
        made = self.scatter.settings
        parts = [f"{made.samples} walls, seed {self.scatter.seed}"]
        if made.mu is not None:
            parts.append(f"mu {made.mu[0]:g} to {made.mu[1]:g}")
        if made.outline_noise:
            parts.append(f"outlines +- {self.unit.words(made.outline_noise)}")
        if made.placement_noise:
            parts.append(f"placement +- {self.unit.words(made.placement_noise)}")
        return ", ".join(parts)


def noise_unit(wall: GivenWall) -> Unit:
    """Return the unit of ``--outline-noise`` and ``--placement-noise``: px where there are any.

    They are those of the source image: a plan on outlines in metres has a model in metres, one on
    pixels has one in working px.
    """
    if wall.blocks is None:
        return Unit("px", 1.0 if wall.plan is None else wall.plan.working_scale)
    if wall.plan is None:
        return Unit("lengths of the block model")
    px_per_m = wall.plan.px_per_m if wall.plan.length_unit == "m" else None
    return Unit("px", 1.0 / (px_per_m or 1.0))
