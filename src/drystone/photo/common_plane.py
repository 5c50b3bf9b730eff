"""One plane for markers whose places on it are not known: a homography and a pose for each."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import least_squares

from drystone.photo.view import apply, depth

Points = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Piece:
    """A rigid piece of paper with points on it."""

    seen_px: Points  # (n, 2) points in the photograph
    flat_m: Points  # (n, 2) the same points on the paper, metres


@dataclass(frozen=True, eq=False)
class CommonPlane:
    """A plane that all pieces lie on."""

    to_plane: Points  # (3, 3) homography from the photograph to the plane, metres
    # Of each piece, (n, 2): from the points of the paper where it fits best to those of the
    # photograph, metres on the plane.
    off_m: tuple[Points, ...]
    # (n,) sizes that would fit better, over those given; the largest piece in the photograph has 1.
    sizes: Points
    # How much better they fit (F statistic): near to 1 for noise, far above for wrong sizes.
    surer: float


def fit_plane(pieces: Sequence[Piece]) -> CommonPlane | None:
    """Find the plane for which every piece has its size and shape.

    The sum of squares of the distances, in px of the photograph, between the points that were
    seen and those of the pieces is made least over the homography and the poses of the pieces
    (turned and moved, never mirrored).  None when no homography of any meaning was found.
    """
    # Numbers near to 1 for the solver: px and metres are unlike by orders of magnitude.
    every_px = np.concatenate([piece.seen_px for piece in pieces])
    unit_px = _unit(every_px)
    unit_m = max(float(np.ptp(piece.flat_m, axis=0).max()) for piece in pieces)
    areas = [float(np.prod(np.ptp(piece.seen_px, axis=0))) for piece in pieces]
    order = sorted(range(len(pieces)), key=lambda one: -areas[one])
    scaled = [Piece(apply(unit_px, pieces[i].seen_px), pieces[i].flat_m / unit_m) for i in order]
    tried = [_least(scaled, to_seen) for to_seen in _beginnings(scaled)]
    found = [one for one in tried if one is not None]
    if not found:
        return None
    best = min(found, key=lambda one: one.cost)
    to_plane = np.diag([unit_m, unit_m, 1.0]) @ np.linalg.inv(best.to_seen) @ unit_px
    to_plane = to_plane / depth(to_plane, every_px.mean(axis=0)[None])[0]
    sizes = np.ones(len(pieces))
    sized, surer = _sizes(scaled, best)
    sizes[order] = sized
    return CommonPlane(to_plane, tuple(_off(to_plane, piece) for piece in pieces), sizes, surer)


def _off(to_plane: Points, piece: Piece) -> Points:
    on_plane = apply(to_plane, piece.seen_px)
    turn, shift = rigid(piece.flat_m, on_plane)
    return np.asarray(on_plane - (piece.flat_m @ turn.T + shift))


@dataclass(frozen=True, eq=False)
class _Fit:
    """A homography from the plane to the photograph, poses (angle, x, y) and half the squares."""

    to_seen: Points
    poses: Points
    cost: float


def _least(pieces: Sequence[Piece], to_seen: Points) -> _Fit | None:
    """Return the homography and the poses of the least cost near to a homography."""
    poses = [np.zeros(3)]
    with np.errstate(all="ignore"):
        for piece in pieces[1:]:
            turn, shift = rigid(piece.flat_m, apply(np.linalg.inv(to_seen), piece.seen_px))
            poses.append(np.array([np.arctan2(turn[1, 0], turn[0, 0]), *shift]))
        start = np.concatenate([(to_seen / to_seen[2, 2]).ravel()[:8], *poses[1:]])
        if not np.isfinite(start).all():
            return None
        result = least_squares(_misses, start, args=(pieces, 3), method="lm", max_nfev=4000)
    # A camera neither mirrors the ground nor sees a marker across the horizon.
    homography = np.append(result.x[:8], 1.0).reshape(3, 3)
    if not np.isfinite(result.x).all() or np.linalg.det(homography) <= 0:
        return None
    back = np.linalg.inv(homography)
    if any((depth(back, piece.seen_px) <= 0).any() for piece in pieces):
        return None
    return _Fit(homography, result.x[8:].reshape(-1, 3), float(result.cost))


def _sizes(pieces: Sequence[Piece], best: _Fit) -> tuple[Points, float]:
    """Return the sizes, over those given, that would fit best, and how much better they fit."""
    more = len(pieces) - 1
    if not more:
        return np.ones(1), 0.0
    free = np.column_stack([best.poses, np.zeros(more)])
    start = np.concatenate([best.to_seen.ravel()[:8], free.ravel()])
    with np.errstate(all="ignore"):
        result = least_squares(_misses, start, args=(pieces, 4), method="lm", max_nfev=4000)
    sizes = np.exp(np.append(0.0, result.x[8:].reshape(-1, 4)[:, 3]))
    left = 2 * sum(len(piece.seen_px) for piece in pieces) - len(start)
    # Corners are never better than a few thousandths of a px, whatever a computed picture says.
    noise = max(float(result.cost), 1e-12) / left
    return np.asarray(sizes), float(best.cost - result.cost) / more / noise


def _misses(variables: Points, pieces: Sequence[Piece], each: int) -> Points:
    """Return how far each point of the paper is from where it was seen.

    `each` numbers say how a piece lies, after the first: angle, x, y (and the logarithm of its
    size).
    """
    homography = np.append(variables[:8], 1.0).reshape(3, 3)
    poses = np.zeros((len(pieces), 4))
    poses[1:, :each] = variables[8:].reshape(-1, each)
    missed = []
    for piece, (angle, x, y, size) in zip(pieces, poses, strict=True):
        cos, sin = np.exp(size) * np.cos(angle), np.exp(size) * np.sin(angle)
        placed = piece.flat_m @ np.array([[cos, sin], [-sin, cos]]) + (x, y)
        missed.append(apply(homography, placed) - piece.seen_px)
    return np.concatenate(missed).ravel()


def _beginnings(pieces: Sequence[Piece]) -> list[Points]:
    """Return the homography of the largest piece, and what is left of it without perspective."""
    first = pieces[0]
    full = direct(first.flat_m, first.seen_px)
    design = np.column_stack([first.flat_m, np.ones(len(first.flat_m))])
    rows, *_ = np.linalg.lstsq(design, first.seen_px, rcond=None)
    return [np.vstack([rows.T, [0.0, 0.0, 1.0]]), full]


def direct(source: Points, target: Points) -> Points:
    """Return the homography of four or more points by the direct linear transformation."""
    x, y = source.T
    u, v = target.T
    one, none = np.ones_like(x), np.zeros_like(x)
    rows = np.concatenate(
        [
            np.column_stack([x, y, one, none, none, none, -u * x, -u * y, -u]),
            np.column_stack([none, none, none, x, y, one, -v * x, -v * y, -v]),
        ]
    )
    solution = np.linalg.svd(rows)[2][-1].reshape(3, 3)
    return np.asarray(solution / solution[2, 2])


def rigid(source: Points, target: Points) -> tuple[Points, Points]:
    """Return the turn and the shift, never mirrored, that lay source on target best."""
    a, b = source - source.mean(axis=0), target - target.mean(axis=0)
    angle = np.arctan2((a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]).sum(), (a * b).sum())
    turn = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
    return turn, target.mean(axis=0) - turn @ source.mean(axis=0)


def _unit(points: Points) -> Points:
    centre = points.mean(axis=0)
    spread = float(np.abs(points - centre).max())
    return np.array(
        [[1 / spread, 0, -centre[0] / spread], [0, 1 / spread, -centre[1] / spread], [0, 0, 1]]
    )
