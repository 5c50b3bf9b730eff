"""Ids of a label image whose pixels lie apart."""

import numpy as np

from drystone.errors import Notice
from drystone.kernels.label_runs import label_runs, runs_in_pieces
from drystone.model.wall import Labels

NAMED = 5
"""A notice names this many stones."""


def pieces_apart(labels: Labels) -> tuple[tuple[int, int], ...]:
    """Return (id, pixels apart from its largest piece) of each id that is not in one piece.

    Pixels that touch at a corner are in one piece.
    """
    runs = label_runs(labels)
    ids, place = np.unique(runs.labels, return_inverse=True)
    piece = runs_in_pieces(runs)
    sizes = np.bincount(piece, runs.lengths)
    block = np.zeros(len(sizes), np.intp)
    block[piece] = place
    largest = np.zeros(len(ids))
    np.maximum.at(largest, block, sizes)
    apart = np.bincount(block, sizes, len(ids)) - largest
    return tuple((int(ids[k]), int(apart[k])) for k in np.flatnonzero(apart).tolist())


def notice_of_pieces(labels: Labels) -> tuple[Notice, ...]:
    """Say in a notice (W304) which stones have pixels that lie apart; none when none have."""
    apart = pieces_apart(labels)
    if not apart:
        return ()
    told = [f"{px} pixel{'s' * (px > 1)} of stone {block}" for block, px in apart[:NAMED]]
    if len(apart) > NAMED:
        told.append(f"pixels of {len(apart) - NAMED} more")
    one = len(apart) == 1
    verb, them = "lies" if one and apart[0][1] == 1 else "lie", "it" if one else "them"
    return (
        Notice(
            "W304",
            f"{', '.join(told)} {verb} apart from {them}; all pixels of an id are one rigid block.",
            "Give every piece an id of its own, or clean the picture.",
        ),
    )
