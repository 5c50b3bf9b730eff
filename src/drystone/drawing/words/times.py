"""Where the time of a plan went."""

from typing import Any

from drystone.kernels.backend import describe
from drystone.planner.profile import PARTS
from drystone.search.plan_result import PlanResult


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
    rows = [
        (part, f"{seconds:8.3f} s {100 * seconds / whole:5.1f} %{_each(part, seconds, summary)}")
        for part, seconds in summary["parts"].items()
        if searched or part != "search"
    ]
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


def _each(part: str, seconds: float, summary: dict[str, Any]) -> str:
    if not summary["candidates"] or part == "search":  # whose candidates are not counted
        return ""
    return f" {1e6 * seconds / summary['candidates']:9.0f}"
