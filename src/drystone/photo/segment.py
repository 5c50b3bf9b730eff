"""Stones in a photograph of stones laid out on a ground of another colour."""

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage
from skimage.feature import peak_local_max
from skimage.measure import regionprops
from skimage.segmentation import watershed

from drystone.errors import InputError
from drystone.kernels.raster import Mask
from drystone.photo.segment_ground import Ground, GroundModel, Planes, find_shadows, fit_ground

Labels = NDArray[np.int32]

WORKING_PX = 1_600_000
"""Size that a photograph is reduced to for this."""

_FLOOR_SHARE = 2e-4
"""Share of the picture of the smallest stone."""

ROUGH = 6.0
"""What a ground varies in CIELAB, robust standard deviation, that is no cloth, wood or gravel."""

VARIED = 4.0
"""The same that is more than cloth or wood: its grain hides stones of about its colour."""

_GRAIN_PX = 4
"""So far the picture is blurred to see these."""

_HIDDEN, _HIDDEN_SHARE = 4.0, 0.125
"""Distance from the blurred ground, in standard deviations, and least share of a usual stone."""

PLAIN = 5.0
"""Contrast of the usual outline over what the ground itself varies: from here on it is plain.

Photographs of river beds, walls and rooms have .8 to 4.7, stones on tarpaulin, cloth, wood, gravel
and grass 6.2 and more."""

_BITTEN = 0.05
"""What was taken for shadow within the convex hull of a stone, over the stone, that is in doubt."""

_SURELY_SHEET = 0.35
"""Share of the picture from which on a stone may be the sheet that stones lie on."""

_SHEET, _LARGER, _ON_SHEET, _COVERED = 0.1, 3.0, 3, 0.1
"""The same where stones are seen on it, its area over that of the next stone, how many lie on it at
least, and the share of it that they cover."""

_HORN = 0.12
"""Half the thickness of ends that are no stone, over that of the stone."""

_SPLIT_BELOW = 0.6
"""Necks narrower than this share of the thinner part are cut."""

_OTHER_COLOUR_BELOW, _OTHER_COLOUR = 0.85, 14.0
"""The same between parts of different rock, and their distance in CIELAB."""

_DOUBT_BELOW = 0.8
"""Necks that are not cut are reported below this share."""

EDGE = "at the edge of the photograph or cut by it"
PAPER = "beside a marker, which may be its paper"
SMALL = "too small (--min-area)"
SHADOW = "has the colour of shaded ground"
FAINT = "hardly differs from the ground"
THIN = "too thin"

_BESIDE_PX = 4
"""How far from a stone its blurred rim reaches, which is no shape of its own."""


@dataclass(frozen=True)
class LeftOut:
    """A shape that was not taken for a stone."""

    at_px: tuple[float, float]  # its middle, column and row
    area_px: int
    why: str


BAND_PX = 4
"""How far an outline may be moved at a time."""

ROUNDS = 3
"""How often at most.  All are moved twice; then only those near what still moves by some pixels.

A joint that was filled at first is cleared from its ends: half way there are spikes."""

_WINDOW_PX = 11
_LEAST_CONTRAST = 3.0


@dataclass(frozen=True)
class Neck:
    """A narrow place between two thicker parts of a piece."""

    at_px: tuple[float, float]  # its middle, column and row
    width_px: float
    share: float  # its width over the thickness of the thinner part
    cut: bool  # whether the parts became two stones


