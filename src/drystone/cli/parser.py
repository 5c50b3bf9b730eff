"""Commands and options."""

import argparse
from collections.abc import Callable
from typing import NoReturn

from drystone.cli.analyse_options import add_loads, add_model, add_scatter
from drystone.cli.bench_options import add_bench
from drystone.cli.craft_options import add_craft
from drystone.cli.export_options import add_export
from drystone.cli.markers_options import add_markers
from drystone.cli.numbers import not_negative, share, whole_from
from drystone.cli.plan_options import add_demo, add_plan
from drystone.cli.reading import STONES, add_reading
from drystone.cli.scale import add_scale
from drystone.cli.segment_options import add_segment
from drystone.cli.wall_options import add_wall
from drystone.errors import UsageError


def build_parser() -> argparse.ArgumentParser:
    """Return the parser of all commands."""
    parser = _Parser(
        prog="drystone",
        description="Plans dry-stone walls from images of found stones.",
        epilog="drystone COMMAND --help explains a command. Start with: drystone demo",
        formatter_class=_Listed,
    )
    parser.add_argument("--version", action=_Version, nargs=0, help="print the version")
    commands = parser.add_subparsers(dest="command", metavar="COMMAND", required=True)
    for name, (text, add) in _COMMANDS.items():
        command = commands.add_parser(name, help=text, description=text)
        command.add_argument("--debug", action="store_true", help="show the traceback of an error")
        add(command)
    return parser


class _Listed(argparse.HelpFormatter):
    """Has room for names of commands, whose indentation argparse forgets, beside their texts."""

    def add_argument(self, action: argparse.Action) -> None:
        """Add an option, or all commands."""
        super().add_argument(action)
        self._action_max_length = max(self._action_max_length, 13)


class _Parser(argparse.ArgumentParser):
    """Says what is wrong in one line, with a code (E138), and where help is."""

    def error(self, message: str) -> NoReturn:
        """End the program: the options cannot be understood."""
        coded = UsageError("E138", f"{message}.", cure=f"`{self.prog} --help` explains.")
        self.exit(int(coded.exit_code), f"drystone: {coded}\n")


_seed, _count = whole_from(0), whole_from(1)


class _Version(argparse.Action):
    """Looks the version up only when it is asked for."""

    def __call__(
        self,
        parser: argparse.ArgumentParser,
        *_: object,
    ) -> None:
        from importlib.metadata import version  # noqa: PLC0415 - costs start-up time

        from drystone.kernels.backend import describe  # noqa: PLC0415

        print(f"drystone {version('drystone')} (kernels: {describe()})")
        parser.exit()


def _overwriting(command: argparse.ArgumentParser, text: str) -> None:
    command.add_argument("--overwrite", action="store_true", help=text)


def _stones(command: argparse.ArgumentParser) -> None:
    command.add_argument("stones", metavar="STONES", help=STONES)
    command.add_argument("-o", "--output", metavar="PICTURE.png", help="draw the stones")
    _overwriting(command, "replace the picture")
    add_reading(command)
    add_scale(command)
    command.add_argument("--json", action="store_true", help="print as JSON")


def _analyse(command: argparse.ArgumentParser) -> None:
    add_wall(command)
    add_scale(command)
    add_model(command)
    add_loads(command)
    add_scatter(command)


def _measure(command: argparse.ArgumentParser) -> None:
    add_wall(command)
    command.add_argument("--mu", type=not_negative, help="coefficient of friction (default .58)")
    command.add_argument("--wall", metavar="WxH", help="wall that was to be built, px or metric")
    command.add_argument(
        "--scale", type=share, default=1.0, metavar="S", help="reduce the image by S first"
    )
    add_scale(command)


