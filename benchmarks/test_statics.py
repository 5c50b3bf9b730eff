"""Contacts, and the limit analysis of candidates."""

from statistics import fmean

import numpy as np
import pytest
from tests.naive import statics as naive
from tests.naive.contacts import directed_edges

from benchmarks.conftest import Row, Timer
from benchmarks.scenes import Scene, places, standing
from drystone.contacts.blocks import model_from_labels, model_with
from drystone.contacts.interfaces import PointContacts, find_interfaces
from drystone.model.placement import Placement

ONE = "contacts of one more stone"
ALL = "contacts of a whole image"
LIMIT = "limit analysis of a candidate, both tilts"
LOOPS = "loops over all pixels"


def test_contacts(timer: Timer, scene: Scene) -> None:
    """Put each stone on the wall in turn."""
    model = model_from_labels(scene.wall.labels).model
    points = PointContacts.of(model.interfaces)  # once a step, as the planner does
    found = [Placement(*place) for place in places(scene)]

    def call() -> None:
        for placement in found:
            model_with(model, scene.wall.labels, placement, points=points)

    each = fmean(placement.posed.mask.size for placement in found)
    item = "pixels of the stone's box"
    timer.often(Row(ONE, scene.name, scene.pixels, None, len(found), each, item), call)


def test_all_contacts(timer: Timer, scene: Scene) -> None:
    """Find all interfaces anew."""
    row = Row(ALL, scene.name, scene.pixels, items=scene.pixels, item="pixels")
    timer.often(row, lambda: find_interfaces(scene.wall.labels))


@pytest.mark.slow
@pytest.mark.parametrize("what", [ONE, ALL])
def test_contacts_slowly(timer: Timer, scene: Scene, what: str) -> None:
    """Look at all pixels for edges and corners; they are not yet traced and fitted."""
    labels = np.array(scene.wall.labels)
    if what == ONE:
        posed, row, col = places(scene)[0]
        placement = Placement(posed, row, col)
        labels[placement.window][posed.mask] = placement.stone_id

    def call() -> None:
        directed_edges(labels)
        naive.diagonal_touches(labels)

    timer.times(1, Row(what, scene.name, scene.pixels, LOOPS), call)


def test_limit(timer: Timer, count: int) -> None:
    """Ask for the resistance of a wall with each of some stones on top."""
    wall = standing(count)

    def call() -> None:
        for model in wall.candidates:
            wall.analysis.resistance_with(model)

    # Two edges of a friction cone at a contact point, with three entries on either side.
    each = 12.0 * wall.analysis.model.contact_count
    item = "coefficients of the contact forces"
    size = f"{count} stones"
    timer.often(Row(LIMIT, size, count, None, len(wall.candidates), each, item), call)


@pytest.mark.slow
def test_limit_slowly(timer: Timer, count: int) -> None:
    """The same by a fresh linprog for every tilt."""
    wall = standing(count)

    def call() -> None:
        for model in wall.candidates:
            naive.alphas_by_linprog(model)

    row = Row(LIMIT, f"{count} stones", count, "a fresh linprog a tilt", len(wall.candidates))
    timer.times(2, row, call)
