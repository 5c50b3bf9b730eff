"""Suite "packing": how tightly stones fit without gravity, beside walls that stand.

The packer is sparrow (Gardeyn et al., https://doi.org/10.48550/arXiv.2509.13329) by its Python
package spyrrow: it makes a strip of given height as short as it can.  It knows no weight, order or
support, so what it reaches is a yardstick for filling alone.
"""

import time
from pathlib import Path
from typing import Any

from drystone.errors import extra
from drystone.kernels.polygons import turn
from drystone.model.stone import StoneSet
from drystone.poses import PoseBook
from drystone_lab.planned_walls import missing_data
from drystone_lab.runs.outcome import FIGURES, RunOutcome
from drystone_lab.runs.spec import RunSpec
from drystone_lab.search import SEARCH, WAYS, looked_at_times
from drystone_lab.table import BENCH, BenchSettings, Cell, Table, worded
from drystone_lab.walls import BRICKS, SEARCHED, chosen

TURNS: dict[str, tuple[float, ...] | None] = {"quarter": (0.0, 90.0, 180.0, 270.0), "any": None}
"""Orientations that the packer may use, from the initial pose of a stone on."""


def run(settings: BenchSettings) -> tuple[Table, ...]:
    """Pack the stones of every wall, and plan it in the same time."""
    packer = load_packer()
    (seconds,) = settings.seconds[-1:] or (1 if settings.quick else 30,)
    seconds = max(1, round(seconds))
    rows: list[tuple[Cell, ...]] = []
    for target in chosen((BRICKS,) if settings.quick else SEARCHED, settings.only):
        stones = target.stones(settings.data)
        if stones is None:
            continue
        width, height = target.size(stones)
        strips: list[Cell] = []
        for turns in TURNS.values():
            strip = packed_width_px(packer, stones, height, turns, seconds, settings.seed)
            strips += strip, stones.total_area_px / (strip * height)
        (looked,) = looked_at_times(WAYS[SEARCH], stones, target, (seconds,), settings.seed)
        placed, filled = 0, None
        if looked.found.figures is not None:
            placed, filled = looked.found.figures.stones, looked.found.figures.F_SF
        possible, told = looked.possible, f"{placed} of {len(stones)}"
        rows.append((target.name, height, *strips, width, possible, filled, told))
        settings.say(", ".join(map(str, rows[-1])))
    words = BENCH["packing"]["strips"]
    return (worded(words, rows, more=missing_data(settings), seconds=seconds),)


def load_packer() -> Any:
    """Return spyrrow; it is an extra, so it is loaded only when it is needed."""
    return extra("spyrrow", "packs the strips", "packing", "bench")


def packed_width_px(
    packer: Any,
    stones: StoneSet,
    height_px: float,
    turns: tuple[float, ...] | None,
    seconds: int,
    seed: int,
) -> float:
    """Return the width of a strip into which the packer gets all stones, source px."""
    book = PoseBook(1.0)
    items = [
        packer.Item(
            str(stone.id),
            [tuple(corner) for corner in turn(stone.outline, book.initial_angle(stone)).tolist()],
            demand=1,
            allowed_orientations=turns,
        )
        for stone in stones
    ]
    config = packer.StripPackingConfig(
        early_termination=False, total_computation_time=seconds, num_workers=1, seed=seed
    )
    strip = packer.StripPackingInstance("stones", strip_height=height_px, items=items)
    return float(strip.solve(config).width)


def packed(spec: RunSpec, data: Path | None) -> RunOutcome:
    """Pack the stones of a run into a strip as high as its wall, as short as it gets.

    It has F_SF alone: area of the stones over that of the strip, or of the wall where it is larger.
    """
    packer = load_packer()
    stones = spec.source.stones(data)
    width, height = spec.size(stones)
    seconds = int(dict(spec.changes)["seconds"])
    started = time.perf_counter()
    strip = packed_width_px(packer, stones, height, TURNS["quarter"], seconds, spec.seed)
    took = time.perf_counter() - started
    figures: dict[str, float | int | None] = dict.fromkeys(FIGURES)
    figures["stones"] = len(stones)
    figures["F_SF"] = stones.total_area_px / (max(strip, width) * height)
    return RunOutcome(spec.key, figures, {"steps": []}, {"wall": took})
