"""Blocks that settle: gaps close, stones turn onto their beds, and what falls has no place."""

import numpy as np
import pytest

from drystone.physics.scene import Scene
from drystone.physics.settled import settled

pytest.importorskip("pymunk", reason="pymunk is not installed (extra `physics`)")

BASE = np.array([[0, 0], [40, 0], [40, 10], [0, 10]], float)


def turned(outline: np.ndarray, degrees: float) -> np.ndarray:
    """Turn about the first corner, counter-clockwise."""
    c, s = np.cos(np.radians(degrees)), np.sin(np.radians(degrees))
    return outline[0] + (outline - outline[0]) @ np.array([[c, s], [-s, c]])


def test_a_stone_turns_onto_its_bed() -> None:
    flat = np.array([[10, 10], [30, 10], [30, 20], [10, 20]], float)
    found = settled(Scene({1: BASE, 2: turned(flat, 2.0)}, 0.6))
    assert found is not None
    assert np.abs(found.outlines[2][:4, 1] - flat[:, 1]).max() < 0.06
    assert np.abs(found.outlines[1][:4] - BASE).max() < 0.06


def test_a_gap_closes() -> None:
    block = np.array([[10, 13], [30, 13], [30, 23], [10, 23]], float)
    found = settled(Scene({1: BASE, 2: block}, 0.6))
    assert found is not None
    assert found.outlines[2][:, 1].min() == pytest.approx(10.0, abs=0.06)


def test_on_a_tilted_table() -> None:
    """A block leans over until the wall beside it stops it: its foot stays, its head moves."""
    post = np.array([[34, 10], [40, 10], [40, 40], [34, 40]], float)
    tall = np.array([[27, 10], [33, 10], [33, 36], [27, 36]], float)
    scene = Scene({1: BASE, 2: post, 3: tall}, 0.9, fixed=frozenset({1, 2}))
    level, tilted = settled(scene), settled(scene, 0.3)
    assert level is not None
    assert tilted is not None
    assert np.abs(level.outlines[3][:4] - tall).max() < 0.06
    # From the toe at (33, 10) it turns by asin(1 / 26) to the post.
    assert tilted.outlines[3][:, 0].max() == pytest.approx(34.0, abs=0.06)
    assert tilted.outlines[1] is scene.outlines[1]


def test_what_falls_does_not_settle() -> None:
    block = np.array([[32, 10], [52, 10], [52, 20], [32, 20]], float)
    assert settled(Scene({1: BASE, 2: block}, 0.6)) is None
