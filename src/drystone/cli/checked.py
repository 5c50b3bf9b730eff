"""Everything that `drystone check` found out about a plan."""

from collections.abc import Sequence
from dataclasses import asdict, dataclass
from typing import Any

from drystone.cli.check_physics import PhysicsCard
from drystone.model.plan import Plan
from drystone.model.stone import StoneSet
from drystone.verify.outlines import Group
from drystone.verify.report import CheckReport, Problem

PICTURE = "check.png"
"""Beside a plan of which something fails."""

NOT_BUILT = "not built there, as a step of the plan places nothing"


@dataclass(frozen=True, eq=False)
class Checked:
    """A plan and what was found.

    Parameters
    ----------
    plan : Plan
        What was checked.
    stones : StoneSet
        Its stones.
    report : CheckReport
        What does not hold.
    groups : sequence of Group
        The polygons of its stones and wedges.
    asked_physics : bool
        The engine was asked for.
    physics : PhysicsCard or None
        What the engine says; None when it was not asked, or the wall cannot be built there.
    """

    plan: Plan
    stones: StoneSet
    report: CheckReport
    groups: Sequence[Group]
    asked_physics: bool = False
    physics: PhysicsCard | None = None

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
            return "does not hold"
        if self.falls:
            return "holds, but falls in the engine"
        return "holds" if self.ok else "holds, but not in the engine"

    def rows(self) -> list[tuple[str, str]]:
        """Return names and values, one a line."""
        plan, report = self.plan, self.report
        rows = [
            ("stones", f"{len(plan.stone_steps)} placed, {len(plan.wedge_steps)} wedges"),
            ("overlap", f"{report.overlap_depth:.2f} source px deep by the outlines"),
            ("area", f"the pixels of a stone miss its area by {report.area_error:.1%} at most"),
            ("buried", ", ".join(map(str, report.buried)) or "none"),
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
