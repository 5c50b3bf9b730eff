"""From markers to the scale and the view of a photograph."""

import math
from collections import Counter
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from scipy.optimize import least_squares

from drystone.errors import InputError, Notice
from drystone.kernels.polygons import Points
from drystone.photo.layout import MarkerLayout
from drystone.photo.markers import DICTIONARIES, FAMILIES, FoundMarker
from drystone.photo.view import SQUARE, View, apply, depth, jacobian, refuse_horizon

Piece = tuple[Points, Points]
"""Points on a rigid piece of paper, (n, 2): in the photograph, px, and on the paper, metres."""


class CommonPlane(NamedTuple):
    """The plane on which pieces of paper have their sizes and shapes."""

    to_plane: Points  # (3, 3): homography from the photograph to the plane, metres
    # Of each piece (n, 2): the way on the plane from its points, where it fits best, to those of
    # the photograph, metres.
    off_m: list[Points]
    sizes: Points  # (n,): those that would fit better, over those given; 1 for the largest piece
    surer: float  # how much better they fit (F statistic): near to 1 for noise, far above if wrong


LEAST_SIDE_PX, SMALL_SIDE_PX = 40.0, 100.0
"""Smaller markers are left out (W171); the scale is in doubt when none is larger (W172)."""

LEAST_SLANT = 0.35
"""Length over width; markers that are more foreshortened are left out (W171)."""

DOUBTFUL_PERCENT, MOST_PERCENT = 0.5, 1.0
"""Residual over the side of a marker: of all, from which on the scale is in doubt (W172), and of
one, beyond which markers disagree (E172)."""

MOST_SIZE_PERCENT, SURER = 1.5, 15.0
"""Difference of the sizes of two papers beyond which they disagree, and the F statistic from which
on it is no noise."""


def scale_and_view(
    found: tuple[FoundMarker, ...], layout: MarkerLayout, size_px: tuple[int, int]
) -> View:
    """Find the scale and the perspective of a photograph from at least two markers.

    `size_px` is width and height of the photograph.  E170 fewer than two markers that can be used;
    E171 an id twice; E172 markers that disagree; E173 a view with the horizon in it.
    """
    used, notices = _usable(found, layout)
    groups = sorted({layout.group(marker.id) for marker in used})
    papers = [[marker for marker in used if layout.group(marker.id) == one] for one in groups]
    seen = [np.concatenate([one.corners_px for one in paper]) for paper in papers]
    printed = [np.concatenate([layout.corners_m(one.id) for one in paper]) for paper in papers]
    fitted = fit_plane([*zip(seen, printed, strict=True)])
    if fitted is None:
        raise _disagreement("No view of the ground gives all of them their size")
    to_plane = fitted.to_plane
    residual_m = _believed(papers, layout, fitted)
    percent = 100.0 * residual_m / layout.side_m
    largest = max(marker.side_px for marker in used)
    if largest < SMALL_SIDE_PX:
        said = f"The largest marker is {largest:.0f} px wide: the scale may be 1 % off."
        notices.append(Notice("W172", said, _NEARER))
    if percent > DOUBTFUL_PERCENT:
        said = f"The corners of the markers are {percent:.1f} % of a marker off on average."
        notices.append(Notice("W172", said, "Are they flat, sharp, and in the same plane?"))
    refuse_horizon(to_plane, size_px)
    # The plane is turned and moved so that the picture stays upright and begins at 0, 0.
    middle = np.array(size_px) / 2.0
    local = jacobian(to_plane, middle)
    angle = math.atan2(local[1, 0] - local[0, 1], local[0, 0] + local[1, 1])
    cos, sin = math.cos(angle), math.sin(angle)
    turned = np.array([[cos, sin, 0.0], [-sin, cos, 0.0], [0.0, 0.0, 1.0]]) @ to_plane
    low = apply(turned, SQUARE * size_px).min(axis=0)
    to_ground = np.array([[1.0, 0.0, -low[0]], [0.0, 1.0, -low[1]], [0.0, 0.0, 1.0]]) @ turned
    metres_per_px = math.sqrt(np.linalg.det(jacobian(to_ground, middle)))
    ids = tuple(marker.id for marker in used)
    return View(to_ground, 1.0 / metres_per_px, ids, 1000.0 * residual_m, percent, tuple(notices))


