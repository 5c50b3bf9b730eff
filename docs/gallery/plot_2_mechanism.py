"""
How a wall fails, and at which load
===================================

The limit analysis of a wall that was not planned here: any image of labels will do.
"""

from itertools import pairwise

import matplotlib.pyplot as plt
import numpy as np

import drystone as ds
from drystone.drawing.pictures.mechanism import plot_mechanism

# %%
# A wall of four courses of bricks, 24 x 12 px each, in running bond. 0 is where nothing is, every
# other value is the id of a stone.

labels = np.zeros((48, 96), np.uint32)
for course in range(4):
    rows = slice(48 - 12 * (course + 1), 48 - 12 * course)
    ends = [0, *range(12 + 12 * (course % 2), 96, 24), 96]
    for brick, (start, end) in enumerate(pairwise(ends)):
        labels[rows, start:end] = 10 * (course + 1) + brick

# %%
# The table on which it stands is tilted to the left and to the right. ``alpha`` is the greatest
# sideways load that it carries, as a share of its own weight.

model = ds.model_from_labels(labels, mu=0.65).model
resistance = ds.lateral_resistance(model, mechanism=True)
for side in (resistance.left, resistance.right):
    print(f"{side.direction}: {side.status}, alpha {side.alpha:.4f}")
    print(f"  proved from both sides, apart by {side.certificate.gap:.0e}")

# %%
# The mechanism is the other half of the answer: which blocks move, and how.

figure, axes = plt.subplots(2, figsize=(7, 6), layout="constrained")
for ax, side in zip(axes, (resistance.left, resistance.right), strict=True):
    plot_mechanism(labels, side.mechanism, side.direction, side.alpha, ax)

# %%
# Associative friction makes joints that slide open as well. Without that dilatancy the wall may
# carry less.

plain = ds.nonassociative_resistance(model)
print(f"without dilatancy: {plain.left.alpha:.4f} and {plain.right.alpha:.4f}")
