"""Where the stones of a run come from, in words that can be written down and read back."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from types import MappingProxyType
from typing import Any, Literal

import numpy as np
from numpy.random import Generator

from drystone.generate.brick import BrickSettings, brick_stones
from drystone.generate.fourier import FourierSettings, fourier_stones
from drystone.generate.polygon import PolygonSettings, polygon_stones
from drystone.generate.rubble import RubbleSettings, rubble_stones
from drystone.io.read_stones import read_stones
from drystone.model.stone import StoneSet

Kind = Literal["published", "file", "fourier", "polygon", "brick", "rubble"]
Scalar = bool | int | float | str

GENERATORS: Mapping[str, tuple[type, Callable[[Any, Generator], StoneSet]]] = MappingProxyType(
    {
        "fourier": (FourierSettings, fourier_stones),
        "polygon": (PolygonSettings, polygon_stones),
        "brick": (BrickSettings, brick_stones),
        "rubble": (RubbleSettings, rubble_stones),
    }
)
"""Settings of each generator, and what makes stones from them."""


@dataclass(frozen=True, kw_only=True)
class StoneSource:
    """Stones by name: published ones, a file, or what a generator makes from a seed.

    Parameters
    ----------
    kind : {"published", "file", "fourier", "polygon", "brick", "rubble"}
        Of the source.
    name : str
        Path in the folder of published data (``"almeida/PR.png"``), or of the file.
    seed : int
        Of the generator.
    settings : tuple of (str, value)
        Of the generator; see :func:`generated`.
    """

    kind: Kind
    name: str = ""
    seed: int = 0
    settings: tuple[tuple[str, Scalar], ...] = ()

    def is_there(self, data: Path | None) -> bool:
        """Return False when published stones are asked for and the folder has none of this name."""
        return self.kind != "published" or (data is not None and (data / self.name).is_file())

    def stones(self, data: Path | None) -> StoneSet:
        """Return the stones.

        Parameters
        ----------
        data : Path or None
            Folder of the published data.

        Raises
        ------
        FileNotFoundError
            Published data that are not there (:meth:`is_there`).
        """
        if self.kind == "published":
            if data is None:
                raise FileNotFoundError(self.name)
            return read_stones(data / self.name)
        if self.kind == "file":
            return read_stones(Path(self.name))
        settings, make = GENERATORS[self.kind]
        return make(settings(**dict(self.settings)), np.random.default_rng(self.seed))

    def as_dict(self) -> dict[str, Any]:
        """Return what JSON writes."""
        return {
            "kind": self.kind, "name": self.name, "seed": self.seed,
            "settings": dict(self.settings),
        }  # fmt: skip


def published(name: str) -> StoneSource:
    """Return the source of a published set.

    Examples
    --------
    >>> published("almeida/PR.png").is_there(None)
    False
    """
    return StoneSource(kind="published", name=name)


def generated(kind: Kind, seed: int, **settings: Scalar) -> StoneSource:
    """Return the source of stones that a generator makes.

    Examples
    --------
    >>> len(generated("brick", 1, count=6).stones(None))
    6
    """
    return StoneSource(kind=kind, seed=seed, settings=tuple(sorted(settings.items())))