def _check(command: argparse.ArgumentParser) -> None:
    command.add_argument("plan", metavar="PLAN.json", help="plan to verify, or its folder")
    command.add_argument("--stones", metavar="STONES", help="what the plan was made from")
    command.add_argument(
        "--physics", action="store_true",
        help="build the wall in a rigid-body engine too, and tilt it (extra `physics`)",
    )  # fmt: skip
    command.add_argument(
        "--picture", metavar="FILE.png",
        help="draw it, whatever was found (else check.png beside the plan when something fails)",
    )  # fmt: skip
    _overwriting(command, "replace the picture")
    command.add_argument("--json", action="store_true", help="print as JSON")


def _generate(command: argparse.ArgumentParser) -> None:
    command.add_argument("kind", choices=["fourier", "polygon", "brick", "rubble"])
    command.add_argument("-o", "--output", required=True, metavar="STONES.png")
    command.add_argument("--count", type=_count, default=None, help="number of stones")
    command.add_argument("--seed", type=_seed, default=0)
    _overwriting(command, "replace the file")
    command.add_argument(
        "--set", action="append", default=[], metavar="NAME=VALUE", dest="changes",
        help="a parameter of the generator, such as noise=0.4 or D2=0.2 (see the docs)",
    )  # fmt: skip


def _fetch(command: argparse.ArgumentParser) -> None:
    command.add_argument("sets", metavar="NAME", nargs="*", help="see --list")
    command.add_argument("--list", action="store_true", help="name the sets, one a line")
    command.add_argument(
        "--to", metavar="DIR",
        help="folder to write to (default: $DRYSTONE_DATA, else a cache of your account)",
    )  # fmt: skip
    command.add_argument("--json", action="store_true", help="print as JSON")


def _reproduce(command: argparse.ArgumentParser) -> None:
    command.add_argument(
        "names", metavar="NAME", nargs="*", help="table or figure, see --list; or all"
    )
    command.add_argument("--list", action="store_true", help="name them, one a line")
    command.add_argument(
        "-o", "--output", metavar="DIR", help="folder to write to; what is in it is kept and added"
    )
    command.add_argument("--quick", action="store_true", help="a smaller version, in a minute each")
    command.add_argument("--data", metavar="DIR", help="published data (default: $DRYSTONE_DATA)")
    command.add_argument("--image", metavar="PATH", help="your own stones, where they can be taken")
    command.add_argument("--seed", type=_seed, default=1, help="the first one (default 1)")
    command.add_argument("--jobs", type=_count, metavar="N", help="processes; never the result")
    command.add_argument("--dask", metavar="ADDRESS", help="plan the walls on a Dask cluster")
    command.add_argument(
        "--again", action="store_true",
        help="make again what is finished; finished walls are taken from DIR/runs",
    )  # fmt: skip
    command.add_argument("--json", action="store_true", help="print as JSON")
    command.add_argument("--quiet", action="store_true", help="no progress")


_COMMANDS: dict[str, tuple[str, Callable[[argparse.ArgumentParser], None]]] = {
    "plan": ("Plan a wall from an image of stones.", add_plan),
    "demo": ("Plan a generated stone set; no arguments needed, works offline.", add_demo),
    "stones": ("Say what is read from an image of stones.", _stones),
    "analyse": ("Limit analysis of a wall: load multipliers and mechanism.", _analyse),
    "measure": ("Measure filling, arrangement and lateral resistance of a wall.", _measure),
    "check": ("Re-derive a wall from stones and plan and verify every claim.", _check),
    "export": ("Write a plan for robots, drawings and films: see --list.", add_export),
    "craft": ("Look at a wall as a mason does: rules by name, stones and steps.", add_craft),
    "markers": ("Print a sheet of markers that give photographs a scale.", add_markers),
    "segment": ("Find stones in a photograph.", add_segment),
    "bench": ("Show how good the numbers are, and compare methods of choosing stones.", add_bench),
    "generate": ("Make a synthetic stone set.", _generate),
    "reproduce": ("Make tables and figures of the paper again, with a report.", _reproduce),
    "fetch": ("Download published stone sets, with licence and what to cite.", _fetch),
}
