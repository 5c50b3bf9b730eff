"""What `plan` prints at the end: a table for people, the same for programs."""

from pathlib import Path
from typing import Any

from drystone.cli.output import number, print_table
from drystone.craft import RULES, CraftReport, Masonry, look
from drystone.model.plan import Plan
from drystone.search.plan_result import PlanResult


def summary(result: PlanResult, folder: Path) -> dict[str, Any]:
    """Return what `--json` prints."""
    return summary_of_plan(result.plan, folder) | {
        "status": result.status,
        "shortfall": result.shortfall,
        "F_SF_bound": result.F_SF_bound,
        "craft_broken": list(_craft(result).broken),
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
        "craft_broken": None,
        "F_AV": metrics.F_AV,
        "F_AH": metrics.F_AH,
        "F_LR": metrics.F_LR,
        "F_LR_coulomb": metrics.F_LR_coulomb,
        "F_LR_half": metrics.F_LR_half,
        "F_LR_double": metrics.F_LR_double,
        "F_LR_no_setback": metrics.F_LR_no_setback,
        "T_LEVEL": metrics.T_LEVEL,
        "E_FLUSH": metrics.E_FLUSH,
        "alpha_left": metrics.alpha_left,
        "alpha_right": metrics.alpha_right,
        "wedge_area": metrics.wedge_area,
        "working_scale": plan.working_scale,
        "seconds": None,
    }


def _by_contacts(result: PlanResult) -> list[tuple[str, str]]:
    """Say what the lateral resistance is with other contacts."""
    metrics = result.metrics
    if result.wall.outlines is None:
        return []
    half, double = number(metrics.F_LR_half), number(metrics.F_LR_double)
    return [
        ("", f"{half} and {double} at half and twice the contact tolerance"),
        ("", f"{number(metrics.F_LR_no_setback)} with contacts up to the ends of faces"),
    ]


def _craft(result: PlanResult) -> CraftReport:
    """Judge the wall by the masons' rules."""
    wedges = {wedge.id for wedge in result.wall.wedges}
    if result.wall.outlines is None:
        return look(Masonry.from_labels(result.wall.labels, wedges))
    outlines, per_m = dict(result.wall.outlines.blocks), result.wall.site.px_per_m
    return look(Masonry(outlines, result.model, wedges, cut=True, per_m=per_m))


def _broken(result: PlanResult) -> str:
    """Name the masons' rules that the wall breaks."""
    report = _craft(result)
    told = [f"{RULES[name].title} ({report.findings[name].amount})" for name in report.broken]
    return f"breaks {', '.join(told)}; see drystone craft" if told else "breaks no rule"


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
            ("F_LR_coulomb", f"{number(metrics.F_LR_coulomb)}  the same without dilatancy"),
            *_by_contacts(result),
            ("T_LEVEL", f"{number(metrics.T_LEVEL)}  unevenness of the top"),
            ("E_FLUSH", f"{number(metrics.E_FLUSH)}  unevenness of the ends"),
            ("alpha", f"left {number(metrics.alpha_left)}, right {number(metrics.alpha_right)}"),
            ("wedges", f"{len(plan.wedge_steps)}, area {metrics.wedge_area:g} {plan.length_unit}²"),
            ("craft", _broken(result)),
            ("working scale", f"{plan.working_scale:g}"),
            ("planned in", f"{result.seconds:.2f} s"),
            ("picture", str(folder / "picture.png")),
            ("report", str(folder / "report.html")),
        ],
    )
