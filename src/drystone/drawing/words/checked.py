"""Everything that `drystone check` and `drystone rehearse` found out about a plan."""

from collections import Counter
from collections.abc import Sequence
from dataclasses import asdict, dataclass
from functools import cached_property
from typing import Any

import numpy as np

from drystone.drawing.words.content import number
from drystone.errors import counted
from drystone.kernels.polygons import Points
from drystone.model.builder import BuilderErrors
from drystone.model.outlines import Outlined
from drystone.model.plan import Plan, Point
from drystone.model.steps import Problem
from drystone.model.stone import StoneSet
from drystone.physics.building import BlockMove, BuildUp
from drystone.physics.scatter import TiltResult
from drystone.search.closed_loop import ClosedRun
from drystone.search.rehearsal import Groups, RehearsalRun
from drystone.statics.model import Direction
from drystone.verify.check import CheckReport
from drystone.verify.claims import check_engine, claimed_alpha

PICTURE = "check.png"  # beside a plan of which something fails
NOT_BUILT = "not built there, as a step of the plan places nothing"

NOTEWORTHY_PX = 0.01  # overlaps below this, in source px, round to nothing and are not spoken of


@dataclass(frozen=True, eq=False)
class PhysicsCard:
    """What the engine says of a plan, beside what the plan claims.

    `tilts` are to the left and to the right; None for a wall that fell or did not come to rest.
    """

    plan: Plan
    checked: CheckReport
    built: BuildUp
    tilts: tuple[TiltResult, TiltResult] | None

    @property
    def first_fall(self) -> int | None:
        """Number of the step after which the first block had fallen, its wedges placed."""
        return None if self.built.first_fall is None else self._step(self.built.first_fall)

    def rows(self) -> list[tuple[str, str]]:
        """Return names and values, one a line."""
        rows = [("in the engine", self._outcome())]
        for move in self.built.moves:
            if move.fell:
                name, turned = self._name(move.id), f"turned {move.turn_deg:.1f} degrees"
                size = "its stone's size" if name.startswith("wedge") else "its size"
                moved = f"moved {move.move_px:.1f} source px, {move.share:.0%} of {size}"
                rows.append(("  falls", f"{name}: {moved}, {turned}"))
        deepest = max(self.built.moves, key=lambda move: move.overlap_px, default=None)
        if deepest is not None and deepest.overlap_px >= NOTEWORTHY_PX:
            said = f"up to {deepest.overlap_px:.2f} source px deep ({self._name(deepest.id)})"
            overlaps = self.checked.overlap_depth >= NOTEWORTHY_PX
            why = "what overlaps cannot stay where it is" if overlaps else "others had moved there"
            rows.append(("  pushed apart", f"{said}: {why}"))
        if self.built.restless:
            steps = ", ".join(str(self._step(group)) for group in self.built.restless)
            of = f"step{'s' if len(self.built.restless) > 1 else ''} {steps}"
            rows.append(("  restless", f"blocks still moved when the time of {of} was up"))
        left, right = self._tilted("left"), self._tilted("right")
        return [*rows, ("  tilted to the left", left), ("  tilted to the right", right)]

    def report(self) -> dict[str, Any]:
        """Return the same as JSON."""
        furthest, moves = self._furthest(), self.built.moves
        return {
            "fallen": list(self.built.fallen),
            "first_fall": self.first_fall,
            "largest_move": furthest.move_px if furthest else 0.0,
            "largest_move_at": furthest.id if furthest else None,
            "largest_share": max((move.share for move in moves), default=0.0),
            "largest_turn_deg": max((move.turn_deg for move in moves), default=0),
            "largest_drift": max(self.built.found_moved_px, default=0.0),
            "overlap_depth": max((move.overlap_px for move in moves), default=0.0),
            "restless": [self._step(group) for group in self.built.restless],
            "tilt_left": self._alpha("left"),
            "tilt_right": self._alpha("right"),
            "alpha_left": claimed_alpha(self.plan, "left"),
            "alpha_right": claimed_alpha(self.plan, "right"),
            "moves": [
                {"id": m.id, "move": m.move_px, "share": m.share, "turn_deg": m.turn_deg,
                 "overlap": m.overlap_px, "fell": m.fell}
                for m in moves
            ],
        }  # fmt: skip

    def _outcome(self) -> str:
        furthest = self._furthest()
        if furthest is None:
            return "nothing was built"
        if self.built.stands:
            said = f"{self._name(furthest.id)}, {furthest.share:.1%} of its size"
            return f"stands; nothing moves by more than {furthest.move_px:.2f} source px ({said})"
        fallen, all_ = len(self.built.fallen), len(self.built.moves)
        return f"{fallen} of {all_} blocks fall, the first after step {self.first_fall}"

    def _tilted(self, name: Direction) -> str:
        said = f"the plan claims {number(claimed_alpha(self.plan, name))}"
        if self.tilts is None:
            return f"not tilted, as it does not stand at rest; {said}"
        if self.tilts[name == "right"].fell_at_rest:
            return f"does not come to rest again, so it is not tilted; {said}"
        found = self._alpha(name)
        fell = "never falls" if found is None else f"falls at alpha = {found:.3f}"
        return f"{fell}; {said}"

    def _alpha(self, name: str) -> float | None:
        return None if self.tilts is None else self.tilts[name == "right"].alpha

    def _name(self, block: int) -> str:
        wedge = block in {step.id for step in self.plan.wedge_steps}
        return f"{'wedge' if wedge else 'stone'} {block}"

    def _step(self, group: int) -> int:
        return self.plan.stone_steps[group - 1].step

    def _furthest(self) -> BlockMove | None:
        return max(self.built.moves, key=lambda move: move.move_px, default=None)


