"""Slow, obvious twins of drystone.kernels.profiles and drystone.kernels.drops."""

import math

import shapely


def column_span(corners, left, right):
    """Lowest and highest y of a polygon between two vertical lines; None when it is not there."""
    low, high = corners[:, 1].min() - 1.0, corners[:, 1].max() + 1.0
    cut = shapely.intersection(shapely.Polygon(corners), shapely.box(left, low, right, high))
    parts = [part for part in shapely.get_parts(cut) if part.area > 0.0]  # edges on a line: none
    bounds = [part.bounds for part in parts]
    if not bounds or max(b[2] - b[0] for b in bounds) < 1e-9 * (right - left):
        return None
    return min(b[1] for b in bounds), max(b[3] for b in bounds)


def height_profile(polygons, columns, cell):
    """Tops and owners of polygons that were placed one after the other."""
    tops, owners = [0.0] * columns, [-1] * columns
    for index, corners in enumerate(polygons):
        # Outermost columns count from a quarter on.
        first = math.floor(corners[:, 0].min() / cell + 0.25)
        end = math.ceil(corners[:, 0].max() / cell - 0.25)
        for column in range(max(0, first), min(columns, end)):
            span = column_span(corners, column * cell, (column + 1) * cell)
            if span is not None and span[1] > tops[column]:
                tops[column], owners[column] = span[1], index
    return tops, owners


def all_drops(profile, stone, terms, constant):
    """For each column that the left end may be on: lift, cost and lean; None where it is too high.

    The lists end where the stone would reach beyond the wall's end.
    """
    room = terms.width_px + 1e-9 * terms.cell_px - (stone.right - stone.left)
    places = range(len(profile.tops) - len(stone.bottoms) + 1)
    inside = [place for place in places if place * terms.cell_px <= room]
    return [one_drop(profile, stone, terms, constant, place) for place in inside]


def one_drop(profile, stone, terms, constant, place):
    under = [float(top) for top in profile.tops[place : place + len(stone.bottoms)]]
    lift = max(top - bottom for top, bottom in zip(under, stone.bottoms, strict=True))
    if lift + stone.top > terms.height_px + terms.slack_px:
        return None
    costs, lean = craft(profile, stone, terms, place, lift)
    return lift, constant + sum(getattr(terms, name) * cost for name, cost in costs.items()), lean


def craft(profile, stone, terms, place, lift):
    """Every cost by its name, without weights, and the lean."""
    cell, tops, columns = terms.cell_px, profile.tops, len(stone.bottoms)
    width = stone.right - stone.left
    left, bottom, top = place * cell, lift + stone.bottom, lift + stone.top
    box = (left, bottom, left + width, top)
    gaps = [lift + stone.bottoms[k] - tops[place + k] for k in range(columns)]
    covered = [cell] * (columns - 1) + [width - (columns - 1) * cell]
    void = sum(gap * part for gap, part in zip(gaps, covered, strict=True))
    area, column = 0.0, place - 1
    while column >= 0 and tops[column] < (bottom + top) / 2:
        area += cell * (top - max(tops[column], bottom))
        column -= 1
    free, column = 0, place + columns
    while column < len(tops) and tops[column] <= bottom + cell:
        free, column = free + 1, column + 1
    above = max(0, math.floor((terms.height_px - top) / cell + 1e-9))
    beside = terms.rest_width_px[min(free, len(terms.rest_width_px) - 1)]
    over = terms.rest_height_px[min(above, len(terms.rest_height_px) - 1)]
    boxes = [profile.boxes[owner] for owner in sorted(set(profile.owners.tolist()) - {-1})]
    carries = [k for k, gap in enumerate(gaps) if gap < 1.5 * cell]
    start, end = carries[0] * cell, min(width, (carries[-1] + 1) * cell)
    lean = 0.0
    if -stone.left < start:
        lean = (-stone.left - start) / width
    if -stone.left > end:
        lean = (-stone.left - end) / width
    costs = {
        "height": lift / terms.mean_height_px,
        "void": void / terms.mean_area_px,
        "gap": min(1.0, area / terms.mean_area_px),
        "slot": beside * cell * (top - bottom) / terms.mean_area_px,
        "headroom": over * cell * width / terms.mean_area_px,
        "step": step(boxes, box) / terms.mean_height_px,
        "joint": joint(boxes, box, terms),
        "unbalanced": abs(lean),
    }
    return costs, lean


def step(boxes, box):
    """To the top of the box that ends last left of the middle, in the same course."""
    best = None
    for other in boxes:
        shared = min(other[3], box[3]) - max(other[1], box[1])
        level = 2 * shared >= min(other[3] - other[1], box[3] - box[1])
        if level and 2 * other[2] <= box[0] + box[2]:
            key = (other[2], other[3])
            best = key if best is None else max(best, key)
    return 0.0 if best is None else abs(box[3] - best[1])


def joint(boxes, box, terms):
    """1 - IWR from the nearest right corner to the left end, and the other way round."""
    left, bottom, right, top = box
    if left < terms.narrowest_px or terms.width_px - right < terms.narrowest_px:
        return 1.0
    if bottom < terms.cell_px / 2:
        return 0.5
    below = [other for other in boxes if other[3] <= (bottom + top) / 2]
    ends = [(other[2], other) for other in below if other[2] < terms.width_px - terms.narrowest_px]
    starts = [(other[0], other) for other in below if other[0] > terms.narrowest_px]
    ratios = []
    for corners, x in ((ends, left), (starts, right)):
        if corners:
            squares = [(at - x) ** 2 + (other[3] - bottom) ** 2 for at, other in corners]
            at, other = corners[squares.index(min(squares))]
            ratios.append(min(1.0, abs(at - x) / (other[2] - other[0])))
    return 1.0 - sum(ratios) / len(ratios) if ratios else 0.5