@dataclass(frozen=True, eq=False)
class FoundStones:
    """Stones that were found in a photograph."""

    labels: NDArray[np.uint16]  # (h, w) 1 ... n, in rows from the top left; 0 elsewhere
    necks: tuple[Neck, ...]  # cut and doubtful ones
    contrast: tuple[float, ...]  # along the weakest quarter of each outline, in CIELAB
    shaded: tuple[int, ...]  # stones with a part that may be shadow
    sheet: int | None  # the stone that may be the sheet that stones lie on
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
    papers: Mask | None = None,
    *,
    ground: Ground = "auto",
    min_area_px: float | None = None,
    split: bool = True,
) -> FoundStones:
    """Find stones in an RGB picture from above, of `WORKING_PX` or less for speed.

    `inside` (h, w) is False where there is no photograph, `papers` (h, w) True on markers; what
    touches them is their paper.  Areas below `min_area_px` are no stones: below a fiftieth of a
    usual stone, and a five thousandth of the picture, unless given.  `split` cuts touching stones
    apart at narrow necks.  E175 no stones; E176 no even ground.
    """
    papers = np.zeros(image.shape[:2], bool) if papers is None else papers
    usable = ~papers if inside is None else inside & ~papers
    model = fit_ground(image, usable, ground)
    # What may not be ground is far from its colour by what the ground itself varies ...
    distance = np.where(usable, model.distance, 0)
    near = distance[usable & (distance < 6)]
    low = float(np.clip(1.3 * np.percentile(near, 98), 3.0, 6.0)) if near.size else 3.0
    unlike = ndimage.binary_opening(distance > low)
    # ... and surely is none in pieces that are far from it somewhere.
    pieces, count = ndimage.label(unlike)
    farthest = np.asarray(ndimage.maximum(model.distance, pieces, np.arange(count + 1)))
    foreground = unlike & (farthest > 1.6 * low)[pieces]
    shadows, shadow_level, alike = find_shadows(model, foreground, usable)
    stone = _solid(foreground & ~shadows, usable)
    stone = refine_outlines(model.lab, stone, usable)
    stone = _without_horns(_solid(stone, usable))
    pieces, _ = ndimage.label(stone, np.ones((3, 3)))
    beside = stone & np.isin(pieces, pieces[ndimage.binary_dilation(papers, iterations=5)])
    labels, necks = split_stones(stone & ~beside, model.lab, split=split)
    found, cut, small, least_px = _sorted_out(labels, usable | papers, min_area_px)
    if not found.any():
        raise _no_stones(len(shapes(cut, EDGE)), model)
    known = stone | (labels > 0)
    hidden = _hidden(model, known, usable, found) & ~shadows
    causes = {SHADOW: shadows, FAINT: (unlike & ~foreground) | hidden}
    # Stones of which a part was taken for shadow; or a part, but not all, of what is left may be.
    body = ndimage.binary_opening(alike & (found > 0), iterations=3)
    share = np.bincount(found[body], minlength=found.max() + 1) / np.bincount(found.ravel())
    shaded = [
        int(region.label)
        for region in regionprops(found)
        if 0.15 < share[region.label] < 0.85
        or (shadows[region.slice] & region.image_convex).sum() > _BITTEN * region.area
    ]
    left_out = (
        *shapes(cut, EDGE), *shapes(beside, PAPER), *lost(unlike | hidden, known, causes, least_px),
        *shapes(small, SMALL),
    )  # fmt: skip
    contrast = contrast_along(model.lab, found.astype(np.int32))
    return FoundStones(
        labels=found,
        necks=tuple(neck for neck in necks if stones_at(found, neck.at_px)),
        contrast=tuple(contrast.tolist()),
        shaded=tuple(shaded),
        sheet=_sheet_among(image, found, ground),
        left_out=left_out,
        ground=model,
        shadow_level=shadow_level,
    )


def _sheet_among(image: NDArray[np.uint8], found: NDArray[np.uint16], ground: Ground) -> int | None:
    """Return the stone that may be a sheet: it is large, or stones lie apart on its colour."""
    areas = np.bincount(found.ravel())
    areas[0] = 0
    *others, largest = map(int, np.argsort(areas))
    if areas[largest] > _SURELY_SHEET * found.size:
        return largest
    if areas[largest] < max(_SHEET * found.size, _LARGER * max(areas[others])):
        return None
    try:
        within = segment(image, found == largest, ground=ground)
    except InputError:
        return None
    plain = float(np.median(within.contrast)) > PLAIN * float(within.ground.spread.max())
    # Spots of lichen are small beside the stone.
    large = np.count_nonzero(within.labels) > _COVERED * areas[largest]
    return largest if plain and large and within.count >= _ON_SHEET else None


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


