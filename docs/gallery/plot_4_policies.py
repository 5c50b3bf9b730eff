"""
Two ways of choosing stones
===========================

The same stones, wall and seed; only the policy that chooses among the candidates differs.
"""

import matplotlib.pyplot as plt
import numpy as np

import drystone as ds
from drystone.drawing.pictures.wall import plot_wall

rubble = ds.generate.RubbleSettings(
    count=16, width_px=160, height_px=64, courses=4
)
stones = ds.generate.rubble_stones(rubble, np.random.default_rng(5))

# %%
# A policy chooses the stones of one pass, so the budget of the search is 1.
# ``random`` takes any candidate that stands; ``algorithm2`` (``--policy paper``)
# is the selection of Wang, dos Santos and Beyer (2024).

results = {}
for policy in ("random", "algorithm2"):
    settings = ds.method_settings("best").updated(
        {
            "selection_rule": policy,
            "search": {"budget": 1},
            "geometry": "raster",
        }
    )
    results[policy] = ds.plan_wall(stones, 160, 64, seed=1, settings=settings)

# %%
# One seed says little about a policy: compare many, as ``drystone bench`` does.

figure, axes = plt.subplots(2, figsize=(7, 6.5), layout="constrained")
for ax, (policy, result) in zip(axes, results.items(), strict=True):
    m = result.metrics
    figures = f"F_SF {m.F_SF:.3f}, F_AH {m.F_AH:.2f}, F_LR {m.F_LR:.3f}"
    plot_wall(result.wall, result.clusters, ax)
    ax.set_title(f"{policy}: {figures}", fontsize=9)
