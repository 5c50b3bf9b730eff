"""Commands of the lab for the command line of drystone; each is imported when it is run."""

from drystone.cli.parser import Command, run_of
from drystone_lab.commands.options import add_bench, add_fetch, add_reproduce

BENCH = Command(
    "Test the numbers, and compare ways of choosing stones.",
    add_bench,
    run_of("drystone_lab.commands.bench"),
)
REPRODUCE = Command(
    "Make the tables and figures of the paper again.",
    add_reproduce,
    run_of("drystone_lab.commands.reproduce"),
)
FETCH = Command(
    "Download published stone sets, with licence and citation.",
    add_fetch,
    run_of("drystone_lab.commands.fetch"),
)
