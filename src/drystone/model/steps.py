"""The steps of a plan: what they place, and whether their order and their ids can be."""

from collections.abc import Sequence
from dataclasses import dataclass

from drystone.model.plan import Plan, StoneStep, WedgeStep

Step = StoneStep | WedgeStep


@dataclass(frozen=True)
class Problem:
    """One claim of a plan that does not hold."""

    code: str  # stable code, ``"E210"`` to ``"E242"``; documented in ``docs/errors.md``
    # number that the step concerned gives itself; None when it is the plan as a whole
    step: int | None
    message: str

    def __str__(self) -> str:
        where = "" if self.step is None else f"step {self.step}: "
        return f"{self.code} {where}{self.message}"


def piece_id(step: Step) -> int:
    """Return the value in wall.png of what a step places."""
    return step.id if isinstance(step, WedgeStep) else step.stone


def piece_name(step: Step) -> str:
    """Return what messages call it, such as "wedge 301"."""
    return f"{step.kind} {piece_id(step)}"


def grouped(steps: Sequence[Step]) -> tuple[list[list[Step]], list[Problem]]:
    """Put each stone and its wedges together (E214 where the order is not the contract's)."""
    groups: list[list[Step]] = []
    faults = []
    for number, step in enumerate(steps, 1):
        if step.step != number:
            faults.append(Problem("E214", step.step, f"this is step {number} of the plan."))
        if isinstance(step, StoneStep):
            groups.append([step])
            continue
        above = groups[-1][0] if groups else None
        if not isinstance(above, StoneStep) or above.stone != step.under:
            message = f"wedge {step.id} does not follow stone {step.under}, which it supports."
            faults.append(Problem("E214", step.step, message))
        if groups:
            groups[-1].append(step)
    for group in groups:
        faults += [
            Problem("E214", s.step, "load multipliers are claimed before the stone's last wedge.")
            for s in group[:-1]
            if (s.alpha_left, s.alpha_right) != (None, None)
        ]
    return groups, faults


def id_fault(step: Step, used: set[int], largest: int) -> Problem | None:
    """Note the id of a step as used; say when it was, or is not one of a wedge (E213).

    The ids of wedges are larger than `largest`, that of a stone.
    """
    name, its_id = piece_name(step), piece_id(step)
    if its_id in used:
        return Problem("E213", step.step, f"{name} was placed before.")
    used.add(its_id)
    if isinstance(step, WedgeStep) and its_id <= largest:
        message = f"{name} has an id that is not larger than every stone's."
        return Problem("E213", step.step, message)
    return None


def first_fault(plan: Plan) -> Problem | None:
    """Return the first fault of the steps of a plan that its stones are not needed for."""
    largest = max((*plan.unused, *(step.stone for step in plan.stone_steps)), default=0)
    used: set[int] = set()
    found = [fault for step in plan.steps if (fault := id_fault(step, used, largest))]
    return next(iter([*found, *grouped(plan.steps)[1]]), None)
