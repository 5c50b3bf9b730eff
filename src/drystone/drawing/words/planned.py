"""What is said of a plan that was made, and where its time went; for people and for programs."""

from pathlib import Path
from typing import Any

from drystone.craft.look import RULES, CraftReport, look
from drystone.craft.masonry import Masonry
from drystone.drawing.words.content import figure_rows, number
from drystone.errors import counted
from drystone.kernels.backend import describe
from drystone.model.plan import Plan
from drystone.planner.profile import PARTS
from drystone.search.plan_result import PlanResult

FIGURES = (
    "F_AV", "F_AH", "F_LR", "F_LR_coulomb", "F_LR_half", "F_LR_double", "F_LR_no_setback",
    "T_LEVEL", "E_FLUSH", "alpha_left", "alpha_right", "wedge_area",
)  # fmt: skip
"""Metrics that the summary has beside F_SF."""


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
        **{name: getattr(metrics, name) for name in FIGURES},
        "walls": plan.walls,
        "working_scale": plan.working_scale,
        "seconds": None,
    }


def _craft(result: PlanResult) -> CraftReport:
    wedges = {wedge.id for wedge in result.wall.wedges}
    if result.wall.outlines is None:
        return look(Masonry.from_labels(result.wall.labels, wedges))
    outlines, per_m = dict(result.wall.outlines.blocks), result.wall.site.px_per_m
    return look(Masonry(outlines, result.model, wedges, cut=True, per_m=per_m))


def ending(result: PlanResult) -> str:
    """Say how a plan ended."""
    if result.status == "interrupted":
        return "interrupted: --resume goes on from here"
    placed, unused = len(result.plan.stone_steps), result.plan.unused
    why = result.message if unused else ""
    if why.startswith("no stone that is left"):
        left = [str(one) for one in unused if one not in result.plan.settings["ban"]]
        few = f"stone{'s' if len(left) > 1 else ''} {' and '.join(left)}"
        named = few if len(left) < 3 else f"{len(left)} others"
        why = f"{named} found no place to rest" if placed else "none found a place to rest"
    said = f"{placed} of {counted(placed + len(unused), 'stone')} placed"
    return f"{result.status}: {'; '.join(filter(None, (said, why, result.shortfall)))}"


def rows(result: PlanResult, folder: Path) -> list[tuple[str, str]]:
    """Return names and values, one a line."""
    plan, metrics, bound = result.plan, result.metrics, result.F_SF_bound
    placed, left = len(plan.stone_steps), len(plan.unused)
    # What the clock cut short no number of walls repeats.
    cut = plan.walls == 1 or any(notice.code == "W125" for notice in result.notices)
    again = "" if cut else f"; --budget {plan.walls} builds the same again"
    unused = f", unused: {', '.join(map(str, plan.unused))}" if left else ""
    most = (
        "1 is a full wall"
        if round(bound, 3) == 1.0
        else f"the maximum for these stones is {number(bound)}"
    )
    broken = [RULES[name].title for name in _craft(result).broken]
    craft = f"breaks {', '.join(broken)}; see drystone craft" if broken else "breaks no rule"
    return [
        ("stones", f"{placed} of {placed + left} placed{unused}"),
        ("F_SF", f"{number(metrics.F_SF)}  ({most})"),
        *figure_rows(metrics),
        ("alpha", f"left {number(metrics.alpha_left)}, right {number(metrics.alpha_right)}"),
        ("wedges", f"{len(plan.wedge_steps)}, area {metrics.wedge_area:.3g} {plan.length_unit}²"),
        ("craft", craft),
        ("walls tried", f"{plan.walls}{again}"),
        ("working scale", f"{plan.working_scale:g}"),
        ("planned in", f"{result.seconds:.2f} s"),
        ("picture", str(folder / "picture.png")),
        ("report", str(folder / "report.html")),
    ]


def profile_summary(result: PlanResult, jobs: int) -> dict[str, Any]:
    """Return the times of a plan by part, for ``--json``; seconds.

    The part "search" is all that is built after the first wall, by the clock however many
    processes do it; the other parts are of the first wall, and of what is placed at the end.  What
    is not measured as a part is "other": sampling, selection, keeping books.  With several threads,
    which work where a single wall is built, parts are summed over them, waiting included, and
    there is no "other".
    """
    profile = result.profile
    parts: dict[str, float] = {part: profile.total(part) for part in (*PARTS, "search")}
    if jobs == 1 or parts["search"]:
        parts["other"] = max(0.0, result.seconds - sum(parts.values()))
    return {
        "seconds": result.seconds,
        "parts": parts,
        "steps": len(profile.steps),
        "candidates": profile.candidates,
        "solved_anew": result.solves.cold,
        "longest_step": max((step.seconds for step in profile.steps), default=0.0),
        "jobs": jobs,
        "kernels": describe(),
    }


def profile_rows(summary: dict[str, Any]) -> list[tuple[str, str]]:
    """Return the times as names and values, one a line."""
    whole = sum(summary["parts"].values()) or 1.0
    jobs, searched = summary["jobs"], summary["parts"]["search"] > 0
    without = " (without those of the search)" if searched else ""
    rows = []
    for part, seconds in summary["parts"].items():
        if not searched and part == "search":
            continue
        said = f"{seconds:8.3f} s {100 * seconds / whole:5.1f} %"
        if summary["candidates"] and part != "search":  # whose candidates are not counted
            said += f" {1e6 * seconds / summary['candidates']:9.0f}"
        rows.append((part, said))
    longest = f"the longest {1000 * summary['longest_step']:.1f} ms"
    return [
        *rows,
        ("steps", f"{summary['steps']}, {longest}{without}"),
        ("candidates", f"{summary['candidates']}{without}"),
        ("solved anew", f"{summary['solved_anew']}, as the first answer had no certificate"),
        ("kernels", summary["kernels"]),
        ("processes", f"{jobs}; the search is by the clock")
        if searched
        else ("threads", "1" if jobs == 1 else f"{jobs}; parts are summed over them"),
    ]
