"""Where the stones of a run come from, in words that can be written down and read back."""

from dataclasses import dataclass
from pathlib import Path
from typing import Any, Literal

import numpy as np

from drystone.errors import InputError
from drystone.generate import GENERATORS
from drystone.io.published import published_file
from drystone.io.read_stones import read_stones
from drystone.model.stone import StoneSet

Kind = Literal["published", "file", "fourier", "polygon", "brick", "rubble"]
Scalar = bool | int | float | str


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
    sha256 : str
        Of the file, see :func:`from_file`; empty if it may be any.
    """

    kind: Kind
    name: str = ""
    seed: int = 0
    settings: tuple[tuple[str, Scalar], ...] = ()
    sha256: str = ""

    def __str__(self) -> str:
        """Return a few words for messages."""
        return self.name or f"{self.kind} {self.seed}"

    def is_there(self, data: Path | None) -> bool:
        """Return False when published stones are asked for and the folder has none of this name."""
        return self.kind != "published" or (data is not None and (data / self.name).is_file())

    def check(self, data: Path | None) -> None:
        """Refuse other stones in the place of published ones.

        Raises
        ------
        InputError
            E160: the file in the folder has other contents than the one that was released.
        """
        if self.kind == "published" and data is not None:
            published_file(data, self.name)

    def stones(self, data: Path | None) -> StoneSet:
        """Return the stones.

        Raises
        ------
        FileNotFoundError
            Published data that are not there (:meth:`is_there`).
        InputError
            E100 ... E111, see :func:`drystone.read_stones`; E100 also for a file that is no longer
            the one that was meant; E160 for another file in the place of a published one.
        """
        if self.kind == "published":
            if data is None:
                raise FileNotFoundError(self.name)
            return read_stones(published_file(data, self.name))
        if self.kind == "file":
            return _same(read_stones(Path(self.name)), self)
        settings, make = GENERATORS[self.kind]
        return make(settings(**dict(self.settings)), np.random.default_rng(self.seed))

    def as_dict(self) -> dict[str, Any]:
        """Return what JSON writes."""
        return {
            "kind": self.kind, "name": self.name, "seed": self.seed,
            "settings": dict(self.settings), "sha256": self.sha256,
        }  # fmt: skip


def _same(stones: StoneSet, source: StoneSource) -> StoneSet:
    """Refuse a file of other contents than the source's."""
    if source.sha256 and stones.source.sha256 != source.sha256:
        raise InputError(
            "E100",
            "the file was changed since its runs were asked for.",
            where=source.name,
            cure="Give the command again.",
        )
    return stones


def published(name: str) -> StoneSource:
    """Return the source of a published set.

    Examples
    --------
    >>> published("almeida/PR.png").is_there(None)
    False
    """
    return StoneSource(kind="published", name=name)


def from_file(path: Path) -> StoneSource:
    """Return the source of stones in a file or a folder of masks, as it is now.

    Runs of it are found again as long as its contents are the same.

    Raises
    ------
    InputError
        E100 ... E111, see :func:`drystone.read_stones`.
    """
    return StoneSource(kind="file", name=str(path), sha256=read_stones(path).source.sha256)


def generated(kind: Kind, seed: int, **settings: Scalar) -> StoneSource:
    """Return the source of stones that a generator makes.

    Examples
    --------
    >>> len(generated("brick", 1, count=6).stones(None))
    6
    """
    return StoneSource(kind=kind, seed=seed, settings=tuple(sorted(settings.items())))
