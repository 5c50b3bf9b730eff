"""Where loads act, found from the top of a wall downwards for each block alone."""


def load(block, laid, beds):
    """Return the weight of a block with its share of all that lies on it, and where that acts."""
    size = laid[block].size
    parts = [(size**2, laid[block].x, laid[block].y)]
    for one, (on, *_) in beds.items():
        if all(bearing.below != block for bearing in on):
            continue
        weight, x, _ = load(one, laid, beds)
        left, right = beside(on, x)
        share = (right.x - x) / (right.x - left.x) if left.x <= x < right.x else 1.0
        shares = [(left, share), (right, 1.0 - share)]
        parts += [(weight * part, b.x, b.y) for b, part in shares if b.below == block]
    whole = sum(weight for weight, _, _ in parts)
    return whole, sum(w * x for w, x, _ in parts) / whole, sum(w * y for w, _, y in parts) / whole


def beside(points, x):
    """Return the points next to a load on both sides, beyond an end the same one twice."""
    left = max((b for b in points if b.x <= x), key=lambda b: b.x, default=points[0])
    right = min((b for b in points if b.x > x), key=lambda b: b.x, default=points[-1])
    return left, right


def stays(block, laid, beds, mu, near):
    """Say whether a block bears its load, by what would hold it were it to roll about its edge."""
    on = beds[block].points
    if not on:
        return False
    whole, x, _ = load(block, laid, beds)
    if on[0].x - near <= x <= on[-1].x + near:
        return True
    edge, way = (on[0], 1.0) if x < on[0].x else (on[-1], -1.0)
    torque = way * (edge.x - laid[block].x) * laid[block].size ** 2
    for points, *_ in beds.values():
        here = [one for one in points if one.below == block]
        if not here:
            continue
        other = next(i for i, bed in beds.items() if bed.points is points)
        weight, at, _ = load(other, laid, beds)
        left, right = beside(points, at)
        for bears, held in ((left, right), (right, left)):
            if bears.below != block:
                continue
            point = bears
            share = (at - held.x) / (bears.x - held.x) if bears.x != held.x else 0.5
            share = share if left.x <= at <= right.x else 0.5
            if held.below != block and bears.x != held.x:
                # Of all points on its side those that help: the ones towards the block's middle.
                side = [b for b in here if (b.x - held.x) * (bears.x - held.x) > 0]
                last = max(side, key=lambda b: way * b.x)
                if abs(last.x - held.x) > abs(bears.x - held.x):
                    point, share = last, (at - held.x) / (last.x - held.x)
                lesser = min(share, 1.0 - share)
                torque -= mu * weight * lesser * (point.y - edge.y)
            torque += way * (edge.x - point.x) * weight * share
    return torque <= near * whole
