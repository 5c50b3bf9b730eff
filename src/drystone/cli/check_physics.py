"""`drystone check --physics`: the wall of a plan in a rigid-body engine."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from drystone.cli.output import number
from drystone.cli.progress import counting_bar
from drystone.model.plan import Plan, PlanMetrics
from drystone.physics.building import BlockMove, BuildUp, build_up, tilt_of
from drystone.physics.scatter import TiltResult
from drystone.verify.engine import check_engine
from drystone.verify.lengths import plan_settings
from drystone.verify.outlines import Group
from drystone.verify.report import CheckReport, Problem

NOTEWORTHY_PX = 0.01
"""Overlaps below this, in source px, round to nothing and are not spoken of."""


@dataclass(frozen=True, eq=False)
class PhysicsCard:
    """What the engine says of a plan.

    Parameters
    ----------
    plan : Plan
        The plan.
    built : BuildUp
        Its wall in the engine.
    overlap_px : float
        How deep outlines overlap by the plan itself.
    tilts : (TiltResult, TiltResult) or None
        To the left and to the right; None for a wall that fell or did not come to rest.
    metrics : PlanMetrics or None
        What the limit analysis says of the wall, to stand beside.
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
        furthest, fullest = self._furthest(), max((m.turn_deg for m in self.built.moves), default=0)
        return {
            "fallen": list(self.built.fallen),
            "first_fall": self.first_fall,
            "largest_move": furthest.move_px if furthest else 0.0,
            "largest_move_at": furthest.id if furthest else None,
            "largest_share": max((move.share for move in self.built.moves), default=0.0),
            "largest_turn_deg": fullest,
            "largest_drift": max(self.built.found_moved_px, default=0.0),
            "overlap_depth": max((move.overlap_px for move in self.built.moves), default=0.0),
            "restless": [self._step(group) for group in self.built.restless],
            "tilt_left": self._alpha("left"),
            "tilt_right": self._alpha("right"),
            "alpha_left": self.metrics.alpha_left if self.metrics else None,
            "alpha_right": self.metrics.alpha_right if self.metrics else None,
            "moves": [
                {"id": m.id, "move": m.move_px, "share": m.share, "turn_deg": m.turn_deg,
                 "overlap": m.overlap_px, "fell": m.fell}
                for m in self.built.moves
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
        if self.tilts is None:
            return None
        return self.tilts[name == "right"].alpha

    def _words(self, move: BlockMove) -> str:
        moved = f"moved {move.move_px:.1f} source px, {move.share:.0%} of its size"
        if move.id in self._wedges():
            moved = f"moved {move.move_px:.1f} source px, {move.share:.0%} of its stone's size"
        return f"{self._name(move.id)}: {moved}, turned {move.turn_deg:.1f} degrees"

    def _name(self, block: int) -> str:
        return f"{'wedge' if block in self._wedges() else 'stone'} {block}"

    def _wedges(self) -> set[int]:
        return {step.id for step in self.plan.wedge_steps}

    def _step(self, group: int) -> int:
        return self.plan.stone_steps[group - 1].step

    def _furthest(self) -> BlockMove | None:
        return max(self.built.moves, key=lambda move: move.move_px, default=None)


def physics_of(
    plan: Plan, groups: Sequence[Group], report: CheckReport, *, quiet: bool
) -> PhysicsCard | None:
    """Build the wall of a plan in the engine and tilt it.

    Parameters
    ----------
    plan : Plan
        The plan.
    groups : sequence of Group
        Its polygons.
    report : CheckReport
        What the limit analysis says of the wall, and how deep outlines overlap by the plan.
    quiet : bool
        Show no progress.

    Returns
    -------
    PhysicsCard or None
        None when some step of the plan places nothing, so that there is no such wall.

    Raises
    ------
    UsageError
        E305 when pymunk is not installed.
    """
    if sum(map(len, groups)) < len(plan.steps):
        return None
    settings, _ = plan_settings(plan)
    with counting_bar("stones in the engine", len(groups), quiet=quiet) as on_group:
        built = build_up(groups, settings.mu, on_group=on_group)
    return PhysicsCard(plan, built, tilt_of(built), report.metrics, report.overlap_depth)
