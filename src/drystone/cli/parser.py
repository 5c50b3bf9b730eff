"""Commands and options, also the commands of other packages, by their entry points."""

import argparse
import re
from collections.abc import Callable, Mapping, Sequence
from importlib import import_module
from itertools import chain
from typing import Any, NamedTuple, NoReturn

from drystone.errors import UsageError, meant

GROUP = "drystone.commands"
"""Of entry points; each names a :class:`Command`."""

_SUMMARY = "Plan dry-stone walls from the stones that you have, and test whether they stand."

STUDIES = ("bench", "reproduce", "fetch")
"""Commands that every installation has, and whose code is not in this package."""

_CHOICE = re.compile(r"argument ([^:]*): invalid choice: '(.*?)'.*\(choose from (.*)\)", re.DOTALL)
"""What argparse says of a command, or a value of an option, that there is not."""

_COMMANDS = {
    "demo": "Plan a sample wall: no arguments, no network.",
    "stones": "Show what is read from a picture or drawing of stones.",
    "markers": "Print a sheet of markers that gives photographs a scale.",
    "segment": "Find the stones in a photograph.",
    "trace": "Draw the stones of a wall over its photograph, in a browser.",
    "plan": "Plan a wall from stones: which goes where, and in which order.",
    "settings": "List what plan --set and --settings can change.",
    "export": "Write a plan for robots, for drawings, or as a film.",
    "check": "Build a plan again from its stones, and verify every claim.",
    "analyse": "Compute which sideways load brings a wall down, and how.",
    "measure": "Measure how full, how regular and how strong a wall is.",
    "craft": "Judge a wall by masons' rules, stone by stone.",
    "rehearse": "Build a plan again and again with a builder's errors.",
    "generate": "Make a set of artificial stones.",
    "cite": "Print how to cite drystone and the paper, as BibTeX.",
}

_PATHS = ("DIR", "FILE", "PHOTO", "PICTURE", "PLAN", "SHEET", "STONES", "WALL")
"""What help calls paths, before the ending of a file."""

_TASKS = {
    "first": ("demo", "stones"),
    "build": ("markers", "segment", "trace", "plan", "settings", "export"),
    "judge": ("check", "analyse", "measure", "craft", "rehearse"),
    "study": ("reproduce", "bench", "fetch", "generate", "cite"),
}
"""Commands in the order of work; those that are not here come last, and some may not be there."""


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
        except (Exception, SystemExit) as error:
            why = f"{entry.value}: {type(error).__name__}: {error}"
            commands[entry.name] = _broken(entry.name, why)
    return commands


def _broken(name: str, why: str) -> Command:
    def add(command: argparse.ArgumentParser) -> None:
        command.prefix_chars = "\0"  # its options are not known: all that follows is taken
        command.add_argument("options", nargs="*")

    def run(_: argparse.Namespace) -> NoReturn:
        cure = "Install drystone again, or the package that the command is of."
        raise UsageError("E154", f"the command cannot be loaded: {why}.", where=name, cure=cure)

    return Command("(cannot be loaded)", add, run)


def build_parser(words: Sequence[str] | None = None) -> argparse.ArgumentParser:
    """Return the parser of the command line.

    Only the command that `words` name is loaded, and none for help, which must not wait for NumPy.
    Without words all commands are.
    """
    asked = None if words is None else next((one for one in words if one[:1] != "-"), "")
    others = {} if asked in _COMMANDS else found_commands()
    texts = _COMMANDS | {name: command.text for name, command in others.items()}
    parser = _Parser(
        prog="drystone",
        usage="drystone [-h] [--version] COMMAND ...",
        description=f"{_SUMMARY}\n\n{_table(texts)}",
        epilog="drystone COMMAND --help explains a command. New here? Try: drystone demo",
        formatter_class=argparse.RawDescriptionHelpFormatter,
        add_help=False,
    )
    hidden = argparse.SUPPRESS
    parser.add_argument("-h", "--help", action="help", help=hidden)
    parser.add_argument("--version", action=_Version, nargs=0, help=hidden)
    listed = parser.add_subparsers(prog="drystone", dest="command", metavar="COMMAND", help=hidden)
    parser.set_defaults(run=lambda _: parser.print_help())
    for name, text in texts.items():
        sub = listed.add_parser(name, description=text)
        if asked in (None, name):
            module = f"drystone.cli.commands.{name}"
            command: Any = import_module(module) if name in _COMMANDS else others[name]
            # The traceback of an error is for those who look for a fault.
            sub.add_argument("--debug", action="store_true", help=hidden)
            command.add(sub)
            sub.set_defaults(run=command.run)
    return parser


def _table(texts: Mapping[str, str]) -> str:
    rest = {"other": [name for name in texts if name not in chain(*_TASKS.values())]}
    lines = []
    for task, names in (_TASKS | rest).items():
        known = [name for name in names if name in texts]
        lines += [f"{'' if i else task:6} {name:10} {texts[name]}" for i, name in enumerate(known)]
    return "\n".join(lines)


def list_only(command: argparse.ArgumentParser, *names: str) -> None:
    """Leave out of the help what a command takes so far, but its arguments and options `names`."""
    for action in command._actions:  # noqa: SLF001 - argparse has no other way
        if action.option_strings and not {"-h", *names} & {*action.option_strings}:
            action.help = argparse.SUPPRESS


class _Parser(argparse.ArgumentParser):
    """Says what is wrong in one line, with a code (E138), and where help is."""

    def error(self, message: str) -> NoReturn:
        cure = f"`{self.prog} --help` explains."
        if (choice := _CHOICE.search(message)) is not None:
            known = re.findall(r"[\w-]+", choice[3])
            if choice[1] == "COMMAND":
                message = f"there is no command {choice[2]!r}"
                cure = "`drystone --help` lists the commands."
            cure = meant(choice[2], known, "drystone " if choice[1] == "COMMAND" else "") + cure
        elif (option := re.match(r"unrecognized arguments: (--[\w-]+)", message)) is not None:
            cure = meant(option[1], self._option_string_actions) + cure
        elif lacks := re.search(r"(--[\w-]+)\S*: expected one argument", message):
            cure = f"Give it one; one that begins with a minus so: {lacks[1]}=-1. {cure}"
        coded = UsageError("E138", f"{message}.", cure=cure)
        self.exit(int(coded.exit_code), f"drystone: {coded}\n")

    def parse_known_args(self, args: Any = None, namespace: Any = None) -> Any:
        """Refuse what a command does not know: it knows what was meant.

        An empty path, as an unset variable of a shell gives, would be the current folder.
        """
        found, rest = super().parse_known_args(args, namespace)
        for action in self._actions:
            kind = str(action.metavar).partition(".")[0]
            if kind in _PATHS and getattr(found, action.dest, None) == "":
                self.error(f"argument {'/'.join(action.option_strings) or kind}: the path is empty")
        if rest:
            self.error(f"unrecognized arguments: {' '.join(rest)}")
        return found, rest


class _Version(argparse.Action):
    """Looks the version up only when it is asked for."""

    def __call__(self, parser: argparse.ArgumentParser, *_: object) -> None:
        from importlib.metadata import version  # noqa: PLC0415 - costs start-up time

        from drystone.kernels.backend import describe  # noqa: PLC0415

        print(f"drystone {version('drystone')} (kernels: {describe()})")
        parser.exit()
