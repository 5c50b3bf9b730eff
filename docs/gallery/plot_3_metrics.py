"""
What the figures of merit say
=============================

Filling, joints, level and ends of any image of labels: here stacks of bricks whose bond differs.
"""

from itertools import pairwise

import matplotlib.pyplot as plt
import numpy as np

import drystone as ds
from drystone.drawing.pictures.stones import plot_labels


def bricks(shift_px: int) -> np.ndarray:
    """Return four courses of bricks of 30 x 12 px, every other one shifted."""
    labels = np.zeros((48, 120), np.uint32)
    for course in range(4):
        rows = slice(48 - 12 * (course + 1), 48 - 12 * course)
        first = 30 - shift_px * (course % 2)
        ends = [0, *range(first, 120, 30), 120]
        for brick, (start, end) in enumerate(pairwise(ends)):
            labels[rows, start:end] = 10 * (course + 1) + brick
    return labels


# %%
# F_AV is by how many percent the shortest ways down along the joints are longer than straight:
# 0 in a stack bond, whose head joints are never interrupted, most in a half bond. F_AH says the
# same from end to end: courses are straight, so it is 0 in all of them.

figure, axes = plt.subplots(3, figsize=(7, 8.5), layout="constrained")
for ax, shift_px in zip(axes, (0, 6, 15), strict=True):
    wall = bricks(shift_px)
    model = ds.model_from_labels(wall).model
    carried = ds.lateral_resistance(model).value
    m = ds.measure_labels(wall, lateral_resistance=carried)
    plot_labels(wall, ax)
    joints = f"F_AV {m.F_AV:.1f}, F_AH {m.F_AH:.1f}"
    title = f"shifted by {shift_px} px: F_SF {m.F_SF:.2f}, {joints}, F_LR {m.F_LR:.2f}"
    ax.set_title(title, fontsize=9)
