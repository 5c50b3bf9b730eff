"""Runs that pack strips without gravity: a yardstick for filling, no wall."""

import time
from pathlib import Path

from drystone_lab.packing import TURNS, load_packer, packed_width_px
from drystone_lab.runs.outcome import FIGURES, Outcome
from drystone_lab.runs.spec import RunSpec

SECONDS = "seconds"
"""The one change of such a run: for how long it packs."""


def packed(spec: RunSpec, data: Path | None) -> Outcome:
    """Pack the stones of a run into a strip as high as its wall, as short as it gets.

    Returns
    -------
    outcome : Outcome
        Of its figures F_SF alone: area of the stones over that of the strip, or over that of the
        wall where the strip is shorter.  Without steps.

    Raises
    ------
    UsageError
        E305: spyrrow is not installed.
    """
    packer = load_packer()
    stones = spec.source.stones(data)
    width = spec.width or float(stones.source.width_px)
    height = spec.height or float(stones.source.height_px)
    seconds = int(dict(spec.changes)[SECONDS])
    started = time.perf_counter()
    strip = packed_width_px(packer, stones, height, TURNS["quarter"], seconds, spec.seed)
    took = time.perf_counter() - started
    figures: dict[str, float | int | None] = dict.fromkeys(FIGURES)
    figures["stones"] = len(stones)
    figures["F_SF"] = stones.total_area_px / (max(strip, width) * height)
    return Outcome(spec.key, figures, {"steps": []}, {"wall": took})