def _sorted_out(
    labels: Labels, shown: Mask, least: float | None
) -> tuple[NDArray[np.uint16], Labels, Labels, float]:
    """Leave out what is too small or cut, and number the rest in rows.

    Returns that, what is cut, what is too small, and the least area.
    """
    areas = np.bincount(labels.ravel())
    areas[0] = 0
    if least is None:
        # Half of all that was found belongs to pieces larger than the usual area.
        ordered = np.sort(areas)[::-1]
        total = np.cumsum(ordered)
        usual = float(ordered[np.searchsorted(total, total[-1] / 2)])
        least = max(_FLOOR_SHARE * float(shown.sum()), usual / 50)
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


def stones_at(labels: NDArray[np.uint16], at_px: tuple[float, float]) -> list[int]:
    """Return the stones around a place."""
    column, row = round(at_px[0]), round(at_px[1])
    area = labels[max(row - 4, 0) : row + 5, max(column - 4, 0) : column + 5]
    return [int(k) for k in np.unique(area) if k]


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


def shapes(mask: NDArray[np.integer] | Mask, why: str) -> tuple[LeftOut, ...]:
    """Return the shapes of labels, or the pieces of a mask, the largest first."""
    labels = ndimage.label(mask)[0] if mask.dtype == bool else mask
    areas = np.bincount(labels.ravel())
    numbers = [int(k) for k in np.flatnonzero(areas) if k]
    middles = ndimage.center_of_mass(labels > 0, labels, numbers) if numbers else []
    found = [
        LeftOut((float(x) + 0.5, float(y) + 0.5), int(areas[k]), why)
        for k, (y, x) in zip(numbers, middles, strict=True)
    ]
    return tuple(sorted(found, key=lambda one: -one.area_px))


def lost(
    unlike: Mask, known: Mask, causes: Mapping[str, Mask], least_px: float
) -> tuple[LeftOut, ...]:
    """Return what is `unlike` the ground, as large as a stone, and in nothing that is `known`.

    `causes` say for what reason each px was taken away; without one it was too thin.
    """
    rest = unlike & ~ndimage.binary_dilation(known, iterations=_BESIDE_PX)
    pieces, count = ndimage.label(ndimage.binary_opening(rest, iterations=2))
    areas = np.bincount(pieces.ravel(), minlength=count + 1)
    near = np.zeros(count + 1, bool)
    near[np.unique(pieces[ndimage.binary_dilation(known, iterations=_BESIDE_PX + 3)])] = True
    found: list[LeftOut] = []
    for why, part in (*causes.items(), (THIN, None)):
        share = np.ones(count + 1)
        if part is not None:
            share = np.bincount(pieces[part], minlength=count + 1) / np.maximum(areas, 1)
        chosen = (areas >= least_px) & (share >= 0.5)
        chosen[0] = False
        areas = np.where(chosen, 0, areas)
        if why in (SHADOW, THIN):
            # The shadow of a stone and the rim of one are no shapes of their own.
            chosen &= ~near
        found += shapes(np.where(chosen[pieces], pieces, 0), why)
    return tuple(found)


def _hidden(model: GroundModel, known: Mask, usable: Mask, found: NDArray[np.uint16]) -> Mask:
    """Return what differs from a ground of coarse grain where that is blurred, as large as stones.

    Its px are as far from its colour as those of a stone of about that colour.
    """
    if model.spread.max() <= VARIED:
        return np.zeros_like(known)
    away = ndimage.gaussian_filter(model.lab, _GRAIN_PX, axes=(0, 1)) - model.colour
    spread = 1.48 * np.median(np.abs(away[usable & (model.distance < _HIDDEN)]), axis=0)
    far = np.linalg.norm(away / np.maximum(spread, 0.8), axis=-1) > _HIDDEN
    clear = usable & ~ndimage.binary_dilation(known, iterations=3 * _GRAIN_PX)
    pieces, _ = ndimage.label(ndimage.binary_opening(far & clear, iterations=_GRAIN_PX))
    large = np.bincount(pieces.ravel()) >= _HIDDEN_SHARE * np.median(np.bincount(found.ravel())[1:])
    # Shadows are not told from stones on such ground.  They lie beside what casts them.
    large[np.unique(pieces[ndimage.binary_dilation(~clear, iterations=2 * _GRAIN_PX)])] = False
    large[0] = False
    return np.asarray(large[pieces])


