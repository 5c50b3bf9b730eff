"""`drystone demo`: a generated stone set, from pile to report, offline."""

import argparse
from pathlib import Path

import numpy as np

from drystone.cli.choice import files_of_choice
from drystone.cli.inputs import refuse_inputs
from drystone.cli.keeping import WRITTEN
from drystone.cli.numbers import add_scale
from drystone.cli.output import working_in
from drystone.cli.parser import list_only
from drystone.cli.planning import add_writing, plan_and_write
from drystone.cli.settings import add_settings, request_from, settings_from
from drystone.errors import ExitCode
from drystone.generate.layout import lay_out
from drystone.generate.rubble import RubbleSettings, rubble_stones
from drystone.io.read_stones import read_stones
from drystone.io.wall_image import write_labels
from drystone.kernels.backend import describe
from drystone.planner.search_settings import UNLIMITED

STONES, WALL = "stones.png", (1120, 320)


def add(command: argparse.ArgumentParser) -> None:
    """Add what `drystone demo` takes."""
    command.add_argument("-o", "--output", default="drystone-demo", metavar="DIR",
                         help="folder to write to (default drystone-demo)")  # fmt: skip
    add_scale(command)
    add_settings(command)
    add_writing(command)
    list_only(command, "-o", "--overwrite", "--seed", "--time", "--json")
    # argparse cannot wrap a usage with a group of options of which none is listed.
    command.usage = "%(prog)s [-h] [-o DIR] [--overwrite] [--seed N] [--time SECONDS] [--json]"
    # What only `plan` has options for.
    command.set_defaults(ban=[], pin=[], fixed_order=False, resume=False, begin=None, seed=1)


def run(arguments: argparse.Namespace) -> ExitCode:
    """Plan a wall of coursed rubble and name the report."""
    asked = settings_from(arguments)  # wrong options are refused before anything is written
    if arguments.time is None and asked.search.budget == UNLIMITED:
        # Where nothing is compiled, each takes more than a minute.
        arguments.budget = 4 if describe() == "compiled" else 1
    folder = Path(arguments.output)
    own = () if arguments.settings is None else (Path(arguments.settings),)
    names = (STONES, *WRITTEN)
    refuse_inputs(own, [*(folder / name for name in names), *files_of_choice(folder)])
    # A third more than the wall holds: with a sixth and few tries, one in four ended too low.
    settings = RubbleSettings(count=32, width_px=1485, height_px=WALL[1])
    made = rubble_stones(settings, np.random.default_rng(arguments.seed))
    if arguments.scale is None:
        # Outlines four times finer than the planner's pixels, as photographs give them.
        arguments.scale = 0.25
    with working_in(folder, names, overwrite=arguments.overwrite):
        # The stones lie beside the plan, so that `drystone check` finds them.
        write_labels(lay_out(made), folder / STONES)
        stones = read_stones(folder / STONES)
        request = request_from(stones, WALL, arguments.px_per_m, arguments)
        return plan_and_write(request, prepared=True)
