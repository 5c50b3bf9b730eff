"""What `drystone rehearse` found out about a plan."""

from collections import Counter
from collections.abc import Sequence
from dataclasses import asdict, dataclass
from functools import cached_property
from typing import Any

import numpy as np

from drystone.model.builder import BuilderErrors
from drystone.model.plan import Plan
from drystone.search.closed_loop import ClosedRun
from drystone.search.rehearsal import Groups, RehearsalRun

NAMED = 5
"""So many stones at which falls begin are named in the table."""


@dataclass(frozen=True, eq=False)
class Rehearsed:
    """Walls that were built of a plan with errors; lengths in source px."""

    plan: Plan
    groups: Groups
    errors: BuilderErrors
    runs: tuple[RehearsalRun, ...]
    planned: RehearsalRun  # built without errors
    engine: bool = False  # whether a rigid-body engine was the judge

    @property
    def whole(self) -> int:
        """In how many runs nothing fell."""
        return sum(run.first_fall is None for run in self.runs)

    @property
    def verdict(self) -> str:
        """How many runs went well, in words."""
        fell = self.planned.first_fall
        if fell is not None:
            return f"stone {fell} falls even where it is planned"
        return f"whole in {self.whole} of {len(self.runs)} rehearsals"

    @cached_property
    def again(self) -> float | None:
        """How often a stone fell on the way, mean of the runs; None in open loop."""
        counts = [run.again for run in self.runs if isinstance(run, ClosedRun)]
        return sum(counts) / len(counts) if counts else None

    @cached_property
    def risk(self) -> dict[int, float]:
        """Share of the runs in which a stone fell, by its id."""
        fallen = Counter(end.stone for run in self.runs for end in run.stones if end.fallen)
        return {group[0][0]: fallen[group[0][0]] / len(self.runs) for group in self.groups}

    @cached_property
    def first(self) -> list[tuple[int, int]]:
        """Stones at which falls begin, and in how many runs: the most frequent first."""
        found = Counter(run.first_fall for run in self.runs if run.first_fall is not None)
        return sorted(found.items(), key=lambda one: (-one[1], one[0]))

    def _quantiles(self, values: Sequence[float]) -> dict[str, float] | None:
        if not values:
            return None
        low, median, high = np.quantile(values, (0.05, 0.5, 0.95)).round(6).tolist()
        return {"low": low, "median": median, "high": high}

    def report(self) -> dict[str, Any]:
        """Return what there is to say as JSON (docs/plan-format.md)."""
        stayed = [end for run in self.runs for end in run.stones if not end.fallen]
        steps = {step.stone: step.step for step in self.plan.stone_steps}
        away = [end.share or 0.0 for end in stayed]
        turns = [abs(end.turn_deg or 0) for end in stayed]
        return {
            "judge": "engine" if self.engine else "settling",
            "loop": "open" if self.again is None else "closed",
            "put_down_again": self.again,
            "errors": asdict(self.errors),
            "runs": len(self.runs),
            "whole": self.whole,
            "falls_as_planned": self.planned.first_fall,
            "fallen_share": sum(self.risk.values()) / len(self.risk),
            "first_falls": [
                {"stone": stone, "step": steps[stone], "runs": count} for stone, count in self.first
            ],
            "stones": [
                {"stone": stone, "step": steps[stone], "risk": risk}
                for stone, risk in self.risk.items()
            ],
            "share": self._quantiles(away),
            "turn_deg": self._quantiles(turns),
            "tilt": self._quantiles([run.tilt for run in self.runs if run.tilt is not None]),
        }

    def rows(self) -> list[tuple[str, str]]:
        """Return names and values, one a line."""
        told, errors = self.report(), self.errors
        per_px = 1.0 if not self.plan.px_per_m else 1e3 / self.plan.px_per_m
        unit = "mm" if self.plan.px_per_m else "px"
        put = f"{errors.placement * per_px:.3g} {unit}, {errors.angle_deg:.3g}°"
        rows = [
            ("errors (one sigma)", f"{put}; outlines {errors.outline * per_px:.3g} {unit}"),
            ("judge", "a rigid-body engine" if self.engine else "exact settling"),
            ("loop", "open" if self.again is None else "closed: planned again after every stone"),
            ("as planned", "stands" if self.planned.first_fall is None else self.verdict),
            ("whole", f"{self.whole} of {len(self.runs)}"),
        ]
        fallen = f"{told['fallen_share']:.1%}"
        if self.again is None:
            rows.append(("stones fallen", fallen))
        else:
            rows.append(("stones that found no place", fallen))
            rows.append(("fell on the way", f"{self.again:.1f} a wall"))
        for one in told["first_falls"][:NAMED]:
            words = f"stone {one['stone']} (step {one['step']}), {one['runs']} of {len(self.runs)}"
            rows.append(("falls begin with", words))
        for name, key, form in (
            ("off its place, of its size", "share", "{:.1%}"), ("turned", "turn_deg", "{:.1f}°"),
            ("tilt over mu, whole walls", "tilt", "{:.2f}"),
        ):  # fmt: skip
            if (found := told[key]) is not None:
                low, median, high = map(form.format, found.values())
                rows.append((name, f"median {median}, 90% within {low} to {high}"))
        return rows