def refine_outlines(lab: Planes, stone: Mask, usable: Mask) -> Mask:
    """Move outlines to where the colour is half way between stone and ground.

    `stone` is where stones are, about; `usable` what the photograph shows of ground and stones.
    """
    near = np.ones_like(stone)
    for turn in range(ROUNDS):
        before = stone
        inner = ndimage.distance_transform_edt(stone)
        outer = ndimage.distance_transform_edt(~stone)
        band = (inner <= BAND_PX) & (outer <= BAND_PX) & usable
        here, there = _sides(lab, inner > BAND_PX, (outer > BAND_PX) & usable)
        way = here - there
        contrast = np.linalg.norm(way, axis=-1)
        share = ((lab - there) * way).sum(axis=-1) / np.maximum(contrast, 1e-6) ** 2
        moved = np.where(band & (contrast > _LEAST_CONTRAST), share > 0.5, stone)
        smooth = ndimage.median_filter(moved.astype(np.uint8), 5).astype(bool)
        stone = np.where(near, smooth, before)
        if turn > 0:
            moving = ndimage.binary_opening(stone != before, np.ones((3, 3)))
            near = ndimage.binary_dilation(moving, iterations=2 * BAND_PX)
        if not near.any():
            break
    return stone


def contrast_along(lab: Planes, labels: NDArray[np.int32]) -> NDArray[np.float64]:
    """Return the contrast in Lab along the weakest quarter of every outline, 1 ... n."""
    stone = labels > 0
    inner = ndimage.distance_transform_edt(stone)
    outer = ndimage.distance_transform_edt(~stone)
    here, there = _sides(lab, inner > 2, outer > 2)
    contrast = np.linalg.norm(here - there, axis=-1)
    rim = np.where(inner == 1, labels, 0)
    found = (contrast[rim == number] for number in range(1, int(labels.max()) + 1))
    # What other stones enclose has no rim.
    return np.array([float(np.percentile(one, 25)) if one.size else 0.0 for one in found])


def _sides(lab: Planes, inside: Mask, outside: Mask) -> tuple[Planes, Planes]:
    """Return the mean colours nearby of what is inside and of what is outside."""
    sides = []
    for part in (inside, outside):
        weight = _near(part[..., None].astype(np.float32))
        colour = _near(np.where(part[..., None], lab, np.float32(0))) / np.maximum(weight, 1e-4)
        sides.append(np.where(weight > 1e-3, colour, lab))
    return sides[0], sides[1]


def _near(values: NDArray[np.float32]) -> NDArray[np.float32]:
    """Return the mean nearby; twice a box is nearly a Gaussian, and faster."""
    once = ndimage.uniform_filter(values, _WINDOW_PX, axes=(0, 1))
    return np.asarray(ndimage.uniform_filter(once, _WINDOW_PX, axes=(0, 1)))


def split_stones(stone: Mask, lab: Planes, *, split: bool) -> tuple[Labels, tuple[Neck, ...]]:
    """Label stones, and cut pieces apart at narrow necks; without `split` only report those.

    The watershed of the distance to the ground gives the parts of a piece; two neighbours stay
    one stone unless the line between them is short beside the thickness of both.

    Neighbours of different colours may have a wider neck between them.  The necks are those that
    were cut, and those in doubt.
    """
    pieces, _ = ndimage.label(stone, np.ones((3, 3)))
    labels = np.zeros(stone.shape, np.int32)
    necks: list[Neck] = []
    number = 0
    for piece, box in enumerate(ndimage.find_objects(pieces), start=1):
        parts, found = _parts(pieces[box] == piece, lab[box], split=split)
        for neck in found:
            column, row = neck.at_px
            necks.append(replace(neck, at_px=(column + box[1].start, row + box[0].start)))
        labels[box] += np.where(parts > 0, parts + number, 0).astype(np.int32)
        number += int(parts.max())
    return labels, tuple(necks)


