"""
Resistance over friction
========================

How much the load multiplier depends on the coefficient of friction, which is seldom known well.
"""

from itertools import pairwise

import matplotlib.pyplot as plt
import numpy as np

import drystone as ds

# %%
# Two walls of the same bricks, 4 x 2 units: a low one and a slender one, in running bond.


def running_bond(courses: int, length: float) -> dict[str, list[list[float]]]:
    """Return a block model: rectangles as x, y, width, height."""
    blocks = []
    for course in range(courses):
        ends = np.unique(
            [0.0, *np.arange(2.0 + 2.0 * (course % 2), length, 4.0), length]
        )
        blocks += [
            [float(start), 2.0 * course, float(end - start), 2.0]
            for start, end in pairwise(ends)
        ]
    return {"blocks_xywh": blocks}


walls = {"3 courses": running_bond(3, 20.0), "8 courses": running_bond(8, 20.0)}
mus = np.linspace(0.1, 0.9, 9)
curves = {}
for name, wall in walls.items():
    models = [ds.model_from_json({**wall, "mu": float(mu)}) for mu in mus]
    curves[name] = [ds.lateral_resistance(model).left.alpha for model in models]

# %%
# On the dashed line the wall slides as a whole, alpha = mu. Where a curve leaves it, stones rock:
# more friction helps less and less.

figure, ax = plt.subplots(figsize=(6, 4), layout="constrained")
ax.plot(mus, mus, "--", color="#8c8c8c", label="slides: alpha = mu")
for (name, alphas), colour, mark in zip(
    curves.items(), ("#4961c2", "#9e3d92"), "os", strict=True
):
    ax.plot(mus, alphas, marker=mark, color=colour, label=name)
ax.set_xlabel("coefficient of friction mu")
ax.set_ylabel("load multiplier alpha (to the left)")
ax.legend(edgecolor="none")
for name, alphas in curves.items():
    print(name, " ".join(f"{alpha:.3f}" for alpha in alphas))
