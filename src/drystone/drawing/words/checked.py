"""Everything that `drystone check` found out about a plan."""

from collections.abc import Sequence
from dataclasses import asdict, dataclass
from typing import Any

from drystone.drawing.words.content import number
from drystone.errors import counted
from drystone.kernels.polygons import Points
from drystone.model.plan import Plan, PlanMetrics, Point
from drystone.model.stone import StoneSet
from drystone.physics.building import BlockMove, BuildUp
from drystone.physics.scatter import TiltResult
from drystone.verify.engine import check_engine
from drystone.verify.outlines import PolygonGroup
from drystone.verify.report import CheckReport, Problem

PICTURE = "check.png"  # beside a plan of which something fails
NOT_BUILT = "not built there, as a step of the plan places nothing"

NOTEWORTHY_PX = 0.01  # overlaps below this, in source px, round to nothing and are not spoken of


@dataclass(frozen=True, eq=False)
class PhysicsCard:
    """What the engine says of a plan, beside the metrics of its limit analysis.

    `tilts` are to the left and to the right; None for a wall that fell or did not come to rest.
    `overlap_px` is how deep outlines overlap by the plan itself.
    """

    plan: Plan
    built: BuildUp
    tilts: tuple[TiltResult, TiltResult] | None
    metrics: PlanMetrics | None
    overlap_px: float = 0.0

    @property
    def problems(self) -> list[Problem]:
        """What contradicts the plan."""
        return check_engine(self.plan, self.built, self.tilts)

    @property
    def first_fall(self) -> int | None:
        """Number of the step after which the first block had fallen, its wedges placed."""
        return None if self.built.first_fall is None else self._step(self.built.first_fall)

    def rows(self) -> list[tuple[str, str]]:
        """Return names and values, one a line."""
        rows = [("in the engine", self._outcome())]
        rows += [("  falls", self._words(move)) for move in self.built.moves if move.fell]
        deepest = max(self.built.moves, key=lambda move: move.overlap_px, default=None)
        if deepest is not None and deepest.overlap_px >= NOTEWORTHY_PX:
            said = f"up to {deepest.overlap_px:.2f} source px deep ({self._name(deepest.id)})"
            overlaps = self.overlap_px >= NOTEWORTHY_PX
            why = "what overlaps cannot stay where it is" if overlaps else "others had moved there"
            rows.append(("  pushed apart", f"{said}: {why}"))
        if self.built.restless:
            steps = ", ".join(str(self._step(group)) for group in self.built.restless)
            of = f"step{'s' if len(self.built.restless) > 1 else ''} {steps}"
            rows.append(("  restless", f"blocks still moved when the time of {of} was up"))
        for name in ("left", "right"):
            rows.append((f"  tilted to the {name}", self._tilted(name)))
        return rows

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
            "alpha_left": self.metrics.alpha_left if self.metrics else None,
            "alpha_right": self.metrics.alpha_right if self.metrics else None,
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

    def _tilted(self, name: str) -> str:
        predicted = None
        if self.metrics is not None:
            predicted = self.metrics.alpha_left if name == "left" else self.metrics.alpha_right
        said = f"limit analysis {number(predicted)}"
        if self.tilts is None:
            return f"not tilted, as it does not stand at rest; {said}"
        if self.tilts[name == "right"].fell_at_rest:
            return f"does not come to rest again, so it is not tilted; {said}"
        found = self._alpha(name)
        fell = "never falls" if found is None else f"falls at alpha = {found:.3f}"
        return f"{fell}; {said}"

    def _alpha(self, name: str) -> float | None:
        return None if self.tilts is None else self.tilts[name == "right"].alpha

    def _words(self, move: BlockMove) -> str:
        name = self._name(move.id)
        size = "its stone's size" if name.startswith("wedge") else "its size"
        moved = f"moved {move.move_px:.1f} source px, {move.share:.0%} of {size}"
        return f"{name}: {moved}, turned {move.turn_deg:.1f} degrees"

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
    groups: Sequence[PolygonGroup]
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
        engine = [] if self.physics is None else self.physics.problems
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
