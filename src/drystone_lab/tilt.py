"""`drystone bench tilt`: planned walls on a tilting table in a rigid-body engine."""

import numpy as np

from drystone.contacts.outlines import model_of_traced, outlines_of_labels
from drystone.physics.scatter import TiltComparison, compare_with_tilt, usual_variations
from drystone.physics.scene import EngineScene
from drystone_lab.planned_walls import PlannedWall, missing_data, planned_walls
from drystone_lab.table import BENCH, BenchSettings, Cell, Table, worded

BOTH_FALL = "both fall"
"""The outlines do not stand, by the analysis and in the engine."""


def run(settings: BenchSettings) -> tuple[Table, ...]:
    """Return simulated and predicted load multipliers of the same outlines, a row a direction."""
    walls = planned_walls(settings, methods=("paper",), seeds=3)
    rows = [row for wall in walls for row in _rows(wall, settings)]
    agreeing = sum(row[5] in ("yes", BOTH_FALL) for row in rows)
    counted = f"{agreeing} of {len(rows)} directions: " if rows else ""
    words, more = BENCH["tilt"]["directions"], missing_data(settings)
    return (worded(words, rows, more=more, counted=counted),)


def _rows(wall: PlannedWall, settings: BenchSettings) -> list[tuple[Cell, ...]]:
    outlines = outlines_of_labels(wall.after[-1].labels)
    variations = usual_variations()
    compared = compare_with_tilt(
        EngineScene(outlines, wall.mu),
        model_of_traced(outlines, wall.mu),
        np.random.default_rng(settings.seed),
        variations=variations[:1] if settings.quick else variations,
    )
    return [_row(wall.name, one) for one in compared]


def _row(name: str, one: TiltComparison) -> tuple[Cell, ...]:
    simulated = one.simulated
    motion, fall = simulated.interval("first motion"), simulated.interval("fall")
    predicted = one.nonassociative
    inside = predicted is not None and motion is not None and motion[0] <= predicted <= motion[1]
    # Trials that fall at rest would make the scatter as wide as one likes.
    inside = inside and not simulated.fell_at_rest
    both_fall = one.associative is None and simulated.fell_at_rest
    why = "falls" if one.associative is None else "not certain to stand"
    return (
        name, simulated.direction, one.associative,
        why if one.associative is None or predicted is None else predicted,
        "falls at rest" if simulated.fell_at_rest else _interval(motion),
        BOTH_FALL if both_fall else "yes" if inside else "no",
        _interval(fall), simulated.settled_shift,
    )  # fmt: skip


def _interval(found: tuple[float, float] | None) -> str:
    return "never" if found is None else f"{found[0]:.3f} to {found[1]:.3f}"
