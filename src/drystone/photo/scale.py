"""From markers to the scale and the view of a photograph."""

import math
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from drystone.errors import InputError, Notice
from drystone.photo.common_plane import CommonPlane, Piece, direct, fit_plane
from drystone.photo.dictionaries import DICTIONARIES, FAMILIES
from drystone.photo.layout import MarkerLayout
from drystone.photo.markers import FoundMarker
from drystone.photo.rectify import refuse_horizon
from drystone.photo.view import SQUARE, View, apply, jacobian


@dataclass(frozen=True)
class MarkerLimits:
    """When markers are not used, and when they are not believed."""

    least_side_px: float = 40.0  # smaller markers are left out (W171)
    small_side_px: float = 100.0  # when the largest marker is smaller, the scale is in doubt (W172)
    least_slant: float = 0.35  # length over width; those more foreshortened are left out (W171)
    most_percent: float = 1.0  # residual of a marker over its side; beyond, they disagree (E172)
    # Difference of the sizes of two papers, where it is no noise, beyond which they disagree.
    most_size_percent: float = 1.5
    surer: float = 15.0  # F statistic from which on it is no noise
    doubtful_percent: float = 0.5  # residual of all from which on the scale is in doubt (W172)


def scale_and_view(
    found: tuple[FoundMarker, ...],
    layout: MarkerLayout,
    size_px: tuple[int, int],
    limits: MarkerLimits | None = None,
) -> View:
    """Find the scale and the perspective of a photograph from at least two markers.

    `size_px` is width and height of the photograph.  E170 fewer than two markers that can be used;
    E171 an id twice; E172 markers that disagree; E173 a view with the horizon in it.
    """
    limits = limits or MarkerLimits()
    used, notices = _usable(found, layout, limits)
    groups = sorted({layout.group(marker.id) for marker in used})
    papers = [[marker for marker in used if layout.group(marker.id) == one] for one in groups]
    plane = fit_plane(
        [
            Piece(
                np.concatenate([marker.corners_px for marker in paper]),
                np.concatenate([layout.corners_m(marker.id) for marker in paper]),
            )
            for paper in papers
        ]
    )
    if plane is None:
        raise _disagreement("No view of the ground gives all of them their size")
    residual_m = _believed(papers, plane, layout, limits)
    percent = 100.0 * residual_m / layout.side_m
    notices += _doubts(used, percent, limits)
    refuse_horizon(View(plane.to_plane, 1.0, (used[0].id,)), size_px)
    to_ground = _upright(plane.to_plane, size_px)
    metres_per_px = math.sqrt(np.linalg.det(jacobian(to_ground, _middle(size_px))))
    ids = tuple(marker.id for marker in used)
    return View(to_ground, 1.0 / metres_per_px, ids, 1000.0 * residual_m, percent, notices)


def _usable(
    found: Sequence[FoundMarker], layout: MarkerLayout, limits: MarkerLimits
) -> tuple[tuple[FoundMarker, ...], tuple[Notice, ...]]:
    """Return at least two markers that can be measured, and say which were left out."""
    notices: list[Notice] = []
    family = found[0].dictionary if found else "aruco"
    if family not in DICTIONARIES:
        notices.append(_other_family(found, layout))
    known = [one for one in found if layout.lists(one.id)]
    twice = [one for one, count in Counter(marker.id for marker in known).items() if count > 1]
    if twice:
        raise InputError(
            "E171",
            f"{_markers(twice)} can be seen twice, so it is not known which is which.",
            where="markers",
            cure="Use every marker once: `drystone markers --ids` prints others.",
        )
    strange = sorted({one.id for one in found} - {one.id for one in known})
    if strange:
        others = "of the sheet" if layout.page else "to be used"
        known_ids = ", ".join(map(str, layout.ids or ()))
        said = f"{_markers(strange)} left out: not one {others} ({known_ids})."
        notices.append(Notice("W170", said))
    small = [one for one in known if one.side_px < limits.least_side_px]
    slanted = [one for one in known if one not in small and _slant(one) < limits.least_slant]
    used = tuple(one for one in known if one not in small and one not in slanted)
    for poor, why in (
        (small, f"smaller than {limits.least_side_px:g} px"),
        (slanted, "seen at too flat an angle"),
    ):
        if poor:
            said = ", ".join(f"{one.id} ({one.side_px:.0f} px)" for one in poor)
            notices.append(Notice("W171", f"Markers left out, {why}: {said}.", _NEARER))
    if len(used) < 2:
        raise _too_few(found, used, notices, strange)
    return used, tuple(notices)


