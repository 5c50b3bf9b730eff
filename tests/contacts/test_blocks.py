"""Blocks of label images, and the interfaces between them."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from drystone.contacts.blocks import model_from_labels, model_with, notices_of, pieces_apart
from drystone.contacts.interfaces import PointContacts, find_interfaces
from drystone.errors import InputError, LabelImageError
from drystone.kernels.patches import painted_patch
from drystone.model.placement import Placement, Wedge
from drystone.model.pose import PosedStone
from drystone.model.stone import Stone
from drystone.statics.model import GROUND, RigidBlockModel
from tests.naive import contacts as naive
from tests.statics.walls import told
from tests.strategies import dust_labels, label_images, repeatable

pictures = arrays(
    np.uint32, st.tuples(st.integers(1, 10), st.integers(1, 10)), elements=st.integers(0, 4)
)


def placed(labels, block_id):
    """The pixels of one id as a placement."""
    rows, cols = np.nonzero(labels == block_id)
    mask = (labels == block_id)[rows.min() : rows.max() + 1, cols.min() : cols.max() + 1].copy()
    posed = PosedStone(Stone(block_id, [[True]]), 0.0, 1.0, mask, (0.0, 0.0))
    return Placement(posed, int(rows.min()), int(cols.min()))


def test_empty_rows_below_are_cropped_and_that_is_said():
    labels = np.pad(np.ones((40, 20), np.uint32), ((0, 10), (5, 5)))
    picture = model_from_labels(labels, mu=0.4)
    assert picture.ground_row == 40
    (notice,) = picture.notices
    assert notice.code == "W301"
    assert "10 empty rows" in str(notice)
    assert picture.model.blocks[0].centroid == (15.0, 20.0)
    assert picture.model.interfaces[0].other == GROUND
    assert picture.model.mu == 0.4
    with pytest.raises(InputError, match="E302"):
        model_from_labels(labels, mu=-0.1)


def test_an_empty_image_has_no_blocks():
    empty = [np.zeros(shape, np.uint32) for shape in ((4, 5), (4, 0), (0, 3))]
    for labels in (*empty, np.ma.masked_all((4, 5), np.uint32)):
        picture = model_from_labels(labels)
        assert (picture.model.blocks, picture.model.interfaces) == ((), ())
        assert (picture.ground_row, picture.notices) == (len(labels), ())
    assert pieces_apart(np.zeros((0, 0), np.uint32)) == ()


@pytest.mark.parametrize(
    "labels",
    [np.ones(4, np.uint32), np.ones((2, 2)), np.array([[1, -1]]), np.ones((2, 2, 3), np.uint8),
     np.array([[1, 2**63]], np.uint64), np.ones((2, 2), bool), None],
)  # fmt: skip
def test_what_is_no_label_image_is_refused(labels):
    for one in (labels, np.asarray(labels).tolist()):
        with pytest.raises(LabelImageError, match="E301"):
            model_from_labels(one)


@given(labels=pictures, order=st.permutations(range(1, 5)), with_wedge=st.booleans())
@repeatable(100)
def test_stone_after_stone_gives_the_model_of_the_whole(labels, order, with_wedge):
    labels = labels.copy()
    labels[-1, 0] = 1  # something on the lowest row, so that nothing is cropped
    present = [block for block in order if (labels == block).any()]
    built, model = np.zeros_like(labels), RigidBlockModel((), (), 0.5)
    while present:
        first, *wedges = present[: 1 + with_wedge]
        present = present[1 + with_wedge :]
        before = built.copy()
        places = [placed(labels, wedge) for wedge in wedges]
        parts = tuple(Wedge(p.stone_id, first, p.posed.mask, p.row, p.col) for p in places)
        model = model_with(model, built, placed(labels, first), parts)
        assert (built == before).all()
        new = np.isin(labels, [first, *wedges])
        built[new] = labels[new]
    expected = model_from_labels(labels, 0.5).model
    assert sorted(told(model.interfaces)) == sorted(told(expected.interfaces))
    assert model.mu == expected.mu
    blocks = sorted(model.blocks, key=lambda block: block.id)
    for block, other in zip(blocks, expected.blocks, strict=True):
        assert (block.id, block.area) == (other.id, other.area)
        assert block.centroid == pytest.approx(other.centroid, abs=1e-12)


@given(labels=pictures, first=st.integers(1, 4))
@repeatable(100)
def test_points_known_before_change_nothing(labels, first):
    labels = labels.copy()
    labels[-1, 0], labels[-1, -1] = 1, first
    wall = np.where(labels == first, 0, labels)
    model, new = model_from_labels(labels).model, placed(labels, first)
    model = RigidBlockModel(model.blocks, find_interfaces(wall), model.mu)
    anew = model_with(model, wall, new)
    for interfaces in (model.interfaces, find_interfaces(labels)):
        found = model_with(model, wall, new, points=PointContacts.of(interfaces))
        assert (found.blocks, found.added.closed) == (anew.blocks, anew.added.closed)
        assert told(found.interfaces) == told(anew.interfaces)


@given(labels=label_images() | dust_labels())
@repeatable(80)
def test_pieces_apart_are_those_of_every_stone_alone(labels):
    assert pieces_apart(labels) == tuple(sorted(naive.pieces_apart(labels).items()))


def test_the_notice_names_five_stones_and_counts_the_others():
    labels = np.zeros((3, 28), np.uint32)
    labels[0, ::4], labels[2, ::4] = range(1, 8), range(1, 8)
    (notice,) = notices_of(labels)
    assert notice.code == "W304"
    assert notice.message.startswith("1 pixel of stone 1, 1 pixel of stone 2, ")
    assert "1 pixel of stone 5, pixels of 2 more lie apart from them" in notice.message


@given(angle_deg=st.floats(-180, 180), offset=st.floats(-1, 1), size=st.integers(10, 60))
@repeatable(200)
def test_a_tilted_joint_is_one_run_with_a_bounded_error_of_its_normal(angle_deg, offset, size):
    angle = math.radians(angle_deg)
    row, col = np.mgrid[:size, :size]
    x, y = col + 0.5 - size / 2, size / 2 - row - 0.5
    normal = (-math.sin(angle), math.cos(angle))
    labels = np.where(x * normal[0] + y * normal[1] > offset, 2, 1).astype(np.uint32)
    (run,) = (i for i in find_interfaces(labels) if i.other == 1)
    error = math.acos(min(1.0, run.normal[0] * normal[0] + run.normal[1] * normal[1]))
    # Half a pixel up at one end and down at the other, and some for runs of a few steps.
    assert error * run.length < 1.6
    assert (run.points[1] - run.points[0]) @ (normal[1], -normal[0]) > 0  # the block to its left
    away = run.points - size / 2
    assert np.abs(away @ normal - offset).max() <= 0.5**0.5 + 1e-9


@given(seed=st.integers(0, 2**32), row=st.integers(0, 21), col=st.integers(0, 17))
@repeatable(100)
def test_the_contacts_that_are_closed_in_are_those_that_are_there_no_more(seed, row, col):
    labels = np.random.default_rng(seed).choice([0, 0, 0, 1, 2, 3, 4], (24, 20)).astype(np.uint32)
    mask = labels[row : row + 3, col : col + 5] == 0
    grown = labels.copy()
    grown[row : row + 3, col : col + 5][mask] = 9
    patch, _ = painted_patch(labels, [(9, row, col, mask)])
    found = find_interfaces(labels)
    left = [each[:3] for each in told(find_interfaces(grown))]
    before = [each[:3] for each in told(found)]
    gone = [k for k, each in enumerate(before) if len(each[2]) == 1 and each not in left]
    assert list(PointContacts.of(found).closed_in(patch)) == gone
