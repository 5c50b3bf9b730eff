"""Entry point: parse, dispatch, and turn errors into exit codes."""

import sys
from collections.abc import Sequence
from importlib import import_module

from drystone.cli.parser import build_parser
from drystone.errors import DrystoneError, ExitCode


def main(argv: Sequence[str] | None = None) -> int:
    """Run the command line; return the exit code (DESIGN 2).

    0 done, 2 usage, 3 bad input, 4 wall incomplete, 5 a check failed, 130 interrupted.
    """
    arguments = build_parser().parse_args(argv)
    # Commands are imported when they are called: --help must not wait for NumPy.
    command = import_module(f"drystone.cli.commands.{arguments.command}")
    try:
        return int(command.run(arguments))
    except DrystoneError as error:
        if arguments.debug:
            raise
        print(f"drystone: {error}", file=sys.stderr)
        return int(error.exit_code)
    except KeyboardInterrupt:
        print("drystone: interrupted", file=sys.stderr)
        return int(ExitCode.INTERRUPTED)
    except BrokenPipeError:
        # The reader of our output went away, as in `drystone stones X | head`.
        sys.stderr.close()
        return int(ExitCode.DONE)
