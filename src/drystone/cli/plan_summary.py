"""What `plan` prints at the end: a table for people, the same for programs."""

from pathlib import Path
from typing import Any

from drystone.cli.output import number, print_table
from drystone.model.plan import Plan
from drystone.search.plan_result import PlanResult


def summary(result: PlanResult, folder: Path) -> dict[str, Any]:
    """Return what `--json` prints."""
    return summary_of_plan(result.plan, folder) | {
        "status": result.status,
        "shortfall": result.shortfall,
        "F_SF_bound": result.F_SF_bound,
        "seconds": result.seconds,
    }


def summary_of_plan(plan: Plan, folder: Path) -> dict[str, Any]:
    """Return what a plan says of itself; null what only the run knows that made it."""
    metrics = plan.metrics
    return {
        "plan": str(folder / "plan.json"),
        "status": None,
        "stopped": plan.stopped,
        "shortfall": None,
        "placed": len(plan.stone_steps),
        "stones": len(plan.stone_steps) + len(plan.unused),
        "unused": list(plan.unused),
        "wedges": len(plan.wedge_steps),
        "F_SF": metrics.F_SF,
        "F_SF_bound": None,
        "F_AV": metrics.F_AV,
        "F_AH": metrics.F_AH,
        "F_LR": metrics.F_LR,
        "F_LR_half": metrics.F_LR_half,
        "F_LR_double": metrics.F_LR_double,
        "T_LEVEL": metrics.T_LEVEL,
        "E_FLUSH": metrics.E_FLUSH,
        "alpha_left": metrics.alpha_left,
        "alpha_right": metrics.alpha_right,
        "wedge_area": metrics.wedge_area,
        "working_scale": plan.working_scale,
        "seconds": None,
    }


def _by_tolerance(result: PlanResult) -> list[tuple[str, str]]:
    """Say what the lateral resistance is with other contact tolerances."""
    metrics = result.metrics
    if result.wall.outlines is None:
        return []
    half, double = number(metrics.F_LR_half), number(metrics.F_LR_double)
    return [("", f"{half} and {double} at half and twice the contact tolerance")]


def _bound(result: PlanResult) -> str:
    """Say how large F_SF can be at most, and why."""
    bound = result.F_SF_bound
    return f"{number(bound)} ({'a full wall' if bound == 1.0 else 'area of the stones'})"


def _how_it_ended(result: PlanResult) -> str:
    if result.status == "interrupted":
        return "interrupted: --resume goes on from here"
    return f"{result.status}: {'; '.join(filter(None, (result.message, result.shortfall)))}"


def print_summary(result: PlanResult, folder: Path) -> None:
    """Print the table."""
    plan, metrics = result.plan, result.metrics
    placed, left = len(plan.stone_steps), len(plan.unused)
    unused = f", unused: {', '.join(map(str, plan.unused))}" if left else ""
    print_table(
        _how_it_ended(result),
        [
            ("stones", f"{placed} of {placed + left} placed{unused}"),
            ("F_SF", f"{number(metrics.F_SF)} of at most {_bound(result)}"),
            ("F_AV", f"{number(metrics.F_AV, 2)}  vertical arrangement, higher is better"),
            ("F_AH", f"{number(metrics.F_AH, 2)}  horizontal arrangement, lower is better"),
            ("F_LR", f"{number(metrics.F_LR)}  lateral resistance / mu, higher is better"),
            *_by_tolerance(result),
            ("T_LEVEL", f"{number(metrics.T_LEVEL)}  unevenness of the top"),
            ("E_FLUSH", f"{number(metrics.E_FLUSH)}  unevenness of the ends"),
            ("alpha", f"left {number(metrics.alpha_left)}, right {number(metrics.alpha_right)}"),
            ("wedges", f"{len(plan.wedge_steps)}, area {metrics.wedge_area:g} {plan.length_unit}²"),
            ("working scale", f"{plan.working_scale:g}"),
            ("planned in", f"{result.seconds:.2f} s"),
            ("picture", str(folder / "picture.png")),
            ("report", str(folder / "report.html")),
        ],
    )
