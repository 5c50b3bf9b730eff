"""The command line: parse, call, print; no logic of its own."""

from drystone.cli.main import main

__all__ = ["main"]