@dataclass(frozen=True, eq=False)
class Checked:
    """A plan and what was found, with the polygons of its stones and wedges.

    `physics` is None when the engine was not asked, or the wall cannot be built there.
    """

    plan: Plan
    stones: StoneSet
    report: CheckReport
    groups: Sequence[Sequence[Outlined]]
    asked_physics: bool = False
    physics: PhysicsCard | None = None

    @property
    def planned(self) -> dict[int, Points]:
        """Corners of what was planned, by id; source px, wall frame."""
        return {block: corners for group in self.groups for block, corners in group}

    @property
    def size(self) -> Point:
        """Width and height of the wall that is to be built, source px."""
        source_px = self.plan.px_per_m or 1.0
        return self.plan.width * source_px, self.plan.height * source_px

    @property
    def falls(self) -> bool:
        """Something falls in the engine."""
        return self.physics is not None and not self.physics.built.stands

    @property
    def problems(self) -> list[Problem]:
        """What does not hold by the plan, then what the engine contradicts."""
        found, engine = self.physics, list[Problem]()
        if found is not None:
            engine = check_engine(self.plan, found.built, found.tilts)
        return [*self.report.problems, *engine]

    @property
    def ok(self) -> bool:
        """The plan holds and, when that was asked, the engine does not contradict it."""
        return not self.problems

    @property
    def verdict(self) -> str:
        """In words."""
        if not self.report.ok:
            return "is not valid"
        if self.falls:
            return "is valid, but the wall falls in the engine"
        if not self.ok:
            return "is valid, but the engine contradicts it"
        metrics = self.report.metrics
        stands = metrics is not None and metrics.F_LR is not None
        if stands and self.plan.metrics.F_LR_coulomb == 0.0:
            return "is valid, but let go the wall can fall"
        return "is valid, and the wall stands" if stands else "is valid"

    def rows(self) -> list[tuple[str, str]]:
        """Return names and values, one a line."""
        plan, report = self.plan, self.report
        placed = f"{len(plan.stone_steps)} placed, " + counted(len(plan.wedge_steps), "wedge")
        buried = ", ".join(map(str, report.buried))
        rows = [
            ("stones", placed),
            ("overlap", f"{report.overlap_depth:.2f} source px deep by the outlines"),
            ("area", f"pixel areas agree to {100 * report.area_error:.1f} %"),
            ("buried", f"{buried}: cannot be lowered in from above" if buried else "none"),
        ]
        if self.asked_physics:
            found = self.physics
            rows += [("in the engine", NOT_BUILT)] if found is None else found.rows()
        rows += [("note", note) for note in report.notes]
        return rows + [("problem", str(problem)) for problem in self.problems]

    def as_dict(self) -> dict[str, Any]:
        """Return the same as JSON."""
        problems = [asdict(problem) for problem in self.problems]
        found = {**self.report.as_dict(), "ok": self.ok, "problems": problems}
        if self.asked_physics:
            found["physics"] = None if self.physics is None else self.physics.report()
        return found


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
        begun = Counter(run.begins for run in self.runs if run.begins is not None)
        first = sorted(begun.items(), key=lambda one: (-one[1], one[0]))  # the most frequent first
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
                {"stone": stone, "step": steps[stone], "runs": count} for stone, count in first
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
