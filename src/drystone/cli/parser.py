"""Commands and options, also the commands of other packages, by their entry points."""

import argparse
import re
from collections.abc import Callable, Sequence
from importlib import import_module
from typing import Any, NamedTuple, NoReturn

from drystone.errors import ExitCode, UsageError

GROUP = "drystone.commands"
"""Of entry points; each names a :class:`Command`."""

STUDIES = ("bench", "reproduce", "fetch")
"""Commands that every installation has, and whose code is not in this package."""

_UNKNOWN = re.compile(r"argument COMMAND: invalid choice: '(.*?)'.*\(choose from (.*)\)", re.DOTALL)
"""What argparse says of a command that there is not."""

_COMMANDS = {
    "plan": "Plan a wall from an image of stones.",
    "demo": "Plan a generated stone set; no arguments needed, works offline.",
    "stones": "Say what is read from an image of stones.",
    "analyse": "Limit analysis of a wall: load multipliers and mechanism.",
    "measure": "Measure filling, arrangement and lateral resistance of a wall.",
    "check": "Re-derive a wall from stones and plan and verify every claim.",
    "rehearse": "Build a plan again and again with a builder's errors: what falls.",
    "export": "Write a plan for robots, drawings and films: see --list.",
    "craft": "Look at a wall as a mason does: rules by name, stones and steps.",
    "markers": "Print a sheet of markers that give photographs a scale.",
    "segment": "Find stones in a photograph.",
    "generate": "Make a synthetic stone set.",
}


class Command(NamedTuple):
    """A command of another package: what it does in a sentence, its options, and its run.

    `add` adds its options to a parser; `run` does it and returns the exit code.
    """

    text: str
    add: Callable[[argparse.ArgumentParser], None]
    run: Callable[[argparse.Namespace], int]


def run_of(module: str) -> Callable[[argparse.Namespace], int]:
    """Return the `run` of a module that is imported when it is called.

    Help must not wait for NumPy.
    """
    return lambda arguments: int(import_module(module).run(arguments))


def found_commands() -> dict[str, Command]:
    """Return the commands that entry points name, those of :data:`STUDIES` first.

    One that is missing or cannot be loaded is there too, and says so when it is run.
    """
    from importlib.metadata import entry_points  # noqa: PLC0415 - costs start-up time

    commands = {name: _broken(name, "it is not installed") for name in STUDIES}
    for entry in sorted(entry_points(group=GROUP)):
        try:
            commands[entry.name] = entry.load()
        except Exception as error:
            why = f"{entry.value}: {type(error).__name__}: {error}"
            commands[entry.name] = _broken(entry.name, why)
    return commands


def _broken(name: str, why: str) -> Command:
    def add(command: argparse.ArgumentParser) -> None:
        command.prefix_chars = "\0"  # its options are not known: all that follows is taken
        command.add_argument("options", nargs="*")

    def run(_: argparse.Namespace) -> NoReturn:
        raise UsageError(
            "E154",
            f"the command cannot be loaded: {why}.",
            where=name,
            cure="Install drystone again, or the package that the command is of.",
        )

    return Command("(cannot be loaded)", add, run)


def build_parser(words: Sequence[str] | None = None) -> argparse.ArgumentParser:
    """Return the parser of the command line.

    Only the command that `words` name is loaded, and none for help, which must not wait for NumPy.
    Without words all commands are.
    """
    parser = _Parser(
        prog="drystone",
        description="Plans dry-stone walls from images of found stones.",
        epilog="drystone COMMAND --help explains a command. Start with: drystone demo",
        formatter_class=_Listed,
    )
    parser.add_argument("--version", action=_Version, nargs=0, help="print the version")
    asked = None if words is None else next((one for one in words if one[:1] != "-"), "")
    listed = parser.add_subparsers(dest="command", metavar="COMMAND")
    parser.set_defaults(run=lambda _: _print_help(parser))
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


def _print_help(parser: argparse.ArgumentParser) -> int:
    parser.print_help()
    return ExitCode.DONE


class _Listed(argparse.HelpFormatter):
    """Has room for names of commands, whose indentation argparse forgets, beside their texts."""

    def add_argument(self, action: argparse.Action) -> None:
        super().add_argument(action)
        self._action_max_length = max(self._action_max_length, 13)


class _Parser(argparse.ArgumentParser):
    """Says what is wrong in one line, with a code (E138), and where help is."""

    def error(self, message: str) -> NoReturn:
        coded = UsageError("E138", f"{message}.", cure=f"`{self.prog} --help` explains.")
        unknown = _UNKNOWN.search(message)
        if unknown is not None:
            coded = _unknown(unknown[1], re.findall(r"[\w-]+", unknown[2]))
        self.exit(int(coded.exit_code), f"drystone: {coded}\n")


def _unknown(word: str, commands: Sequence[str]) -> UsageError:
    """Return the error for a command that there is not, with the one that was meant."""
    from difflib import get_close_matches  # noqa: PLC0415 - only for this

    meant = get_close_matches(word.lower(), commands, 1)
    cure = f"Did you mean `drystone {meant[0]}`? " if meant else ""
    what = f"there is no command {word!r}."
    return UsageError("E138", what, cure=f"{cure}`drystone --help` lists the commands.")


class _Version(argparse.Action):
    """Looks the version up only when it is asked for."""

    def __call__(self, parser: argparse.ArgumentParser, *_: object) -> None:
        from importlib.metadata import version  # noqa: PLC0415 - costs start-up time

        from drystone.kernels.backend import describe  # noqa: PLC0415

        print(f"drystone {version('drystone')} (kernels: {describe()})")
        parser.exit()
