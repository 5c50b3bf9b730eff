"""What the items of §6 share: the task of §5.1, and how it was timed."""

from drystone_lab.reproduce.base import PR, PaperWall
from drystone_lab.reproduce.item import Context
from drystone_lab.timed_walls import Task

REPEATS = 3
"""Of each wall; the quickest of every step counts."""

ONE_PROCESS = (
    "Times are of one process with one thread and differ from machine to machine; where the paper "
    "gives times, they are of several processes on an i7-10700 of 2.9 GHz."
)


def task_of(context: Context, wall: PaperWall = PR) -> Task:
    """Return the stones and the size of a wall, to be planned by the clock.

    Parameters
    ----------
    context : Context
        Gives the published data.
    wall : PaperWall
        With a width and a height.
    """
    return Task(wall.name, wall.source.stones(context.data), (wall.width, wall.height))


def repeats(context: Context) -> int:
    """Return how often a wall is planned."""
    return 1 if context.quick else REPEATS


def how_timed(context: Context) -> str:
    """Return how the times came about, in a sentence or two."""
    often = repeats(context)
    if often == 1:
        return ONE_PROCESS
    return f"{ONE_PROCESS} Each wall is planned {often} times, and the quickest of a step counts."
