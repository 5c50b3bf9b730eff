"""Options of `drystone analyse`; nothing slow is imported here."""

import argparse
import math
from collections.abc import Callable

Friction = tuple[float, float]


def friction(text: str) -> Friction:
    """Read one coefficient of friction, or LOW:HIGH."""
    try:
        parts = [float(part) for part in text.split(":")]
    except ValueError:
        parts = []
    low, high = (parts * 2)[:2] if len(parts) in (1, 2) else (math.nan, math.nan)
    if not 0 <= low <= high < math.inf:
        raise argparse.ArgumentTypeError(f"{text!r} is no friction such as .58 or .4:.8")
    return low, high


def _not_negative(text: str) -> float:
    try:
        value = float(text)
    except ValueError:
        value = math.nan
    if not 0 <= value < math.inf:
        raise argparse.ArgumentTypeError(f"{text!r} is no number from 0 on")
    return value


def _finite(text: str) -> float:
    try:
        value = float(text)
    except ValueError:
        value = math.nan
    if not math.isfinite(value):
        raise argparse.ArgumentTypeError(f"{text!r} is no finite number")
    return value


def _from(least: int) -> Callable[[str], int]:
    def read(text: str) -> int:
        try:
            value = int(text)
        except ValueError:
            value = least - 1
        if value < least:
            raise argparse.ArgumentTypeError(f"{text!r} is no whole number from {least} on")
        return value

    return read


def add_model(command: argparse.ArgumentParser) -> None:
    """Add the options that say what touches what, and how rough it is."""
    group = command.add_argument_group("model")
    group.add_argument(
        "--mu", type=friction, metavar="MU",
        help="coefficient of friction (default .58); LOW:HIGH gives the scatter between them",
    )  # fmt: skip
    group.add_argument(
        "--mu-head", type=_not_negative, metavar="MU", help="of head joints, 0 for open ones"
    )
    group.add_argument(
        "--contacts", choices=["pixels", "outlines"], default="pixels",
        help="from the edges of pixels (default), or from sub-pixel outlines",
    )  # fmt: skip
    group.add_argument(
        "--close-gaps", metavar="PX|settle",
        help="gaps up to PX between drawn stones bear, or stones are lowered until they touch",
    )  # fmt: skip
    group.add_argument(
        "--solver", choices=["auto", "highs", "highs-ipm", "clarabel"], default="auto"
    )
    group.add_argument(
        "--associative-only", action="store_true",
        help="leave out the load multiplier without dilatancy, which takes longer",
    )  # fmt: skip


def add_scatter(command: argparse.ArgumentParser) -> None:
    """Add the options of the scatter of F_LR."""
    group = command.add_argument_group("scatter of the load multiplier (Monte Carlo)")
    group.add_argument("--scatter", type=_from(1), metavar="N", help="samples (default 200)")
    group.add_argument(
        "--outline-noise", type=_not_negative, default=0.0, metavar="PX",
        help="standard deviation of the outlines",
    )  # fmt: skip
    group.add_argument(
        "--placement-noise", type=_not_negative, default=0.0, metavar="PX",
        help="standard deviation of where stones lie",
    )  # fmt: skip
    group.add_argument("--seed", type=_from(0), default=0)
    group.add_argument(
        "--jobs", type=_from(1), default=1, metavar="N", help="workers; never the result"
    )


def add_loads(command: argparse.ArgumentParser) -> None:
    """Add the options that make up dead + alpha live."""
    group = command.add_argument_group("loads (dead load: weight; live load: alpha times ...)")
    group.add_argument(
        "--load", choices=["tilting", "height", "points", "gravity"], default="tilting",
        help="weights sideways as on a tilting table (default), growing with height, the --live"
        " forces, or the weight itself with the --dead forces held",
    )  # fmt: skip
    group.add_argument(
        "--tilt", type=_finite, default=0.0, metavar="DEG",
        help="gravity is turned by this towards the right already",
    )  # fmt: skip
    for name, text in (("--dead", "force that acts always"), ("--live", "force times alpha")):
        group.add_argument(
            name, action="append", default=[], metavar="ID@X,Y:FX,FY",
            help=f"{text}, on block ID at (x, y) of the wall frame, up is positive; repeatable",
        )  # fmt: skip
    group.add_argument(
        "--settle", type=int, metavar="ID", help="the fixed block ID gives way: its reaction"
    )