def _usable(
    found: Sequence[FoundMarker], layout: MarkerLayout
) -> tuple[tuple[FoundMarker, ...], list[Notice]]:
    """Return at least two markers that can be measured, and say which were left out."""
    notices: list[Notice] = []
    family = found[0].dictionary if found else "aruco"
    if family not in DICTIONARIES:
        notices.append(_other_family(found, layout))
    known = [one for one in found if layout.lists(one.id)]
    twice = [one for one, count in Counter(marker.id for marker in known).items() if count > 1]
    if twice:
        what = f"{_markers(twice)} can be seen twice, so it is not known which is which."
        cure = "Use every marker once: `drystone markers --ids` prints others."
        raise InputError("E171", what, where="markers", cure=cure)
    strange = sorted({one.id for one in found} - {one.id for one in known})
    if strange:
        others = "of the sheet" if layout.page else "to be used"
        known_ids = ", ".join(map(str, layout.ids or ()))
        said = f"{_markers(strange)} left out: not one {others} ({known_ids})."
        notices.append(Notice("W170", said))
    small = [one for one in known if one.side_px < LEAST_SIDE_PX]
    slanted = [one for one in known if one not in small and _slant(one) < LEAST_SLANT]
    used = tuple(one for one in known if one not in small and one not in slanted)
    poorly = ((small, f"smaller than {LEAST_SIDE_PX:g} px"), (slanted, "seen at too flat an angle"))
    for poor, why in poorly:
        if poor:
            said = ", ".join(f"{one.id} ({one.side_px:.0f} px)" for one in poor)
            notices.append(Notice("W171", f"Markers left out, {why}: {said}.", _NEARER))
    if len(used) < 2:
        raise _too_few(found, used, notices, strange)
    return used, notices


def _other_family(found: Sequence[FoundMarker], layout: MarkerLayout) -> Notice:
    """Say that markers are not of those that are printed here; a sheet cannot be of such (E170)."""
    what = f"{_markers(sorted({one.id for one in found}))} of {FAMILIES[found[0].dictionary][0]}"
    printed = " and ".join(FAMILIES[name][0] for name in DICTIONARIES)
    if layout.page is not None:
        raise InputError(
            "E170",
            f"{what} found, of another dictionary than the sheets of `drystone markers` "
            f"({printed}), so their distances are not known.",
            where="markers",
            cure="Say how large one is, such as --aruco 50mm, or print a sheet.",
        )
    cure = "Measure one, black square only, and give its size with --aruco."
    return Notice(
        "W184", f"The scale is that of {what}: `drystone markers` prints {printed}.", cure
    )


_NEARER = "Go nearer, photograph from above, or print larger markers."
_PRINT = (
    "Print markers with `drystone markers`, lay them flat beside the stones with all of their "
    "white border, and photograph them sharp and without glare; or say the scale with --px-per-m "
    "or --ruler."
)


def _too_few(
    found: Sequence[FoundMarker],
    used: Sequence[FoundMarker],
    notices: Sequence[Notice],
    strange: Sequence[int],
) -> InputError:
    what = "no marker can be used"
    if not found:
        read = ", ".join(title for title, _ in FAMILIES.values())
        what = f"no marker was found (looked for {read}, all of their white border visible)"
    if used:
        what = f"only marker {used[0].id} can be used"
    left_out = "".join(f" {notice.message}" for notice in notices)
    cure = _PRINT
    if len(strange) > 1:
        # Another sheet, as `drystone markers` prints with --ids or --count.
        named = " ".join(map(str, sorted({one.id for one in found})))
        cure = f"If they are your markers, add --marker-ids {named}. Else: {_PRINT}"
    return InputError(
        "E170",
        f"{what}, and two are needed to know the scale and to see when it is wrong.{left_out}",
        where="markers",
        cure=cure,
    )


