"""Blocks that touch too little, from pixels and from polygons."""

import numpy as np
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from drystone.contacts.blocks import model_from_labels
from drystone.contacts.gaps import Scarce, scarce_contacts
from drystone.contacts.given import model_from_json, polygons_from_json


def test_a_stone_that_floats_and_one_that_touches_at_a_corner():
    wall = np.zeros((34, 60), int)
    wall[20:34, 0:30], wall[20:34, 30:60] = 1, 2
    wall[10:20, 5:20] = 3  # on 1, by an interface: it rests
    wall[5:10, 20:24] = 4  # a corner of it touches a corner of 3; 1 is 10 px below
    wall[5:15, 40:50] = 5  # 5 px above 2
    found = scarce_contacts(model_from_labels(wall).model, wall)
    assert found == (Scarce(4, 1, 1, 10.0), Scarce(5, 0, 2, 5.0))


def test_the_ground_is_a_neighbour_too():
    wall = np.zeros((12, 30), int)
    wall[6:12, 0:10], wall[0:9, 20:28] = 1, 2
    found = scarce_contacts(model_from_labels(wall).model, wall)
    assert [(one.block, one.nearest, one.gap) for one in found] == [(2, 0, 3.0)]


def test_polygons():
    data = {"blocks_xywh": [[0, 0, 4, 2], [0, 2.5, 4, 2], [6, 1, 2, 2]], "mu": 0.6}
    found = scarce_contacts(model_from_json(data), polygons_from_json(data))
    assert [(one.block, one.contacts, one.nearest, one.gap) for one in found] == [
        (2, 0, 1, 0.5),
        (3, 0, 0, 1.0),
    ]


@given(arrays(np.int64, (9, 12), elements=st.integers(0, 4)))
def test_gaps_are_those_between_all_pixels(cells):
    """A slow twin: every pair of pixels."""
    if not (cells > 0).any():
        return
    wall = cells[: np.flatnonzero((cells > 0).any(axis=1))[-1] + 1]
    model = model_from_labels(wall).model
    touched = {}
    for face in model.interfaces:
        touched.setdefault(face.block, set()).add(face.other)
        touched.setdefault(face.other, set()).add(face.block)
    ground = [(wall.shape[0], col) for col in range(wall.shape[1])]
    for one in scarce_contacts(model, cells):
        own = np.argwhere(wall == one.block)
        strangers = {i: np.argwhere(wall == i) for i in np.unique(wall) if i not in (0, one.block)}
        strangers[0] = np.array(ground)
        gaps = [
            np.hypot(*(own[:, None] - other[None]).transpose(2, 0, 1)).min() - 1.0
            for i, other in strangers.items()
            if i not in touched.get(one.block, set())
        ]
        assert one.gap == (min(gaps) if gaps else np.inf)
