"""What a command is, and the commands of other packages, by their entry points."""

import argparse
from collections.abc import Callable
from importlib import import_module
from typing import NamedTuple, NoReturn

from drystone.errors import UsageError

GROUP = "drystone.commands"
"""Of entry points; each names a :class:`Command`."""

STUDIES = ("bench", "reproduce", "fetch")
"""Commands that every installation has, and whose code is not in this package."""


class Command(NamedTuple):
    """A command of the command line.

    Parameters
    ----------
    text : str
        What it does, in a sentence.
    add : callable
        Adds its options to a parser.
    run : callable
        Does it, and returns the exit code.
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