def _believed(
    papers: Sequence[Sequence[FoundMarker]], layout: MarkerLayout, fitted: CommonPlane
) -> float:
    """Return the residual of all corners, metres; refuse markers that disagree (E172)."""
    # Perspective can hide from the residual that sizes differ.
    sizes = fitted.sizes
    spread = 100.0 * (float(sizes.max() / sizes.min()) - 1.0)
    if fitted.surer > SURER and spread > MOST_SIZE_PERCENT:
        low, high = (papers[int(one)][0].id for one in (sizes.argmin(), sizes.argmax()))
        raise _disagreement(
            f"Marker {high} seems to be {spread:.1f} % larger than marker {low}, and both should "
            f"measure {1000 * layout.side_m:g} mm"
        )
    square_m = {
        marker.id: (off[4 * i : 4 * i + 4] ** 2).sum(axis=1)
        for paper, off in zip(papers, fitted.off_m, strict=True)
        for i, marker in enumerate(paper)
    }
    rms_m = {one: math.sqrt(float(square.mean())) for one, square in square_m.items()}
    worst = max(rms_m, key=lambda one: rms_m[one])
    if not 100.0 * rms_m[worst] <= MOST_PERCENT * layout.side_m:
        raise _disagreement(
            f"Marker {worst} is {1000 * rms_m[worst]:.1f} mm off "
            f"({100 * rms_m[worst] / layout.side_m:.1f} % of its side; the limit is "
            f"{MOST_PERCENT:g} %)"
        )
    return math.sqrt(float(np.concatenate(list(square_m.values())).mean()))


def _disagreement(what: str) -> InputError:
    return InputError(
        "E172",
        f"the markers disagree with each other. {what}.",
        where="markers",
        cure="Print all at 100 %, and give --aruco the size that was printed. Lay them flat in one "
        "plane, with all of the white border in the picture, and do not cut a sheet up.",
    )


def _slant(marker: FoundMarker) -> float:
    """Return how foreshortened a marker is: 1 from straight above, 0 from the side."""
    local = jacobian(direct(SQUARE, marker.corners_px), np.array([0.5, 0.5]))
    long, short = np.linalg.svd(local, compute_uv=False)
    return float(short / long)


def _markers(ids: Sequence[int]) -> str:
    return f"marker{'s' * (len(ids) > 1)} {', '.join(map(str, ids))}"


def fit_plane(pieces: Sequence[Piece]) -> CommonPlane | None:
    """Find the plane for which every piece has its size and shape.

    The sum of squares of the distances, in px of the photograph, between the points that were
    seen and those of the pieces is made least over the homography and the poses of the pieces
    (turned and moved, never mirrored).  None when no homography of any meaning was found.
    """
    # Numbers near to 1 for the solver: px and metres are unlike by orders of magnitude.
    every_px = np.concatenate([seen_px for seen_px, _ in pieces])
    centre = every_px.mean(axis=0)
    spread = float(np.abs(every_px - centre).max())
    unit_px = np.array([[1.0, 0.0, -centre[0]], [0.0, 1.0, -centre[1]], [0.0, 0.0, spread]])
    unit_m = max(float(np.ptp(flat_m, axis=0).max()) for _, flat_m in pieces)
    areas = [float(np.prod(np.ptp(seen_px, axis=0))) for seen_px, _ in pieces]
    order = sorted(range(len(pieces)), key=lambda one: -areas[one])
    scaled = [(apply(unit_px, pieces[i][0]), pieces[i][1] / unit_m) for i in order]
    # It begins with the homography of the largest piece, and what that is without perspective.
    seen, flat = scaled[0]
    rows, *_ = np.linalg.lstsq(np.column_stack([flat, np.ones(len(flat))]), seen, rcond=None)
    beginnings = np.vstack([rows.T, [0.0, 0.0, 1.0]]), direct(flat, seen)
    tried = [_least(scaled, to_seen) for to_seen in beginnings]
    found = [one for one in tried if one is not None]
    if not found:
        return None
    best = min(found, key=lambda one: one[0])
    to_plane = np.diag([unit_m, unit_m, 1.0]) @ np.linalg.inv(best[1]) @ unit_px
    to_plane = to_plane / depth(to_plane, every_px.mean(axis=0)[None])[0]
    sizes = np.ones(len(pieces))
    sizes[order], surer = _sizes(scaled, *best)
    off_m = []
    for seen_px, flat_m in pieces:
        on_plane = apply(to_plane, seen_px)
        turn, shift = rigid(flat_m, on_plane)
        off_m.append(on_plane - (flat_m @ turn.T + shift))
    return CommonPlane(to_plane, off_m, sizes, surer)


