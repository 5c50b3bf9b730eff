"""Walls to learn on: generated stones in the order in which they arrive, and a site for them."""

from dataclasses import dataclass

import numpy as np
from numpy.random import Generator

from drystone.errors import UsageError
from drystone.generate import GENERATORS
from drystone.model.site import Site
from drystone.model.stone import Stone, StoneSet

KINDS = ("fourier", "polygon", "brick", "rubble")


@dataclass(frozen=True, kw_only=True)
class DrawSettings:
    """What walls are drawn."""

    kinds: tuple[str, ...] = KINDS  # Generators, all with the same chance
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
    stones = in_order(make(kind_settings(**_numbers(kind, settings, rng)), rng), rng)
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


def _numbers(kind: str, settings: DrawSettings, rng: Generator) -> dict[str, float]:
    size, count = settings.size_px, settings.stones
    if kind == "fourier":  # round to elongated, the largest almost twice as large as the smallest
        radius = size / np.pi**0.5
        numbers = {"smallest_radius_px": 0.7 * radius, "largest_radius_px": 1.25 * radius}
        return {"count": count, **numbers, "D2": float(rng.uniform(0.0, 0.2))}
    if kind == "polygon":  # bricks whose corners are moved a little or much
        sides = {"width_px": 1.2 * size, "height_px": size / 1.2}
        return {"count": count, **sides, "noise": float(rng.uniform(0.1, 0.4))}
    if kind == "brick":  # a third of them halves, which the mean area counts too
        halves = count // 3
        aspect = float(rng.uniform(1.6, 3.0))
        height = max(2, round(size / ((1.0 - 0.5 * halves / count) * aspect) ** 0.5))
        return {"count": count - halves, "halves": halves, "height_px": height, "aspect": aspect}
    ratio = 0.9  # rubble of a few course heights
    height_px = size * (count / ratio / settings.aspect) ** 0.5
    sides = {"width_px": settings.aspect * height_px, "height_px": height_px}
    return {"count": count, **sides, "area_ratio": ratio, "courses": min(3, count)}


def _refused(what: str, cure: str) -> UsageError:
    return UsageError("E123", f"{what}.", where="DrawSettings", cure=cure)
