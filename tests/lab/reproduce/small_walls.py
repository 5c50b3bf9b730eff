"""Small generated walls on which the items about the method are made without published data."""

from dataclasses import replace

from drystone_lab.reproduce.item import Context, StudyWalls
from drystone_lab.reproduce.items import item_named
from drystone_lab.runs.outcome import FIGURES, Runner, RunOutcome
from drystone_lab.runs.spec import generated
from drystone_lab.walls import Target

RUBBLE = Target(
    "rubble", generated("rubble", 3, count=12, width_px=128, height_px=54, courses=4), 136, 58, 1.0
)

SHARP = Target("sharp", generated("polygon", 3, count=14, noise=0.3), 700, 300, 0.2)
"""Polygons of which most fall where they are tried."""


def context(folder, data=None):
    """A context that keeps its runs in a folder."""
    return Context(Runner(folder, data))


def on(name, *walls, seeds=2):
    """An item that builds walls, of these and from so many seeds."""
    item = item_named(name)
    worded = item.words["study"].get("ways", {"variant": {}})
    ways = {way: tuple(changes.items()) for way, changes in worded.items()}
    return replace(
        item, study=lambda c: StudyWalls.built(c, walls, ways, [c.seed + k for k in range(seeds)])
    )


def of(name, *given):
    """An item whose study takes these instead of what it usually takes."""
    item = item_named(name)
    return replace(item, study=lambda context: item.study(context, *given))


def outcome(key="", **figures):
    """An outcome of 10 stones with everything else 1, but for the figures that are named."""
    every = {**dict.fromkeys(FIGURES, 1), "stones": 10, **figures}
    return RunOutcome(key, every, {"steps": []}, {})


def gids(output, picture):
    """Names of everything that is drawn in a picture."""
    (figure,) = [one.figure for one in output.pictures if one.name == picture]
    children = [artist for ax in figure.axes for artist in ax.get_children()]
    return [str(artist.get_gid()) for artist in children if artist.get_gid() is not None]


def rows(output, table):
    """The rows of a table, a dict each."""
    (found,) = [one for name, one in output.tables if name == table]
    return list(found.records())
