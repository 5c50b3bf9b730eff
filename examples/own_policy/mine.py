"""A policy of one's own: large stones low, and among equals what carries most."""

from collections.abc import Sequence

import numpy as np

from drystone.selection.policy import Offer


class MyPolicy:
    """The largest stone for its height; LLC decides among those within a tenth."""

    def choose(self, candidates: Sequence[Offer], rng: np.random.Generator) -> int | None:
        """Return the position of the stone to build."""
        worth = [
            offer.area_px * (1 - offer.centroid_px[1] / offer.wall_height_px)
            for offer in candidates
        ]
        good = [k for k, value in enumerate(worth) if value >= 0.9 * max(worth)]
        best = max(candidates[k].indices.LLC or 0.0 for k in good)
        level = [k for k in good if (candidates[k].indices.LLC or 0.0) >= best - 1e-9]
        return int(rng.choice(level))
