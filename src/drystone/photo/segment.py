"""Stones in a photograph of stones laid out on a ground of another colour."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage

from drystone.errors import InputError
from drystone.kernels.raster import Mask
from drystone.photo.left_out import EDGE, FAINT, PAPER, SHADOW, SMALL, LeftOut, lost, shapes
from drystone.photo.segment_ground import GroundModel, fit_ground
from drystone.photo.segment_outline import contrast_along, refine_outlines
from drystone.photo.segment_settings import SegmentSettings
from drystone.photo.segment_shadow import Shadows, find_shadows
from drystone.photo.segment_split import Labels, Neck, split_stones

WORKING_PX = 1_600_000
"""Size that a photograph is reduced to for this."""

_FLOOR_SHARE = 2e-4
"""Share of the picture of the smallest stone."""


ROUGH = 6.0
"""What a ground varies in CIELAB, robust standard deviation, that is no cloth, wood or gravel."""

_HORN = 0.12
"""Half the thickness of ends that are no stone, over that of the stone."""


@dataclass(frozen=True, eq=False)
class FoundStones:
    """Stones that were found in a photograph."""

    labels: NDArray[np.uint16]  # (h, w) 1 ... n, in rows from the top left; 0 elsewhere
    necks: tuple[Neck, ...]  # cut and doubtful ones
    contrast: tuple[float, ...]  # along the weakest quarter of each outline, in CIELAB
    shaded: tuple[int, ...]  # stones with a part that may be shadow
    left_out: tuple[LeftOut, ...]  # shapes that were not taken for stones
    ground: GroundModel
    shadow_level: float  # light in cast shadows over that beside them; 1 when there are none

    @property
    def count(self) -> int:
        """Number of stones."""
        return int(self.labels.max())


def segment(
    image: NDArray[np.uint8],
    inside: Mask | None = None,
    settings: SegmentSettings | None = None,
    papers: Mask | None = None,
) -> FoundStones:
    """Find stones in an RGB picture from above, of `WORKING_PX` or less for speed.

    `inside` (h, w) is False where there is no photograph, `papers` (h, w) True on markers; what
    touches them is their paper.  E175 no stones; E176 no even ground.
    """
    settings = settings or SegmentSettings()
    papers = np.zeros(image.shape[:2], bool) if papers is None else papers
    usable = ~papers if inside is None else inside & ~papers
    ground = fit_ground(image, usable, settings.ground)
    unlike, low = _unlike(ground, usable)
    foreground = _surely(unlike, low, ground)
    shadows = find_shadows(ground, foreground, usable)
    stone = _solid(foreground & ~shadows.mask, usable)
    stone = refine_outlines(ground.lab, stone, usable)
    stone = _without_horns(_solid(stone, usable))
    beside = _beside(stone, papers)
    labels, necks = split_stones(stone & ~beside, ground.lab, settings)
    found, cut, small, least_px = _sorted_out(labels, usable | papers, settings)
    if not found.any():
        raise _no_stones(len(shapes(cut, EDGE)), ground)
    causes = {SHADOW: shadows.mask, FAINT: unlike & ~foreground}
    known = stone | (labels > 0)
    left_out = (
        *shapes(cut, EDGE), *shapes(beside, PAPER), *lost(unlike, known, causes, least_px),
        *shapes(small, SMALL),
    )  # fmt: skip
    count = int(found.max())
    contrast = contrast_along(ground.lab, found.astype(np.int32), count)
    return FoundStones(
        labels=found,
        necks=tuple(neck for neck in necks if stones_at(found, neck.at_px)),
        contrast=tuple(float(value) for value in contrast),
        shaded=_shaded(found, shadows, count),
        left_out=left_out,
        ground=ground,
        shadow_level=shadows.level,
    )


def _unlike(ground: GroundModel, usable: Mask) -> tuple[Mask, float]:
    """Return what may not be ground: far from its colour by what the ground itself varies."""
    distance = np.where(usable, ground.distance, 0)
    near = distance[usable & (distance < 6)]
    low = float(np.clip(1.3 * np.percentile(near, 98), 3.0, 6.0)) if near.size else 3.0
    return np.asarray(ndimage.binary_opening(distance > low)), low


def _surely(unlike: Mask, low: float, ground: GroundModel) -> Mask:
    """Return the pieces that are far from the colour of the ground somewhere."""
    pieces, count = ndimage.label(unlike)
    seen = ndimage.maximum(ground.distance, pieces, np.arange(count + 1))
    return np.asarray(unlike & (np.asarray(seen) > 1.6 * low)[pieces])


def _solid(mask: Mask, usable: Mask) -> Mask:
    """Smooth, and fill holes; what stones enclose by touching all round stays open."""
    mask = ndimage.binary_opening(ndimage.binary_closing(mask, iterations=2) & usable, iterations=2)
    holes, count = ndimage.label(ndimage.binary_fill_holes(mask) & ~mask)
    pieces, _ = ndimage.label(mask, np.ones((3, 3)))
    sizes = np.bincount(pieces.ravel())
    areas = np.bincount(holes.ravel(), minlength=count + 1)
    around = ndimage.maximum_filter(pieces, 3)
    owner = np.asarray(ndimage.maximum(around, holes, np.arange(count + 1)), int)
    small = areas < 0.15 * sizes[owner]
    small[0] = False
    return np.asarray(mask | (small[holes] & usable))


def _without_horns(stone: Mask) -> Mask:
    """Take away thin ends, such as the rim of a shadow; corners stay."""
    stone = stone.copy()
    pieces, _ = ndimage.label(stone, np.ones((3, 3)))
    for number, box in enumerate(ndimage.find_objects(pieces), start=1):
        piece = np.pad(pieces[box] == number, 1)
        depth = ndimage.distance_transform_edt(piece)
        radius = _HORN * float(depth.max())
        thick = ndimage.distance_transform_edt(depth <= radius) <= radius
        thin, count = ndimage.label(piece & ~(thick | (depth > radius)), np.ones((3, 3)))
        large = np.bincount(thin.ravel(), minlength=count + 1) > radius**2
        large[0] = False
        stone[box] &= ~large[thin][1:-1, 1:-1]
    return stone


def _beside(stone: Mask, papers: Mask) -> Mask:
    """Return what touches markers."""
    if not papers.any():
        return np.zeros_like(stone)
    pieces, count = ndimage.label(stone, np.ones((3, 3)))
    touched = np.zeros(count + 1, bool)
    touched[np.unique(pieces[ndimage.binary_dilation(papers, iterations=5)])] = True
    touched[0] = False
    return np.asarray(stone & touched[pieces])


def _sorted_out(
    labels: Labels, shown: Mask, settings: SegmentSettings
) -> tuple[NDArray[np.uint16], Labels, Labels, float]:
    """Leave out what is too small or cut, and number the rest in rows.

    Returns that, what is cut, what is too small, and the least area.
    """
    areas = np.bincount(labels.ravel())
    areas[0] = 0
    least = settings.min_area_px
    if least is None:
        least = max(_FLOOR_SHARE * float(shown.sum()), _usual(areas) / 50)
    large = areas >= least
    number = np.arange(len(areas))
    middles = np.array(ndimage.center_of_mass(labels > 0, labels, number[1:])).reshape(-1, 2)
    near_edge = ~ndimage.binary_erosion(shown, iterations=4)
    cut = np.isin(number, np.unique(labels[near_edge])) & large
    kept = np.flatnonzero(large & ~cut)
    new = np.zeros(len(areas), np.uint16)
    if len(kept):
        # As one reads: by rows as high as a stone, then from left to right.
        size = max(float(np.sqrt(np.median(areas[kept]))), 1.0)
        rows = np.floor(middles[kept - 1, 0] / size)
        order = np.lexsort((middles[kept - 1, 1], rows))
        new[kept[order]] = np.arange(1, len(kept) + 1)
    small = (areas > 0) & ~large
    return new[labels], np.where(cut[labels], labels, 0), np.where(small[labels], labels, 0), least


def _usual(areas: NDArray[np.int64]) -> float:
    """Return the area that half of all that was found belongs to pieces larger than."""
    ordered = np.sort(areas)[::-1]
    total = np.cumsum(ordered)
    return float(ordered[int(np.searchsorted(total, total[-1] / 2))]) if total[-1] else 0.0


def stones_at(labels: NDArray[np.uint16], at_px: tuple[float, float], near: int = 4) -> list[int]:
    """Return the stones around a place."""
    column, row = round(at_px[0]), round(at_px[1])
    area = labels[max(row - near, 0) : row + near + 1, max(column - near, 0) : column + near + 1]
    return [int(k) for k in np.unique(area) if k]


def _shaded(labels: NDArray[np.uint16], shadows: Shadows, count: int) -> tuple[int, ...]:
    """Return stones of which a part, but not all, has the colour of shaded ground."""
    body = ndimage.binary_opening(shadows.alike & (labels > 0), iterations=3)
    alike = np.bincount(labels[body], minlength=count + 1)
    share = alike / np.maximum(np.bincount(labels.ravel(), minlength=count + 1), 1)
    return tuple(int(k) for k in range(1, count + 1) if 0.15 < share[k] < 0.85)


def _no_stones(cut: int, ground: GroundModel) -> InputError:
    beside = f" (but for {cut} cut by the edge of the photograph)" if cut else ""
    what = (
        f"no stones were found{beside}: {100 * ground.share:.0f} % of the photograph has the "
        "colour of its ground"
    )
    cure = "Photograph whole stones on other ground, lower --min-area, or `drystone trace` a wall."
    varies = float(ground.spread.max())
    if varies > ROUGH:
        what += f", which is not plain (it varies by {varies:.0f} in CIELAB)"
        cure = (
            "Lay stones apart on a plain sheet of another colour. Trace stones of a river bed, a "
            "heap or a wall, or find them with other programs: `drystone stones` reads their "
            "masks (docs/photographs.md)."
        )
    return InputError("E175", f"{what}.", cure=cure)
