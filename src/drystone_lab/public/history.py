"""Quality by version: medians of what a store of the benchmark holds."""

import re
from collections.abc import Sequence
from dataclasses import dataclass

from matplotlib.figure import Figure

from drystone_lab.paired import median_of
from drystone_lab.pictures.charts import LOOKS, name_axes, panel_sheet
from drystone_lab.public.store import PLACED, SHAKE, KeptRun
from drystone_lab.table import BENCH, Cell, Table, worded


@dataclass(frozen=True)
class Medians:
    """What a method came to in a version."""

    suite: str  # Suite and its version, such as ``"masons/1"``
    method: str  # Its name, with settings that were replaced
    version: str
    runs: tuple[tuple[str, int], ...]  # Walls and seeds
    values: dict[str, float | None]  # Median of each figure over its runs; None where no run has it


def medians_of(runs: Sequence[KeptRun]) -> tuple[Medians, ...]:
    """Return medians by suite, method and version, oldest version first."""
    groups: dict[tuple[str, str, str], list[KeptRun]] = {}
    for run in runs:
        suite = f"{run.suite}/{run.suite_version}"
        method = run.method if run.settings == "{}" else f"{run.method} {run.settings}"
        groups.setdefault((suite, method, run.version), []).append(run)
    found = [
        Medians(
            *key,
            tuple(sorted((run.wall, run.seed) for run in group)),
            {name: median_of([run.figure(of) for run in group]) for name, of in FIGURES.items()},
        )
        for key, group in groups.items()
    ]
    return tuple(sorted(found, key=lambda m: (m.suite, m.method, version_order(m.version))))


FIGURES = {
    "placed share": PLACED, "F_SF": "F_SF", "F_AV": "F_AV", "F_AH": "F_AH", "F_LR": "F_LR",
    "PGA, g": SHAKE, "wall, s": "seconds",
}  # fmt: skip
"""Of a history: what each is called, and which it is."""


def history_table(medians: Sequence[Medians]) -> Table:
    """Return the medians as a table."""
    rows: list[tuple[Cell, ...]] = [
        (one.suite, one.method, one.version, len(one.runs),
         *(None if value is None else float(f"{value:.4g}") for value in one.values.values()))
        for one in medians
    ]  # fmt: skip
    runs: dict[str, set[tuple[tuple[str, int], ...]]] = {}
    for one in medians:
        runs.setdefault(f"{one.suite} {one.method}", set()).add(one.runs)
    differing = ", ".join(sorted(name for name, of in runs.items() if len(of) > 1))
    other = "Versions have runs of different walls or seeds, so their medians cannot be compared"
    notes = [f"{other}: {differing}."] if differing else []
    words = BENCH["public"]["history"]
    return worded(words, rows, columns={"<figures>": tuple(FIGURES)}, more=notes)


def drawn_history(medians: Sequence[Medians]) -> Figure:
    """Draw the medians of one suite over versions: a panel a figure that any method has.

    A line a method, with one legend; lines are dashed where colours come round again.
    """
    versions = sorted({one.version for one in medians}, key=version_order)
    methods = dict.fromkeys(one.method for one in medians)
    values = {(one.method, one.version): one.values for one in medians}
    known = [name for name in FIGURES if any(one.values[name] is not None for one in medians)]
    title = f"suite {medians[0].suite}: medians over walls and seeds (F_AH: lower is better)"
    sheet, panels = panel_sheet(len(known), 3, (3.4, 2.4), title)
    for ax, figure in zip(panels, known, strict=True):
        for number, method in enumerate(methods):
            turn, place = divmod(number, len(LOOKS))
            colour, marker = LOOKS[place]
            found = [values.get((method, version), {}).get(figure) for version in versions]
            points = [(x, value) for x, value in enumerate(found) if value is not None]
            ax.plot(
                [x for x, _ in points], [value for _, value in points], color=colour,
                marker=marker, markersize=4.5, linewidth=1, linestyle="--" if turn else "-",
                label=method,
            )  # fmt: skip
        ax.set_xticks(range(len(versions)), versions)
        ax.set_xlim(-0.4, len(versions) - 0.6)
        name_axes(ax, "version", figure)
    handles, labels = panels[0].get_legend_handles_labels()
    sheet.legend(
        handles, labels, fontsize=7, edgecolor="none", loc="outside lower center",
        ncols=min(len(labels), 8),
    )  # fmt: skip
    return sheet


def version_order(version: str) -> tuple[tuple[int, int, str], ...]:
    """Return what sorts versions, pre-releases before their release.

    >>> sorted(["0.10.0", "0.9.1", "0.10.0rc1", "0.9"], key=version_order)
    ['0.9', '0.9.1', '0.10.0rc1', '0.10.0']
    """
    parts = re.findall(r"\d+|[a-z]+", version.lower())
    # Letters come before the end, and the end before numbers and post-releases.
    marked = [(2, int(part), "") if part.isdigit() else (2 * (part == "post"), 0, part)
              for part in parts]  # fmt: skip
    return (*marked, (1, 0, ""))
