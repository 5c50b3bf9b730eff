"""Walls to learn on: generated stones in the order in which they arrive, and a site for them."""

import types
from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np
from numpy.random import Generator

from drystone.errors import UsageError
from drystone.generate import GENERATORS
from drystone.model.site import Site
from drystone.model.stone import Stone, StoneSet


@dataclass(frozen=True, kw_only=True)
class DrawSettings:
    """What walls are drawn."""

    # Generators, all with the same chance: ``"fourier"``, ``"polygon"``, ``"brick"``,
    # ``"rubble"``
    kinds: tuple[str, ...] = ("fourier", "polygon", "brick", "rubble")
    stones: int = 20  # How many stones arrive, at least 3
    # Square root of the mean area of a stone, at least 8.  Images are not reduced: working
    # and source px are the same
    size_px: float = 18.0
    surplus: float = 1.2  # Area of all stones over the area of the wall, at least .2
    aspect: float = 2.5  # Width of the wall over its height, positive

    def __post_init__(self) -> None:
        unknown = sorted(set(self.kinds) - set(KINDS))
        if unknown or not self.kinds:
            raise _refused(f"there is no generator {unknown}", f"Known: {', '.join(KINDS)}.")
        if self.stones < 3 or not self.size_px >= 8:
            raise _refused("walls need 3 stones or more, of 8 px or more", "Give more of them.")
        if not self.surplus >= 0.2 or not self.aspect > 0:
            raise _refused("surplus must be 0.2 or more, aspect positive", "Give larger ones.")


def draw_wall(settings: DrawSettings, rng: Generator) -> tuple[StoneSet, Site]:
    """Draw stones, numbered from 1 in the order in which they arrive, and the site of their wall.

    >>> stones, site = draw_wall(DrawSettings(kinds=("brick",)), np.random.default_rng(1))
    >>> len(stones), site
    (20, Site(width_px=118, height_px=47, scale=1.0, px_per_m=None))
    """
    kind = settings.kinds[int(rng.integers(len(settings.kinds)))]
    kind_settings, make = GENERATORS[kind]
    numbers = {"count": settings.stones} | KINDS[kind](settings, rng)
    stones = in_order(make(kind_settings(**numbers), rng), rng)
    area = stones.total_area_px / settings.surplus
    height = max(1, round((area / settings.aspect) ** 0.5))
    return stones, Site(max(1, round(settings.aspect * height)), height)


def in_order(stones: StoneSet, rng: Generator) -> StoneSet:
    """Return the same stones numbered from 1 in a random order."""
    order = rng.permutation(len(stones)).tolist()
    return StoneSet(
        tuple(Stone(k, stones.stones[old].mask) for k, old in enumerate(order, 1)),
        stones.source,
        stones.notices,
    )


def _fourier(settings: DrawSettings, rng: Generator) -> dict[str, float]:
    """Round to elongated, the largest almost twice as large as the smallest."""
    radius = settings.size_px / np.pi**0.5
    return {
        "smallest_radius_px": 0.7 * radius, "largest_radius_px": 1.25 * radius,
        "D2": float(rng.uniform(0.0, 0.2)),
    }  # fmt: skip


def _polygon(settings: DrawSettings, rng: Generator) -> dict[str, float]:
    """Bricks whose corners are moved a little or much."""
    return {
        "width_px": 1.2 * settings.size_px, "height_px": settings.size_px / 1.2,
        "noise": float(rng.uniform(0.1, 0.4)),
    }  # fmt: skip


def _brick(settings: DrawSettings, rng: Generator) -> dict[str, float]:
    """Bricks, a third of them halves."""
    halves = settings.stones // 3
    # The mean area is that of the set, halves among them.
    share = 1.0 - 0.5 * halves / settings.stones
    aspect = float(rng.uniform(1.6, 3.0))
    height = max(2, round(settings.size_px / (share * aspect) ** 0.5))
    count = settings.stones - halves
    return {"count": count, "halves": halves, "height_px": height, "aspect": aspect}


def _rubble(settings: DrawSettings, _: Generator) -> dict[str, float]:
    """Stones of a few course heights."""
    ratio = 0.9
    height = settings.size_px * (settings.stones / ratio / settings.aspect) ** 0.5
    return {
        "width_px": settings.aspect * height, "height_px": height, "area_ratio": ratio,
        "courses": min(3, settings.stones),
    }  # fmt: skip


KINDS: Mapping[str, Callable[[DrawSettings, Generator], dict[str, float]]] = types.MappingProxyType(
    {"fourier": _fourier, "polygon": _polygon, "brick": _brick, "rubble": _rubble}
)
"""Settings of the generator of each kind, beside the number of stones."""


def _refused(what: str, cure: str) -> UsageError:
    return UsageError("E123", f"{what}.", where="DrawSettings", cure=cure)
