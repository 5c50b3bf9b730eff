"""Commands and options."""

import argparse
from collections.abc import Sequence
from importlib import import_module
from typing import Any, NoReturn

from drystone.cli.command import found_commands
from drystone.errors import UsageError


def build_parser(words: Sequence[str] | None = None) -> argparse.ArgumentParser:
    """Return the parser of the command line.

    Parameters
    ----------
    words : sequence of str, optional
        That are to be parsed.  Only the command that they name is loaded, and help none: it must
        not wait for NumPy.  Without them all commands are.
    """
    parser = _Parser(
        prog="drystone",
        description="Plans dry-stone walls from images of found stones.",
        epilog="drystone COMMAND --help explains a command. Start with: drystone demo",
        formatter_class=_Listed,
    )
    parser.add_argument("--version", action=_Version, nargs=0, help="print the version")
    asked = None if words is None else next((one for one in words if one[:1] != "-"), "")
    listed = parser.add_subparsers(dest="command", metavar="COMMAND", required=True)
    others = {} if asked in _COMMANDS else found_commands()
    for name in dict.fromkeys((*_COMMANDS, *others)):
        text = _COMMANDS.get(name) or others[name].text
        sub = listed.add_parser(name, help=text, description=text)
        if asked in (None, name):
            module = f"drystone.cli.commands.{name}"
            command: Any = import_module(module) if name in _COMMANDS else others[name]
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


_COMMANDS = {
    "plan": "Plan a wall from an image of stones.",
    "demo": "Plan a generated stone set; no arguments needed, works offline.",
    "stones": "Say what is read from an image of stones.",
    "analyse": "Limit analysis of a wall: load multipliers and mechanism.",
    "measure": "Measure filling, arrangement and lateral resistance of a wall.",
    "check": "Re-derive a wall from stones and plan and verify every claim.",
    "export": "Write a plan for robots, drawings and films: see --list.",
    "craft": "Look at a wall as a mason does: rules by name, stones and steps.",
    "markers": "Print a sheet of markers that give photographs a scale.",
    "segment": "Find stones in a photograph.",
    "generate": "Make a synthetic stone set.",
}
