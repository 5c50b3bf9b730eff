"""Where loads act, found from the top of a wall downwards for each block alone."""


def load(block, laid, beds):
    """Return the weight of a block with its share of all that lies on it, and where that acts."""
    size = laid[block].size
    parts = [(size**2, laid[block].x, laid[block].y)]
    for one, (on, _) in beds.items():
        if all(bearing.below != block for bearing in on):
            continue
        weight, x, _ = load(one, laid, beds)
        left = max((b for b in on if b.x <= x), key=lambda b: b.x, default=None)
        right = min((b for b in on if b.x > x), key=lambda b: b.x, default=None)
        if left and right:
            share = (right.x - x) / (right.x - left.x)
            shares = [(left, share), (right, 1.0 - share)]
        else:
            shares = [(left or right, 1.0)]
        parts += [(weight * part, b.x, b.y) for b, part in shares if b.below == block]
    whole = sum(weight for weight, _, _ in parts)
    return whole, sum(w * x for w, x, _ in parts) / whole, sum(w * y for w, _, y in parts) / whole
