"""`drystone demo`: a generated stone set, from pile to report, offline."""

import argparse
from pathlib import Path

import numpy as np

from drystone.cli.output import prepare_folder
from drystone.cli.planning import plan_and_write
from drystone.cli.settings import settings_from
from drystone.errors import ExitCode
from drystone.generate.layout import lay_out
from drystone.generate.rubble import RubbleSettings, rubble_stones
from drystone.io.read_stones import read_stones
from drystone.io.wall_image import write_labels


def run(arguments: argparse.Namespace) -> ExitCode:
    """Plan a wall of coursed rubble and name the report."""
    settings_from(arguments)  # wrong options are refused before anything is written
    settings = RubbleSettings(count=24, width_px=1120, height_px=320)
    made = rubble_stones(settings, np.random.default_rng(arguments.seed))
    folder = prepare_folder(Path(arguments.output), overwrite=arguments.overwrite)
    # The stones lie beside the plan, so that `drystone check` finds them.
    write_labels(lay_out(made), folder / "stones.png")
    arguments.overwrite = True
    if arguments.scale is None:
        # Outlines four times finer than the planner's pixels, as photographs give them.
        arguments.scale = 0.25
    stones = read_stones(folder / "stones.png")
    return plan_and_write(stones, (settings.width_px, settings.height_px), arguments)
