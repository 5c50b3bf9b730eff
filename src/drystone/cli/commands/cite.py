"""`drystone cite`: how to cite the program and the method, as CITATION.cff in the repository."""

import argparse
from importlib.metadata import version

from drystone.errors import ExitCode

BIBTEX = """\
@software{{drystone,
  title = {{drystone: a planner for dry-stone walls}},
  author = {{{{The drystone developers}}}},
  version = {{{version}}},
  date = {{2026-11-26}},
  license = {{MIT}},
}}
@article{{wang2024stacking,
  title = {{An image-based stacking method for {{2D}} dry-stone masonry walls}},
  author = {{Wang, Qianqing and {{dos Santos}}, Ketson R. M. and Beyer, Katrin}},
  year = {{2024}},
}}"""


def add(_: argparse.ArgumentParser) -> None:
    """Add nothing: there is nothing to choose."""


def run(_: argparse.Namespace) -> ExitCode:
    """Print BibTeX of the program and of the paper whose method it starts from."""
    print(BIBTEX.format(version=version("drystone")))
    return ExitCode.DONE
