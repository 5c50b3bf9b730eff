"""Options of `drystone analyse`; nothing slow is imported here."""

import argparse

from drystone.cli.numbers import finite, friction, not_negative, whole_from


def add_model(command: argparse.ArgumentParser) -> None:
    """Add the options that say what touches what, and how rough it is."""
    group = command.add_argument_group("model")
    group.add_argument(
        "--mu", type=friction, metavar="MU",
        help="coefficient of friction (default .58); LOW:HIGH gives the scatter between them",
    )  # fmt: skip
    group.add_argument(
        "--mu-head", type=not_negative, metavar="MU", help="of head joints, 0 for open ones"
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
        "--solver",
        choices=["auto", "highs", "highs-ipm", "clarabel"],
        default="auto",
        help="of the associative load multiplier and its certificate (default auto: by the number"
        " of blocks, and another one when a certificate fails)",
    )
    group.add_argument(
        "--associative-only", action="store_true",
        help="leave out the load multiplier without dilatancy, which takes longer",
    )  # fmt: skip


def add_scatter(command: argparse.ArgumentParser) -> None:
    """Add the options of the scatter of F_LR."""
    group = command.add_argument_group("scatter of the load multiplier (Monte Carlo)")
    group.add_argument("--scatter", type=whole_from(1), metavar="N", help="samples (default 200)")
    group.add_argument(
        "--outline-noise", type=not_negative, default=0.0, metavar="PX",
        help="standard deviation of the outlines (of a block model: in its lengths)",
    )  # fmt: skip
    group.add_argument(
        "--placement-noise", type=not_negative, default=0.0, metavar="PX",
        help="standard deviation of where stones lie (of a block model: in its lengths)",
    )  # fmt: skip
    group.add_argument("--seed", type=whole_from(0), default=0)
    group.add_argument(
        "--jobs", type=whole_from(1), default=1, metavar="N", help="workers; never the result"
    )


def add_loads(command: argparse.ArgumentParser) -> None:
    """Add the options that make up dead + alpha live."""
    group = command.add_argument_group("loads (dead load: weight; live load: alpha times ...)")
    group.add_argument(
        "--load", type=_load, choices=["tilting", "height", "points", "gravity"],
        default="tilting",
        help="weights sideways as on a tilting table (default), growing with height, the --live"
        " forces, or the weight itself with the --dead forces held",
    )  # fmt: skip
    group.add_argument(
        "--tilt", type=finite, default=0.0, metavar="DEG",
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


def _load(text: str) -> str:
    """Read `--load`; a table may be called by its motion."""
    return "tilting" if text == "tilt" else text
