"""Fig. 28: the time of every step by part, variant and full batch sampling (§6.1)."""

from collections.abc import Mapping, Sequence
from statistics import fmean

from drystone.planner.profile import Part, StepTime
from drystone.planner.settings import method_settings
from drystone.selection.sampling import Sampling
from drystone_lab.reproduce.base import PR, PaperWall
from drystone_lab.reproduce.findings import Finding, findings_table, trend
from drystone_lab.reproduce.item import Context, Item, Output, Picture
from drystone_lab.reproduce.timing import how_timed, repeats, task_of
from drystone_lab.table import Cell, Table
from drystone_lab.time_tables import SAMPLINGS, steps_figure, steps_table
from drystone_lab.timed_walls import Planned, planned

Shares = Mapping[str, float]

PROCEDURES: Mapping[str, tuple[Part, ...]] = {
    "placement": ("placement",),
    "stabilisation": ("stabilisation",),
    "selection": ("contacts", "limit analysis", "indices"),
}
"""The paper's, by our parts."""

NEGLIGIBLE = 0.05
"""Share of the three procedures below which one is called negligible."""

STABLE = 1.5
"""A step takes about as long at the end when it takes less than so many times as long."""

QUARTER = 4

PAPER = (
    "Fig. 28 (§6.1): the time of each of the 32 steps of two walls of PR, 280 x 80 px, by trial "
    "placement, stabilisation and selection, with variant and with full batch sampling. The "
    "numbers are only in the picture.",
    "The text says: 'the placement procedure takes most of the time, the selection ranks second, "
    "and the computational demand in the stabilization procedure is negligible'; with variant "
    "sampling a step is almost stable, while selection grows slightly as stones are placed, by its "
    "kinematic analysis; with the full batch a step gets shorter as the candidates get fewer.",
)


def make(context: Context, wall: PaperWall = PR) -> Output:
    """Plan a wall by the clock with either sampling.

    Parameters
    ----------
    context : Context
        `quick` plans each once.
    wall : PaperWall
        Stones and size.
    """
    task = task_of(context, wall)
    by_sampling: dict[Sampling, Planned] = {
        sampling: planned(
            task, wall.scale, method_settings("paper").updated({"sampling": sampling}),
            seed=context.seed, repeats=repeats(context),
        )
        for sampling in SAMPLINGS
    }  # fmt: skip
    return Output(
        paper=PAPER,
        ours=(_counted(by_sampling), how_timed(context)),
        tables=(("candidates", _candidates(by_sampling)),),
        times=(
            ("claims", findings_table("The paper's claims about steps", findings(by_sampling))),
            ("procedures", _procedures(by_sampling)),
            ("steps", steps_table(task.name, by_sampling)),
        ),
        pictures=(
            Picture(
                "fig28", steps_figure(by_sampling),
                "The time of every step by part. Contacts, limit analysis and indices are the "
                "paper's selection; the rest is sampling and keeping books.",
            ),
        ),
    )  # fmt: skip


def shares(steps: Sequence[StepTime]) -> dict[str, float]:
    """Return the share of each of the paper's procedures in the time of all three."""
    seconds = {
        name: sum(step.parts.get(part, 0.0) for step in steps for part in parts)
        for name, parts in PROCEDURES.items()
    }
    whole = sum(seconds.values()) or 1.0
    return {name: value / whole for name, value in seconds.items()}


