"""Errors of a builder, corner by corner."""

import math


def misjudged(corners, waves, longest):
    """Corners about the centroid of the outline, moved along their way from it.

    `waves` are cosine and sine weights of modes 2 to 6; edges are cut into pieces no longer than
    `longest` first.
    """
    found = []
    for k, (x, y) in enumerate(corners):
        u, v = corners[(k + 1) % len(corners)]
        pieces = max(1, math.ceil(math.hypot(u - x, v - y) / longest))
        for piece in range(pieces):
            a = x + (u - x) * piece / pieces
            b = y + (v - y) * piece / pieces
            angle, radius = math.atan2(b, a), math.hypot(a, b)
            error = sum(
                waves[0][m] * math.cos((m + 2) * angle) + waves[1][m] * math.sin((m + 2) * angle)
                for m in range(5)
            )
            share = 1 + max(error / radius, -0.5)
            found.append((a * share, b * share))
    return found
