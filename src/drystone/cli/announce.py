"""What `plan` says before it begins, and what it wrote at the end."""

import sys
from pathlib import Path

from drystone.drawing.export.formats import FORMATS
from drystone.errors import Notice
from drystone.model.stone import StoneSet
from drystone.model.stone_size import median_sides, sides_px
from drystone.search.plan_result import PlanResult

WRITTEN = (
    "plan.json", "report.html", "wall.png", "wall.tif", "picture.png", "mechanism_left.png",
    "mechanism_right.png", "settings.toml", "blocks.json", "build.gif",
)  # fmt: skip
"""What a plan's folder may hold, the most useful first."""

FILM_STONES = 100
"""Walls of more stones get a film by `drystone export` alone: a frame a stone takes its time."""


def read_line(
    stones: StoneSet, wall: tuple[float, float], px_per_m: float | None, seconds: float | None
) -> str:
    """Say how many stones were read, how large they and the wall are, and how long it takes.

    Parameters
    ----------
    stones : StoneSet
        Those that were read.
    wall : (float, float)
        Width and height, source px.
    px_per_m : float or None
        Scale, if there is one.
    seconds : float or None
        How long better walls are looked for; None when that is not known.

    Examples
    --------
    >>> import numpy as np
    >>> from drystone.model.stone import Stone
    >>> stones = StoneSet((Stone(1, np.ones((12, 31), bool)),))
    >>> read_line(stones, (280, 80), 200.0, 3.6)
    'Read 1 stone (largest 15.5 x 6.0 cm, median 15.5 x 6.0 cm), wall 1.40 x 0.40 m, estimate 4 s'
    >>> read_line(stones, (280, 80), None, None)
    'Read 1 stone (largest 31 x 12 px, median 31 x 12 px), wall 280 x 80 px'
    """
    said = f"Read {len(stones)} stone{'' if len(stones) == 1 else 's'}"
    if len(stones):
        biggest = sides_px(max(stones, key=lambda stone: stone.area_px).mask)
        median = median_sides(sides_px(stone.mask) for stone in stones)
        said += f" (largest {_size(*biggest, px_per_m)}, median "
        said += f"{_size(*median, px_per_m)})"
    said += f", wall {_size(*wall, px_per_m)}"
    return said if seconds is None else f"{said}, estimate {max(seconds, 1.0):.0f} s"


def write_film(result: PlanResult, folder: Path) -> None:
    """Write build.gif, unless there are no steps, or many; one of an earlier run is removed."""
    if not 0 < len(result.plan.stone_steps) <= FILM_STONES:
        (folder / "build.gif").unlink(missing_ok=True)
        return
    # What draws is loaded when it draws.
    from drystone.drawing.assembly.read import read_assembly  # noqa: PLC0415
    from drystone.drawing.export.formats import ExportSettings  # noqa: PLC0415

    FORMATS["gif"].write(read_assembly(folder), folder, ExportSettings())


def exports_notice(folder: Path) -> Notice | None:
    """Say when exports of an earlier plan lie beside a new one (W181); None when there are none."""
    names = (name for one in FORMATS.values() for name in one.writes if name not in WRITTEN)
    earlier = [name for name in names if (folder / name).exists()]
    if not earlier:
        return None
    return Notice(
        "W181",
        f"of an earlier plan: {', '.join(earlier)}, in {folder}.",
        "Make them again: drystone export --overwrite.",
    )


def say_written(folder: Path) -> None:
    """Name the files of a plan."""
    first, *others = (name for name in WRITTEN if (folder / name).exists())
    print(f"drystone: wrote {' '.join([str(folder / first), *others])}", file=sys.stderr)


def _size(width: float, height: float, px_per_m: float | None) -> str:
    if px_per_m is None:
        return f"{round(width, 1):g} x {round(height, 1):g} px"
    width, height = width / px_per_m, height / px_per_m
    if max(width, height) < 1.0:
        return f"{100 * width:.1f} x {100 * height:.1f} cm"
    return f"{width:.2f} x {height:.2f} m"