def late_over_early(seconds: Sequence[float]) -> float:
    """Return the mean of the last quarter over that of the first; at least one value a quarter."""
    quarter = max(1, len(seconds) // QUARTER)
    return fmean(seconds[-quarter:]) / fmean(seconds[:quarter])


def findings(by_sampling: Mapping[Sampling, Planned]) -> tuple[Finding, ...]:
    """Compare measured steps with what §6.1 says of them."""
    variant, full = by_sampling["variant"].steps, by_sampling["full"].steps
    each = {SAMPLINGS[name]: shares(wall.steps) for name, wall in by_sampling.items()}
    return (
        Finding(
            "Placement takes most of the time, selection is second.",
            _written(each, ("placement", "selection")),
            all(one["placement"] > 0.5 and one["selection"] > one["stabilisation"]
                for one in each.values()),
        ),
        Finding(
            "The time of stabilisation is negligible.",
            _written(each, ("stabilisation",)),
            all(one["stabilisation"] < NEGLIGIBLE for one in each.values()),
        ),
        _stable(variant),
        _selection_grows(variant),
        _full_falls(full),
    )  # fmt: skip


def _stable(steps: Sequence[StepTime]) -> Finding:
    ratio = late_over_early([step.seconds for step in steps])
    return Finding(
        "A step of variant sampling is almost stable.",
        f"a step of the last quarter takes {ratio:.2f} times as long as one of the first.",
        1 / STABLE < ratio < STABLE,
    )


def _selection_grows(steps: Sequence[StepTime]) -> Finding:
    selection = [sum(s.parts.get(part, 0.0) for part in PROCEDURES["selection"]) for s in steps]
    each = [seconds / step.candidates for seconds, step in zip(selection, steps, strict=True)]
    ratio = late_over_early(selection) if min(selection) > 0 else None
    found = trend([(step.stones, value) for step, value in zip(steps, each, strict=True)])
    words = "" if found is None else f"; of a candidate, over the stones placed: {found.words()}"
    times = "nothing" if ratio is None else f"{ratio:.2f} times as long"
    return Finding(
        "Selection grows slightly as stones are placed (variant sampling).",
        f"in the last quarter it takes {times} as in the first{words}.",
        None if ratio is None else ratio > 1,
    )


def _full_falls(steps: Sequence[StepTime]) -> Finding:
    found = trend([(step.stones, step.seconds) for step in steps])
    ratio = late_over_early([step.seconds for step in steps])
    words = "" if found is None else f"; over the stones placed: {found.words()}"
    return Finding(
        "A step of the full batch gets shorter as the candidates get fewer.",
        f"a step of the last quarter takes {ratio:.2f} times as long as one of the first, with "
        f"{late_over_early([float(step.candidates) for step in steps]):.2f} times the candidates"
        f"{words}.",
        ratio < 1,
    )


def _written(each: Mapping[str, Shares], names: Sequence[str]) -> str:
    parts = (
        f"{sampling}: " + ", ".join(f"{name} {100 * one[name]:.0f} %" for name in names)
        for sampling, one in each.items()
    )
    return "; ".join(parts) + " of the three procedures."


def _counted(by_sampling: Mapping[Sampling, Planned]) -> str:
    each = []
    for name, wall in by_sampling.items():
        counts = [step.candidates for step in wall.steps]
        each.append(
            f"{SAMPLINGS[name]}: {len(counts)} steps of {fmean(counts):.1f} candidates each, "
            f"{sum(counts)} in all"
        )
    return f"{'; '.join(each)}. Both walls are planned with the same seed."


def _candidates(by_sampling: Mapping[Sampling, Planned]) -> Table:
    rows: list[tuple[Cell, ...]] = [
        (sampling, number, step.stones, step.candidates)
        for sampling, wall in by_sampling.items()
        for number, step in enumerate(wall.steps, 1)
    ]
    return Table(
        "Candidates of every step", ("sampling", "step", "stones placed", "candidates"), tuple(rows)
    )


def _procedures(by_sampling: Mapping[Sampling, Planned]) -> Table:
    rows: list[tuple[Cell, ...]] = []
    for sampling, wall in by_sampling.items():
        share = shares(wall.steps)
        rows.append((sampling, round(wall.seconds, 3), *(round(share[p], 3) for p in PROCEDURES)))
    columns = ("sampling", "wall, s", *(f"{name}, share" for name in PROCEDURES))
    return Table("Shares of the paper's procedures in their time", columns, tuple(rows))


ITEM = Item("time of a step by part", "§6.1", make, needs=(PR.source.name,))
