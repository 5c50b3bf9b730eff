"""What stones rest on: no points, no towers of slivers, no voids under corners, no large wedges.

All is read off the columns of the wall: what is next below each stone, and how far away.
"""

import numpy as np

from drystone.craft.finding import Case, Evidence, Limit, worst_first
from drystone.craft.joints import StoneSides
from drystone.craft.masonry import Masonry
from drystone.craft.pins import resting_on
from drystone.kernels.polygons import Points
from drystone.kernels.profiles import Floats


def seats(masonry: Masonry) -> Evidence:
    """Find stones that rest on a point, or whose middle is not over their seat."""
    settings, cases, height = masonry.settings, [], masonry.mean_height
    raised = {i: one for i, one in masonry.profiles.items() if i not in masonry.on_ground}
    if not raised:
        return Evidence(None, note="No stone lies on others.")
    for stone, under in raised.items():
        size, middle = masonry.areas[stone] ** 0.5, masonry.centroids[stone][0]
        bearing = _seat(under, settings.near * height, settings.slope, settings.joint * height)
        if not len(bearing):
            low = float(under.low.min())
            left, right = under.x[[0, -1]].tolist()
            line = np.array([[left, low], [right, low]])
            cases.append(Case((stone,), 1.0, "hangs between its neighbours, on no seat", (line,)))
            continue
        left, right = bearing[[0, -1]].tolist()
        left, right = left - 0.5 * under.spacing, right + 0.5 * under.spacing
        width, margin = (right - left) / size, min(middle - left, right - middle) / size
        low = float(np.interp(0.5 * (left + right), under.x, under.low))
        line = np.array([[left, low], [right, low]])
        if width < settings.seat - 1e-9:
            words = f"rests on a point, {max(width, 0.0):.2f} of its size wide"
            cases.append(Case((stone,), round(1.0 - width, 6), words, (line,)))
        elif margin < settings.middle - 1e-9:
            words = (
                f"its middle is only {margin:.2f} of its size within its seat"
                if margin >= 0
                else f"its middle is {-margin:.2f} of its size beyond its seat"
            )
            cases.append(Case((stone,), round(settings.middle - margin, 6), words, (line,)))
    return Evidence(
        len(cases) / len(raised), worst_first(cases), {"raised stones": float(len(raised))}
    )


def _seat(under: StoneSides, near: float, steepest: float, joint: float) -> Floats:
    """Return the x of the columns that bear: level enough, and as near as the nearest.

    `near` is how much more air they may have, `steepest` their greatest slope; what is farther
    from what is below than a `joint` is wide bears nothing.
    """
    if len(under.x) < 2:
        return under.x
    level = np.abs(np.gradient(under.low, under.spacing)) <= steepest
    level &= under.gap <= joint
    if not level.any():
        return under.x[:0]
    return np.asarray(under.x[level & (under.gap <= under.gap[level].min() + near)])


def towers(masonry: Masonry) -> Evidence:
    """Find small stones on small stones."""
    if not masonry.stones:
        return Evidence(None, note="There are no stones.")
    mean = float(np.mean([masonry.areas[i] for i in masonry.stones])) ** 0.5
    small = {
        i for i in masonry.stones if masonry.areas[i] ** 0.5 < masonry.settings.small * mean - 1e-9
    }
    # A stone carried by a large one too stands on that.
    under = {
        i: [j for j, *_ in masonry.supports[i]]
        for i in sorted(small - masonry.on_ground, key=lambda i: masonry.boxes[i][1])
    }
    stacks: dict[int, tuple[int, ...]] = {i: (i,) for i in small}
    for i, lower in under.items():
        if lower and small.issuperset(lower):
            stacks[i] = (*max((stacks[j] for j in lower), key=len), i)
    inner = {i for stack in stacks.values() for i in stack[:-1]}
    cases = []
    for i, stack in stacks.items():
        if len(stack) > 1 and i not in inner:
            words = f"{len(stack)} small stones on each other"
            line = np.array([masonry.centroids[j] for j in stack])
            cases.append(Case(stack, float(len(stack)), words, (line,), at_fault=len(stack)))
    highest = max(map(len, stacks.values()), default=0)
    return Evidence(float(highest), worst_first(cases), {"small stones": float(len(small))})


def voids(masonry: Masonry) -> Evidence:
    """Find lower corners with nothing beneath them."""
    sides = masonry.profiles
    if not sides:
        return Evidence(None, note="There are no stones.")
    widest, cases = masonry.settings.joint * masonry.mean_height, []
    for stone, under in sides.items():
        filled = np.flatnonzero(under.gap <= widest)
        width = under.spacing * len(under.x)
        ends = (filled[0], len(under.x) - 1 - filled[-1]) if len(filled) else (len(under.x), 0)
        for side, count in zip(("left", "right"), ends, strict=True):
            share = int(count) * under.spacing / width
            if share > masonry.settings.void + 1e-9:
                cells = slice(0, count) if side == "left" else slice(-int(count), None)
                line: Points = np.column_stack([under.x[cells], under.low[cells]])[[0, -1]]
                words = f"nothing under its {side} corner, {share:.2f} of its width"
                words = words if len(filled) else "hangs, with nothing under it"
                cases.append(Case((stone,), round(share, 6), words, (line,)))
    stones = {case.stones for case in cases}
    return Evidence(len(stones) / len(sides), worst_first(cases))


def wedge_sizes(masonry: Masonry, limit: Limit) -> Evidence:
    """Find wedges that are large beside the stone on them, and what they stand on."""
    wedges = sorted(set(masonry.wedge_ids))
    if not wedges:
        return Evidence(None, note="There is no wedge, or none is marked.")
    shares, cases, resting = [0.0], [], resting_on(masonry)
    for wedge in wedges:
        carried = resting[wedge]
        if not carried:
            continue
        stone = min(carried, key=lambda i: (masonry.areas[i], i))
        shares.append(masonry.areas[wedge] / masonry.areas[stone])
        if shares[-1] > limit.good + 1e-9:
            lower = masonry.loops[wedge]
            # The face that it stands on: of its edges that look down, the longest.
            edges = np.roll(lower, -1, axis=0) - lower
            at = int(np.where(edges[:, 0] > 0, np.hypot(*edges.T), -1.0).argmax())
            steep = float(np.degrees(np.arctan2(abs(edges[at, 1]), edges[at, 0])))
            on = f", on a slope of {steep:.0f}°" if steep > masonry.settings.steep_deg else ""
            words = f"the wedge is {shares[-1]:.2f} of the stone on it{on}"
            line = np.array([lower[at], lower[at] + edges[at]])
            cases.append(Case((wedge, stone), round(shares[-1], 6), words, (line,)))
    return Evidence(round(max(shares), 9), worst_first(cases), {"wedges": float(len(wedges))})