def _other_family(found: Sequence[FoundMarker], layout: MarkerLayout) -> Notice:
    """Say that markers are not of those that are printed here; a sheet cannot be of such (E170)."""
    what = f"{_markers(sorted({one.id for one in found}))} of {FAMILIES[found[0].dictionary]}"
    printed = " and ".join(FAMILIES[name] for name in DICTIONARIES)
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
        read = ", ".join(FAMILIES.values())
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
    papers: Sequence[Sequence[FoundMarker]],
    plane: CommonPlane,
    layout: MarkerLayout,
    limits: MarkerLimits,
) -> float:
    """Return the residual of all corners, metres; refuse markers that disagree (E172)."""
    _same_size(papers, plane, layout, limits)
    square_m = {
        marker.id: (off[4 * i : 4 * i + 4] ** 2).sum(axis=1)
        for paper, off in zip(papers, plane.off_m, strict=True)
        for i, marker in enumerate(paper)
    }
    rms_m = {one: math.sqrt(float(square.mean())) for one, square in square_m.items()}
    worst = max(rms_m, key=lambda one: rms_m[one])
    if not 100.0 * rms_m[worst] <= limits.most_percent * layout.side_m:
        raise _disagreement(
            f"Marker {worst} is {1000 * rms_m[worst]:.1f} mm off "
            f"({100 * rms_m[worst] / layout.side_m:.1f} % of its side; the limit is "
            f"{limits.most_percent:g} %)"
        )
    return math.sqrt(float(np.concatenate(list(square_m.values())).mean()))


def _same_size(
    papers: Sequence[Sequence[FoundMarker]],
    plane: CommonPlane,
    layout: MarkerLayout,
    limits: MarkerLimits,
) -> None:
    """Refuse markers of sizes that differ (E172): perspective can hide that from the residual."""
    spread = 100.0 * (float(plane.sizes.max() / plane.sizes.min()) - 1.0)
    if plane.surer <= limits.surer or spread <= limits.most_size_percent:
        return
    low, high = (papers[int(one)][0].id for one in (plane.sizes.argmin(), plane.sizes.argmax()))
    raise _disagreement(
        f"Marker {high} seems to be {spread:.1f} % larger than marker {low}, and both should "
        f"measure {1000 * layout.side_m:g} mm"
    )


def _disagreement(what: str) -> InputError:
    return InputError(
        "E172",
        f"the markers disagree with each other. {what}.",
        where="markers",
        cure="Print all at 100 %, and give --aruco the size that was printed. Lay them flat in one "
        "plane, with all of the white border in the picture, and do not cut a sheet up.",
    )


def _doubts(
    used: Sequence[FoundMarker], percent: float, limits: MarkerLimits
) -> tuple[Notice, ...]:
    notices = []
    largest = max(marker.side_px for marker in used)
    if largest < limits.small_side_px:
        said = f"The largest marker is {largest:.0f} px wide: the scale may be 1 % off."
        notices.append(Notice("W172", said, _NEARER))
    if percent > limits.doubtful_percent:
        said = f"The corners of the markers are {percent:.1f} % of a marker off on average."
        notices.append(Notice("W172", said, "Are they flat, sharp, and in the same plane?"))
    return tuple(notices)


def _slant(marker: FoundMarker) -> float:
    """Return how foreshortened a marker is: 1 from straight above, 0 from the side."""
    local = jacobian(direct(SQUARE, marker.corners_px), np.array([0.5, 0.5]))
    long, short = np.linalg.svd(local, compute_uv=False)
    return float(short / long)


def _upright(to_plane: NDArray[np.float64], size_px: tuple[int, int]) -> NDArray[np.float64]:
    """Turn and move the plane so that the picture stays upright and begins at 0, 0."""
    local = jacobian(to_plane, _middle(size_px))
    angle = math.atan2(local[1, 0] - local[0, 1], local[0, 0] + local[1, 1])
    cos, sin = math.cos(angle), math.sin(angle)
    turned = np.array([[cos, sin, 0.0], [-sin, cos, 0.0], [0.0, 0.0, 1.0]]) @ to_plane
    low = apply(turned, SQUARE * size_px).min(axis=0)
    return np.array([[1.0, 0.0, -low[0]], [0.0, 1.0, -low[1]], [0.0, 0.0, 1.0]]) @ turned


def _middle(size_px: tuple[int, int]) -> NDArray[np.float64]:
    return np.array([size_px[0] / 2.0, size_px[1] / 2.0])


def _markers(ids: Sequence[int]) -> str:
    return f"marker{'s' * (len(ids) > 1)} {', '.join(map(str, ids))}"
