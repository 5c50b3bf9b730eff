"""One run: everything that a plan depends on, and nothing else."""

import hashlib
import json
from dataclasses import dataclass
from importlib.metadata import version
from typing import Any

from drystone.planner.settings import PlannerSettings, method_settings
from drystone_lab.runs.changes import Changes, nested
from drystone_lab.runs.source import StoneSource

STRIPS = "spyrrow"
"""Method of runs that are no walls (:mod:`drystone_lab.runs.strips`)."""


@dataclass(frozen=True, kw_only=True)
class RunSpec:
    """A wall to be planned.

    Parameters
    ----------
    source : StoneSource
        Of the stones.
    width, height : float
        Of the wall, source px; 0 for those of the source image.
    scale : float
        Working resolution over source resolution.
    method : str
        Of the planner, or :data:`STRIPS`.
    changes : tuple of (str, value)
        Settings that replace the method's, by names such as ``"placement.beta"``
        (docs/settings.md).
    seed : int
        Of the plan.

    Examples
    --------
    >>> from drystone_lab.runs.source import generated
    >>> spec = RunSpec(source=generated("brick", 1, count=6), width=60, height=20, scale=1.0,
    ...                changes=(("placement.beta", 0.5),))
    >>> spec.settings().placement.beta
    0.5
    """

    source: StoneSource
    width: float = 0.0
    height: float = 0.0
    scale: float = 1.0
    method: str = "paper"
    changes: Changes = ()
    seed: int = 0

    def settings(self) -> PlannerSettings:
        """Return the settings of the planner."""
        return method_settings(self.method).updated(nested(self.changes))

    def as_dict(self) -> dict[str, Any]:
        """Return what JSON writes."""
        return {
            "source": self.source.as_dict(), "width": float(self.width),
            "height": float(self.height), "scale": float(self.scale), "method": self.method,
            "changes": dict(self.changes), "seed": self.seed,
        }  # fmt: skip

    def __str__(self) -> str:
        """Return a line for messages."""
        size = f"{self.width:g} x {self.height:g} px" if self.width and self.height else "own size"
        changes = "".join(f", {name} = {value}" for name, value in self.changes)
        return f"{self.source}, {size} at {self.scale:g}, {self.method}{changes}, seed {self.seed}"

    @property
    def key(self) -> str:
        """Name under which the outcome is kept: equal for equal runs of one version."""
        text = json.dumps(self.as_dict() | {"version": version("drystone")}, sort_keys=True)
        return hashlib.sha256(text.encode()).hexdigest()[:24]
