"""Bring an image of labels to the working resolution without inventing labels."""

import numpy as np

from drystone.model.site import working_px
from drystone.model.wall import Labels


def reduce_labels(labels: Labels, scale: float) -> Labels:
    """Reduce an image of labels by nearest sampling.

    Pixel i of the result takes source pixel floor(i * source size / size), so the first row and
    column stay what they are.  This is the sampling with which the published figures of the
    masons' walls were measured; other choices of the sample point move F_AV by up to two points.
    Each side becomes floor(size * scale + 0.5) px, at least one; the result is a copy.
    """
    if not scale > 0:
        raise ValueError(f"scale must be positive, not {scale}")
    height, width = labels.shape
    rows, cols = (max(1, working_px(size, scale)) for size in (height, width))
    # Whole numbers: a product with a float would miss the source pixel on some sizes.
    source_rows = np.arange(rows) * height // rows
    source_cols = np.arange(cols) * width // cols
    return labels[np.ix_(source_rows, source_cols)]
