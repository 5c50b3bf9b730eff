import numpy as np
from hypothesis import given

from drystone.contacts.blocks import notice_of_pieces, pieces_apart
from tests.naive import contacts as naive
from tests.strategies import dust_labels, label_images, repeatable


@given(labels=label_images() | dust_labels())
@repeatable(80)
def test_pieces_apart_are_those_of_every_stone_alone(labels):
    assert pieces_apart(labels) == tuple(sorted(naive.pieces_apart(labels).items()))


def test_the_notice_names_five_stones_and_counts_the_others():
    labels = np.zeros((3, 28), np.uint32)
    labels[0, ::4], labels[2, ::4] = range(1, 8), range(1, 8)
    (notice,) = notice_of_pieces(labels)
    assert notice.code == "W304"
    assert notice.message.startswith("1 pixel of stone 1, 1 pixel of stone 2, ")
    assert "1 pixel of stone 5, pixels of 2 more lie apart from them" in notice.message


def test_an_empty_image_has_no_pieces():
    assert pieces_apart(np.zeros((0, 0), np.uint32)) == ()
    assert pieces_apart(np.zeros((2, 3), np.uint32)) == ()
