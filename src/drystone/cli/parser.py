"""Commands and options."""

import argparse
from collections.abc import Callable, Sequence
from typing import NoReturn

from drystone.cli.analyse_options import add_loads, add_model, add_scatter
from drystone.cli.command import Command, found_commands, run_of
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


def build_parser(words: Sequence[str] = ()) -> argparse.ArgumentParser:
    """Return the parser of the command line.

    Parameters
    ----------
    words : sequence of str
        That are to be parsed.  When they begin with a command of this package, those of others
        are not looked for.
    """
    parser = _Parser(
        prog="drystone",
        description="Plans dry-stone walls from images of found stones.",
        epilog="drystone COMMAND --help explains a command. Start with: drystone demo",
        formatter_class=_Listed,
    )
    parser.add_argument("--version", action=_Version, nargs=0, help="print the version")
    commands = {
        name: Command(text, add, run_of(f"drystone.cli.commands.{name}"))
        for name, (text, add) in _COMMANDS.items()
    }
    if not words or words[0] not in commands:
        commands = {**commands, **found_commands(), **commands}
    listed = parser.add_subparsers(dest="command", metavar="COMMAND", required=True)
    for name, command in commands.items():
        sub = listed.add_parser(name, help=command.text, description=command.text)
        sub.add_argument("--debug", action="store_true", help="show the traceback of an error")
        command.add(sub)
        sub.set_defaults(run=command.run)
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
    "generate": ("Make a synthetic stone set.", _generate),
}