def _least(pieces: Sequence[Piece], to_seen: Points) -> tuple[float, Points, Points] | None:
    """Return the least cost near to a homography: half the squares, homography and poses.

    The homography leads from the plane to the photograph; a pose is an angle, x and y.
    """
    poses = [np.zeros(3)]
    with np.errstate(all="ignore"):
        for seen, flat in pieces[1:]:
            turn, shift = rigid(flat, apply(np.linalg.inv(to_seen), seen))
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
    if any((depth(back, seen) <= 0).any() for seen, _ in pieces):
        return None
    return float(result.cost), homography, result.x[8:].reshape(-1, 3)


def _sizes(
    pieces: Sequence[Piece], cost: float, to_seen: Points, poses: Points
) -> tuple[Points, float]:
    """Return the sizes, over those given, that would fit best, and how much better they fit."""
    more = len(pieces) - 1
    if not more:
        return np.ones(1), 0.0
    free = np.column_stack([poses, np.zeros(more)])
    start = np.concatenate([to_seen.ravel()[:8], free.ravel()])
    with np.errstate(all="ignore"):
        result = least_squares(_misses, start, args=(pieces, 4), method="lm", max_nfev=4000)
    sizes = np.exp(np.append(0.0, result.x[8:].reshape(-1, 4)[:, 3]))
    left = 2 * sum(len(seen) for seen, _ in pieces) - len(start)
    # Corners are never better than a few thousandths of a px, whatever a computed picture says.
    noise = max(float(result.cost), 1e-12) / left
    return np.asarray(sizes), float(cost - result.cost) / more / noise


def _misses(variables: Points, pieces: Sequence[Piece], each: int) -> Points:
    """Return how far each point of the paper is from where it was seen.

    `each` numbers say how a piece lies, after the first: angle, x, y (and the logarithm of its
    size).
    """
    homography = np.append(variables[:8], 1.0).reshape(3, 3)
    poses = np.zeros((len(pieces), 4))
    poses[1:, :each] = variables[8:].reshape(-1, each)
    missed = []
    for (seen, flat), (angle, x, y, size) in zip(pieces, poses, strict=True):
        cos, sin = np.exp(size) * np.cos(angle), np.exp(size) * np.sin(angle)
        placed = flat @ np.array([[cos, sin], [-sin, cos]]) + (x, y)
        missed.append(apply(homography, placed) - seen)
    return np.concatenate(missed).ravel()


def direct(source: Points, target: Points) -> Points:
    """Return the homography of four or more points by the direct linear transformation."""
    x, y = source.T
    u, v = target.T
    one, none = np.ones_like(x), np.zeros_like(x)
    of_u = np.column_stack([x, y, one, none, none, none, -u * x, -u * y, -u])
    of_v = np.column_stack([none, none, none, x, y, one, -v * x, -v * y, -v])
    solution = np.linalg.svd(np.concatenate([of_u, of_v]))[2][-1].reshape(3, 3)
    return np.asarray(solution / solution[2, 2])


def rigid(source: Points, target: Points) -> tuple[Points, Points]:
    """Return the turn and the shift, never mirrored, that lay source on target best."""
    a, b = source - source.mean(axis=0), target - target.mean(axis=0)
    angle = np.arctan2((a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]).sum(), (a * b).sum())
    turn = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
    return turn, target.mean(axis=0) - turn @ source.mean(axis=0)
