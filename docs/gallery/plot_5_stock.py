"""
A stock larger than the wall
============================

With more stones than the wall needs, choosing which to leave is part of the plan.
"""

import matplotlib.pyplot as plt
import numpy as np

import drystone as ds
from drystone.drawing.pictures.stones import plot_stones
from drystone.drawing.pictures.wall import plot_wall

# %%
# Stones for a wall of 150 x 50 px, and a wall of less than half that area to build.

rubble = ds.generate.RubbleSettings(
    count=14, width_px=150, height_px=50, courses=3
)
stones = ds.generate.rubble_stones(rubble, np.random.default_rng(1))
settings = ds.method_settings("best").updated({"search": {"budget": 3}})
result = ds.plan_wall(stones, 100, 34, seed=1, settings=settings)
left = set(result.plan.unused)
share = (
    sum(stone.area_px for stone in stones if stone.id in left)
    / stones.total_area_px
)
print(f"{len(left)} of {len(stones)} stones are left, {share:.0%} of the area")
print(f"F_SF {result.metrics.F_SF:.3f} of at most {result.F_SF_bound:.3f}")

# %%
# Cluster 1 are the stones in the wall, cluster 2 those that stay.

group = {stone.id: 2 if stone.id in left else 1 for stone in stones}
figure, (above, below) = plt.subplots(2, figsize=(7, 6.5), layout="constrained")
plot_stones(stones, group, above)
above.set_title("blue: used, yellow: left", fontsize=9)
plot_wall(result.wall, group, below)
below.set_title("wall", fontsize=9)

# %%
# A stone that must be in the wall is pinned, one that must not is banned:

wanted, unwanted = (
    min(left),
    next(stone.id for stone in stones if stone.id not in left),
)
again = ds.plan_wall(
    stones,
    100,
    34,
    seed=1,
    settings=settings.updated({"pin": [wanted], "ban": [unwanted]}),
)
print(f"stone {wanted} is left: {wanted in again.plan.unused}")
print(f"stone {unwanted} is left: {unwanted in again.plan.unused}")
