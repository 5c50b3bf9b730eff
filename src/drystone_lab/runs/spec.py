"""One run: its stones, the settings that it replaces, all that a plan depends on."""

import hashlib
import json
from collections.abc import Mapping
from dataclasses import asdict, dataclass, replace
from importlib.metadata import version
from pathlib import Path
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from drystone.generate import GENERATORS
from drystone.io.images import decode
from drystone.io.published import published_file
from drystone.io.read_settings import ReadSettings
from drystone.io.read_stones import read_stones
from drystone.io.wall_image import read_wall_image
from drystone.model.settings import flat, nested
from drystone.model.stone import StoneSet
from drystone.model.wall import Labels
from drystone.planner.settings import PlannerSettings, method_settings

Scalar = bool | int | float | str
Changes = tuple[tuple[str, Scalar], ...]
"""Settings that an experiment replaces, as flat pairs that can be kept, compared and printed."""


def changes_of(settings: Mapping[str, Any]) -> Changes:
    """Return nested settings with their names in full, in order.

    >>> changes_of({"sampling": "full", "placement": {"beta": 0.5}})
    (('placement.beta', 0.5), ('sampling', 'full'))
    """
    return tuple(sorted((".".join(path), value) for path, value in flat(settings)))


def settings_of(changes: Changes) -> dict[str, Any]:
    """Return what :meth:`drystone.planner.settings.PlannerSettings.updated` takes.

    >>> settings_of((("placement.beta", 0.5), ("sampling", "full")))
    {'placement': {'beta': 0.5}, 'sampling': 'full'}
    """
    return nested((name.split("."), value) for name, value in changes)


def told(changes: Changes) -> str:
    """Return them for people.

    >>> told((("goal.F_AH", 3.6), ("goal.F_AV", 24.0)))
    'goal.F_AH = 3.6, goal.F_AV = 24.0'
    """
    return ", ".join(f"{name} = {value}" for name, value in changes)


SourceKind = Literal["published", "fourier", "polygon", "brick", "rubble"]


@dataclass(frozen=True, kw_only=True)
class StoneSource:
    """Stones by name: published ones, or what a generator makes from a seed."""

    kind: SourceKind  # Of the source
    name: str = ""  # Path in the folder of published data (``"almeida/PR.png"``), or of the file
    seed: int = 0
    settings: tuple[tuple[str, Scalar], ...] = ()

    def __str__(self) -> str:
        return self.name or f"{self.kind} {self.seed}"

    def is_there(self, data: Path | None) -> bool:
        """Return False when published stones are asked for and the folder has none of this name."""
        return self.kind != "published" or (data is not None and (data / self.name).exists())

    def check(self, data: Path | None) -> None:
        """Refuse other stones in the place of published ones."""
        if self.kind == "published" and data is not None:
            published_file(data, self.name)

    def stones(self, data: Path | None) -> StoneSet:
        """Return the stones."""
        if self.kind == "published":
            if data is None:
                raise FileNotFoundError(self.name)
            path, how = published_file(data, self.name), dict(self.settings)
            if "copies" in how:  # of a brick that fills its picture
                (one,) = read_stones(np.pad(_grey(path) > 0, 1))
                numbers = range(1, 1 + int(how["copies"]))
                return StoneSet(tuple(replace(one, id=number) for number in numbers))
            if "least_px" in how:
                return read_stones(self.labels(data))
            return read_stones(path, settings=ReadSettings(**how))  # type: ignore[arg-type]
        settings, make = GENERATORS[self.kind]
        return make(settings(**dict(self.settings)), np.random.default_rng(self.seed))

    def labels(self, data: Path) -> Labels:
        """Return a published picture as a wall; ids of less than `least_px` px are none."""
        path, least = published_file(data, self.name), dict(self.settings).get("least_px")
        if least is None:
            return read_wall_image(path)
        grey = _grey(path)
        return np.where(np.bincount(grey.ravel())[grey] < int(least), 0, grey).astype(np.uint32)


def _grey(path: Path) -> NDArray[Any]:
    return decode(path.read_bytes(), 10**7).values[..., 0]


def published(name: str, **settings: Scalar) -> StoneSource:
    """Return the source of a published file or folder of masks, read with some settings.

    With `copies` there are so many of its single stone.

    >>> published("almeida/PR.png").is_there(None)
    False
    """
    return StoneSource(kind="published", name=name, settings=tuple(settings.items()))


def generated(kind: SourceKind, seed: int, **settings: Scalar) -> StoneSource:
    """Return the source of stones that a generator makes.

    >>> len(generated("brick", 1, count=6).stones(None))
    6
    """
    return StoneSource(kind=kind, seed=seed, settings=tuple(sorted(settings.items())))


STRIPS = "spyrrow"
"""Method of runs that are no walls (:mod:`drystone_lab.packing`)."""


@dataclass(frozen=True, kw_only=True)
class RunSpec:
    """A wall to be planned.

    >>> spec = RunSpec(source=generated("brick", 1, count=6), width=60, height=20, scale=1.0,
    ...                changes=(("placement.beta", 0.5),))
    >>> spec.settings().placement.beta
    0.5
    """

    source: StoneSource
    width: float = 0.0  # width, height: Of the wall, source px; 0 for those of the source image
    height: float = 0.0
    scale: float = 1.0  # Working resolution over source resolution
    method: str = "paper"
    # Settings that replace the method's, by names such as ``"placement.beta"`` (docs/settings.md)
    changes: Changes = ()
    seed: int = 0

    def size(self, stones: StoneSet) -> tuple[float, float]:
        """Return the width and height of the wall, source px."""
        source = stones.source
        return self.width or float(source.width_px), self.height or float(source.height_px)

    def settings(self) -> PlannerSettings:
        """Return the settings of the planner."""
        return method_settings(self.method).updated(settings_of(self.changes))

    def as_dict(self) -> dict[str, Any]:
        """Return what JSON writes."""
        about = asdict(self) | {"changes": dict(self.changes)}
        about["source"]["settings"] = dict(self.source.settings)
        # Equal runs are equal text.
        return about | {name: float(about[name]) for name in ("width", "height", "scale")}

    def __str__(self) -> str:
        size = f"{self.width:g} x {self.height:g} px" if self.width and self.height else "own size"
        method = ", ".join([self.method, told(self.changes)] if self.changes else [self.method])
        return f"{self.source}, {size} at {self.scale:g}, {method}, seed {self.seed}"

    @property
    def key(self) -> str:
        """Name under which the outcome is kept: equal for equal runs of one version.

        A change to what the method has anyway is no change.
        """
        has = () if self.method == STRIPS else changes_of(method_settings(self.method).as_dict())
        changes = {name: value for name, value in self.changes if (name, value) not in has}
        about = self.as_dict() | {"changes": changes, "version": version("drystone")}
        return hashlib.sha256(json.dumps(about, sort_keys=True).encode()).hexdigest()[:24]
