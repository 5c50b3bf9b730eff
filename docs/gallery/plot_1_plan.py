"""
Plan a wall from a generated stone set
======================================

From a pile of stones to a wall: make a set of rubble, plan a wall from it, and draw both.
"""

import matplotlib.pyplot as plt
import numpy as np

import drystone as ds
from drystone.drawing.pictures.stones import plot_stones
from drystone.drawing.pictures.wall import plot_wall

# %%
# Ten stones in three course heights, enough for a wall of 130 x 50 px. Any image of labels is
# read by :func:`drystone.read_stones`; here the stones are drawn at random.

rubble = ds.generate.RubbleSettings(
    count=10, width_px=130, height_px=50, courses=3, area_ratio=0.86
)
stones = ds.generate.rubble_stones(rubble, np.random.default_rng(4))

# %%
# A budget of four walls: the best of them is the plan. The same seed and budget give the same
# plan everywhere.

settings = ds.method_settings("best").updated({"search": {"budget": 4}})
result = ds.plan_wall(stones, 130, 50, seed=1, settings=settings)
print(result.message)
print(f"placed: {len(stones) - len(result.plan.unused)} of {len(stones)}")
print(f"F_SF {result.metrics.F_SF:.3f}, F_LR {result.metrics.F_LR:.3f}")

# %%
# Colours are clusters of similar stones, numbers the order of placement, wedges are dark red.

figure, (above, below) = plt.subplots(2, figsize=(7, 6.5), layout="constrained")
plot_stones(stones, result.clusters, above)
above.set_title("stones", fontsize=9)
plot_wall(result.wall, result.clusters, below)
below.set_title("wall", fontsize=9)

# %%
# Every step says what a builder needs: which stone, how far it is turned, where its centroid goes.

for step in result.plan.steps[:5]:
    if step.kind == "stone":
        x, y = step.centroid
        turned = f"stone {step.stone} turned by {step.angle_deg:.1f} deg"
        print(f"step {step.step}: {turned}, centroid at {x:.1f}, {y:.1f} px")

# %%
# At the end of a notebook's cell a result shows itself: step through it, choose stones, look at
# forces and at how it fails.

result
