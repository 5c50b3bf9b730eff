"""The scatter of the load multiplier in `drystone analyse`."""

import argparse
from collections.abc import Iterator
from concurrent.futures import Executor, ThreadPoolExecutor
from contextlib import contextmanager, nullcontext
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from drystone.cli.output import prepare_files
from drystone.cli.progress import counting_bar
from drystone.drawing.words.analysis import ModelledWall
from drystone.errors import UsageError
from drystone.io.walls import GivenWall
from drystone.statics.result import LimitStatus
from drystone.statics.scatter.scatter import Quantiles, Scatter, scatter
from drystone.statics.scatter.shaking import ScatterSettings

SAMPLES = 200


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


def wants_scatter(arguments: argparse.Namespace) -> bool:
    """Whether an option of the scatter was given.

    Raises
    ------
    UsageError
        E138 when there are samples to take, but nothing by which they would differ.
    """
    is_varied = arguments.mu is not None and arguments.mu[0] < arguments.mu[1]
    varied: bool = is_varied or arguments.outline_noise > 0 or arguments.placement_noise > 0
    if arguments.scatter is not None and not varied:
        raise UsageError(
            "E138",
            "all samples would be the same wall.",
            where="--scatter",
            cure="Say what is not known: --mu LOW:HIGH, --outline-noise or --placement-noise.",
        )
    return varied


def scatter_of(
    wall: ModelledWall, arguments: argparse.Namespace, unit: Unit, folder: Path | None
) -> ScatterCard:
    """Shake the wall and analyse it each time; draw the distribution into the folder."""
    settings = ScatterSettings(
        samples=SAMPLES if arguments.scatter is None else arguments.scatter,
        mu=arguments.mu,
        outline_noise=arguments.outline_noise * unit.lengths,
        placement_noise=arguments.placement_noise * unit.lengths,
    )
    if folder is not None:
        prepare_files([folder / "scatter.png"], overwrite=arguments.overwrite)
    bar = counting_bar("walls", settings.samples, quiet=arguments.json)
    with bar as on_sample, _workers(arguments.jobs) as executor:
        found = scatter(
            wall.model, settings, seed=arguments.seed, executor=executor, on_sample=on_sample
        )
    if folder is not None:
        from drystone.drawing import plot_scatter, save  # noqa: PLC0415 - slow import

        save(plot_scatter(found).figure, folder / "scatter.png")
    return ScatterCard(found, unit)


@contextmanager
def _workers(jobs: int) -> Iterator[Executor | None]:
    with ThreadPoolExecutor(jobs) if jobs > 1 else nullcontext() as executor:
        yield executor
