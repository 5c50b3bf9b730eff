"""``python -m benchmarks.memory METHOD SIZES``: the peak memory of a plan, as JSON, in MB."""

import json
import resource
import sys
import tracemalloc
from pathlib import Path

from benchmarks.scenes import stock
from benchmarks.sizes import SIZES, Sizes
from drystone.search.plan_wall import plan_wall

STATUS = Path("/proc/self/status")
"""Where Linux tells the peak of this process; that of `resource` includes the parent's."""


def resident_mb() -> float:
    """Return the largest memory that this process had so far."""
    if STATUS.exists():
        (line,) = (x for x in STATUS.read_text().splitlines() if x.startswith("VmHWM"))
        return int(line.split()[1]) / 2**10
    unit = 2**20 if sys.platform == "darwin" else 2**10
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / unit


def peaks(method: str, sizes: Sizes) -> dict[str, float]:
    """Plan the wall twice: as it is, and with every allocation traced.

    Returns
    -------
    dict
        `loaded`: resident before planning; `resident`: at most; `traced`: allocated at most by
        Python and NumPy while planning.
    """
    stones, settings = stock(sizes.generated), sizes.settings(method)

    def plan() -> None:
        plan_wall(stones.stones, *stones.wall_px, seed=1, scale=0.5, settings=settings)

    before = resident_mb()
    plan()
    after = resident_mb()
    tracemalloc.start()
    plan()
    traced = tracemalloc.get_traced_memory()[1] / 2**20
    return {"loaded": before, "resident": after, "traced": traced}


if __name__ == "__main__":
    sys.stdout.write(json.dumps(peaks(sys.argv[1], SIZES[sys.argv[2]])))
