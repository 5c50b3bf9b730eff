"""What is seen of a wall of stones that arrive, as arrays of fixed sizes."""

from collections.abc import Sequence
from typing import Any

import numpy as np
from gymnasium import spaces
from numpy.typing import NDArray

from drystone.metrics.shape import top_profile
from drystone.model.wall import Wall
from drystone.selection.policies.learned import FEATURES, features
from drystone.selection.policy import Offer
from drystone_lab.rl.episode import Episode

Floats32 = NDArray[np.float32]
Observation = dict[str, Floats32]

STONE = ("area", "width", "height")
"""Of an offer, beside its features: of the stone over the wall's, the same for all its offers but
for how it lies."""


def observation_space(offers: int, columns: int) -> spaces.Space[Observation]:
    """Return the space of :func:`observation`."""
    shape = (offers, len(FEATURES) + len(STONE))
    space: Any = spaces.Dict(
        {
            "offers": spaces.Box(-1.0, 1.0, shape, np.float32),
            "profile": spaces.Box(0.0, 1.0, (columns,), np.float32),
            "left": spaces.Box(0.0, 1.0, (2,), np.float32),
        }
    )
    found: spaces.Space[Observation] = space  # a Dict does not know of what its values are
    return found


def observation(episode: Episode, offers: int, columns: int) -> Observation:
    """Return what is seen.

    Returns
    -------
    dict of str to float32 arrays
        ``"offers"``, (offers, F): a row an offer (:data:`FEATURES`, then :data:`STONE`), zeros
        where there is none.  ``"profile"``, (columns,): height of the wall's top from its left to
        its right end, over the height that it is to have; means of equal parts of its width.
        ``"left"``, (2,): the share of the stones that have not arrived yet, and of the wall that
        is still to be filled.
    """
    fitting = max(1, len(episode.workshop.fitting))
    left = np.array([episode.waiting / fitting, 1.0 - episode.build.wall.filling])
    return {
        "offers": _rows(episode.offers, offers),
        "profile": _profile(episode.build.wall, columns),
        "left": np.clip(left, 0.0, 1.0).astype(np.float32),
    }


def _rows(offered: Sequence[Offer], offers: int) -> Floats32:
    rows = np.zeros((offers, len(FEATURES) + len(STONE)), np.float32)
    if offered:
        stone = [
            (
                o.area_px / (o.wall_width_px * o.wall_height_px),
                o.width_px / o.wall_width_px,
                (o.top_px - o.bottom_px) / o.wall_height_px,
            )
            for o in offered
        ]
        seen = np.column_stack([features(offered), np.clip(stone, 0.0, 1.0)])
        rows[: len(offered)] = seen
    return rows


def _profile(wall: Wall, columns: int) -> Floats32:
    heights = top_profile(wall.labels) / wall.site.height_px
    # Parts need not be whole columns of pixels: the mean is that of the integral between its ends.
    integral = np.concatenate([[0.0], np.cumsum(heights)])
    ends = np.linspace(0.0, wall.site.width_px, columns + 1)
    at_ends = np.interp(ends, np.arange(len(integral)), integral)
    means = np.diff(at_ends) / np.diff(ends)
    return np.asarray(np.clip(means, 0.0, 1.0), np.float32)
