"""`drystone demo`: a generated stone set, from pile to report, offline."""

import argparse

import numpy as np

from drystone.cli.planning import plan_and_write
from drystone.errors import ExitCode
from drystone.generate.rubble import RubbleSettings, rubble_stones


def run(arguments: argparse.Namespace) -> ExitCode:
    """Plan a wall of coursed rubble and name the report."""
    settings = RubbleSettings()
    stones = rubble_stones(settings, np.random.default_rng(arguments.seed))
    if arguments.scale is None:
        # The generator draws at the size at which the planner works best.
        arguments.scale = 1.0
    return plan_and_write(stones, (settings.width_px, settings.height_px), arguments)