def _parts(piece: Mask, lab: Planes, *, split: bool) -> tuple[Labels, list[Neck]]:
    """Return the stones of one piece, and its necks."""
    depth = ndimage.distance_transform_edt(np.pad(piece, 1))[1:-1, 1:-1]
    smooth = ndimage.gaussian_filter(depth, 1.0)
    least = max(2.0, 0.2 * float(depth.max()))
    peaks = peak_local_max(
        smooth, min_distance=max(2, int(0.25 * depth.max())), threshold_abs=least,
        labels=piece.astype(np.int32), exclude_border=False,
    )  # fmt: skip
    if len(peaks) < 2:
        return piece.astype(np.int32), []
    seeds = np.zeros(piece.shape, np.int32)
    seeds[tuple(peaks.T)] = np.arange(1, len(peaks) + 1)
    basins = watershed(-smooth, seeds, mask=piece).astype(np.int32)
    return _joined(basins, depth, lab, split=split)


def _joined(
    basins: Labels, depth: NDArray[np.float64], lab: Planes, *, split: bool
) -> tuple[Labels, list[Neck]]:
    """Join basins across wide necks, the widest first; return stones and necks."""
    necks: list[Neck] = []

    def narrow(pair: tuple[int, int], neck: Neck) -> bool:
        if not split or not _SPLIT_BELOW <= neck.share < _OTHER_COLOUR_BELOW:
            return split and neck.share < _SPLIT_BELOW
        one, other = (np.median(lab[(basins == k) & (depth > 2)], axis=0) for k in pair)
        return float(np.hypot.reduce(one - other)) > _OTHER_COLOUR

    while True:
        thick = ndimage.maximum(depth, basins, np.arange(basins.max() + 1))
        measured = {}
        for pair, line in _lines(basins).items():
            # The line of a watershed wanders; the ground is as near on both sides as the neck is
            # wide.
            width = max(1.0, 2 * float(depth[tuple(line.T)].max()))
            row, column = line.mean(axis=0).tolist()
            thickness = max(2 * float(min(thick[pair[0]], thick[pair[1]])), 1e-9)
            measured[pair] = Neck((column, row), width, width / thickness, False)
        kept = {pair: neck for pair, neck in measured.items() if narrow(pair, neck)}
        joined = [pair for pair in measured if pair not in kept]
        if not joined:
            break
        pair = max(joined, key=lambda key: measured[key].share)
        if measured[pair].share < _DOUBT_BELOW:
            necks.append(measured[pair])
        basins[basins == pair[1]] = pair[0]
    necks += [replace(neck, cut=True) for neck in kept.values()]
    values = np.unique(basins)
    renumbered = np.searchsorted(values, basins) + (0 if values[0] == 0 else 1)
    return renumbered.astype(np.int32), necks


def _lines(basins: Labels) -> dict[tuple[int, int], NDArray[np.intp]]:
    """Return the px (n, 2) along the line between any two neighbours."""
    found: dict[tuple[int, int], list[NDArray[np.intp]]] = {}
    for axis in (0, 1):
        one = np.moveaxis(basins, axis, 0)[:-1]
        other = np.moveaxis(basins, axis, 0)[1:]
        where = np.argwhere((one != other) & (one > 0) & (other > 0))
        low = np.minimum(one[tuple(where.T)], other[tuple(where.T)])
        high = np.maximum(one[tuple(where.T)], other[tuple(where.T)])
        where = where[:, ::-1] if axis else where
        for pair in np.unique(np.stack([low, high], axis=-1), axis=0):
            at = where[(low == pair[0]) & (high == pair[1])]
            found.setdefault((int(pair[0]), int(pair[1])), []).append(at)
    return {pair: np.concatenate(parts) for pair, parts in found.items()}
