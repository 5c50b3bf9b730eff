"""Test photographs: stones on a ground, lit, and the truth about them (``levels.toml``)."""

import io
import math
import tomllib
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Literal, NamedTuple

import numpy as np
from numpy.random import Generator
from numpy.typing import NDArray
from PIL import Image
from scipy import ndimage
from skimage.draw import polygon2mask
from skimage.transform import downscale_local_mean, matrix_transform, warp

from drystone.drawing.palette import linear, rgb
from drystone.generate import FourierSettings, RubbleSettings, fourier_stones, rubble_stones
from drystone.kernels.raster import Mask
from drystone.photo.layout import ON_A_SHEET, MarkerLayout, page_mm, parse_layout
from drystone.photo.markers import marker_modules

Markers = Literal["sheet", "single", "none"]
GroundKind = Literal["plywood", "tarpaulin", "cloth", "rubber", "gravel", "grass"]
Rock = Literal["granite", "sandstone", "limestone", "basalt", "schist"]


@dataclass(frozen=True, kw_only=True)
class PhotoLevel:
    """What a photograph shows, and what the camera does to it."""

    name: str
    seed: int = 1
    count: int = 24  # Stones; a few less when they find no place
    angular: float = 0.5  # Share of the stones that are rubble, 0 to 1; the others are rounded
    rocks: tuple[Rock, ...] = ("granite", "sandstone", "limestone")  # Kinds of rock, in turn
    ground: GroundKind = "tarpaulin"
    gap_px: int = 24  # Empty px between stones and between stones and the edge, at least
    touching: int = 0  # Stones that are pushed against another one
    cut: int = 0  # Stones that the edge of the photograph cuts
    shadow: float = 0.0  # How much light a cast shadow takes, 0 to 1
    sun_deg: float = 50.0  # Height of the light above the ground
    # How much darker the darkest place of the ground is lit than the brightest, 0 to 1
    uneven: float = 0.0
    markers: Markers = "sheet"  # A sheet of four, four single ones, or none
    marker_mm: float = 75.0  # Side of a marker
    wrong_print: float = 1.0  # How much too large the last paper was printed; 1 is right
    tilt_deg: float = 0.0  # How far the camera looks away from the vertical
    turn_deg: float = 0.0  # How far the photograph is turned about the line of sight
    # blur_px, noise, quality: Radius (sigma) of the defocus, standard deviation of the sensor's
    # noise in grey values, quality of the JPEG
    blur_px: float = 0.6
    noise: float = 1.5
    quality: int = 92
    orientation: int = 1  # EXIF orientation, 1 to 8, with which the file is stored
    width_px: int = 2000  # width_px, height_px: Of the photograph as it is seen
    height_px: int = 1500
    px_per_m: float = 1250.0  # About, in the middle of the photograph


_FILE = tomllib.loads(Path(__file__).with_name("levels.toml").read_text("utf-8"))

LEVELS = tuple(
    PhotoLevel(**level | {"rocks": tuple(level.get("rocks", PhotoLevel.rocks))})
    for level in _FILE["levels"]
)
"""Test photographs, from easy to hard."""

Labels = NDArray[np.uint16]
Window = tuple[slice, slice]
TRIES = 400


def lay_stones(level: PhotoLevel, forbidden: Mask, seen: Mask, rng: Generator) -> Labels:
    """Lay stones down where there is room; return them, 1 ... n, 0 elsewhere.

    `forbidden` (h, w) is where the markers are, `seen` (h, w) what the camera sees of the ground.
    """
    masks = [np.rot90(mask, int(rng.integers(4))) for mask in _shapes(level, rng)]
    masks.sort(key=lambda mask: -int(mask.sum()))
    inside = ndimage.distance_transform_edt(np.pad(seen, 1))[1:-1, 1:-1] > level.gap_px
    edge = inside & ~ndimage.binary_erosion(inside)
    table = _Table(
        np.zeros(forbidden.shape, np.uint16), forbidden.copy(), ~inside | forbidden, level.gap_px
    )
    for turn, mask in enumerate(masks):
        if turn >= len(masks) - level.touching and table.count:
            table.push(mask, rng)
        elif turn < level.cut:
            table.drop(mask, np.argwhere(edge), rng, table.taken)
        else:
            table.drop(mask, np.argwhere(inside), rng, table.taken | table.outside)
    return table.labels


def _shapes(level: PhotoLevel, rng: Generator) -> list[Mask]:
    """Return masks that cover about a quarter of the photograph, which leaves room for all."""
    angular = round(level.angular * level.count)
    area = 0.24 * level.width_px * level.height_px / level.count
    radius = float(np.sqrt(area / np.pi))
    masks: list[Mask] = []
    if level.count > angular:
        rounded = FourierSettings(
            count=level.count - angular, smallest_radius_px=0.6 * radius,
            largest_radius_px=1.35 * radius, D2=0.12,
        )  # fmt: skip
        masks += [stone.mask for stone in fourier_stones(rounded, rng)]
    if angular:
        side = float(np.sqrt(area * angular))
        rubble = RubbleSettings(
            count=angular, width_px=1.5 * side, height_px=side / 1.5,
            courses=max(1, round(np.sqrt(0.7 * angular))),
        )  # fmt: skip
        masks += [stone.mask for stone in rubble_stones(rubble, rng)]
    return masks


@dataclass
class _Table:
    """The ground while stones are laid on it."""

    labels: Labels
    taken: Mask
    outside: Mask
    gap_px: int
    count: int = 0

    def drop(self, mask: Mask, middles: NDArray[np.intp], rng: Generator, blocked: Mask) -> None:
        """Lay a stone at one of the places where it covers nothing that is blocked."""
        for middle in rng.integers(len(middles), size=TRIES):
            box = self._box(middles[middle] - np.array(mask.shape) // 2, mask)
            if box is not None and not (blocked[box] & mask).any():
                self._lay(box, mask)
                return

    def push(self, mask: Mask, rng: Generator) -> None:
        """Move a stone towards another until they touch, if it can lie there."""
        for _ in range(TRIES // 10):
            beside = int(rng.integers(1, self.count + 1))
            angle = rng.uniform(0, 2 * np.pi)
            box = self._contact(beside, mask, np.array([np.sin(angle), np.cos(angle)]))
            if box is not None:
                self._lay(box, mask)
                return

    def _contact(self, beside: int, mask: Mask, way: NDArray[np.float64]) -> Window | None:
        """Return where a stone that comes along a ray meets the other; None when it cannot lie."""
        old = self.labels == beside
        middle = np.argwhere(old).mean(axis=0) - np.array(mask.shape) / 2
        reach = int(max(mask.shape) + 2 * np.sqrt(old.sum()))
        for near in range(reach):
            box = self._box(middle + way * near, mask)
            if box is None:
                return None
            if not (old[box] & mask).any():
                bad = self.outside[box] | (self.labels[box] != 0)
                return None if (bad & mask).any() else box
        return None

    def _box(self, corner: NDArray[np.floating], mask: Mask) -> Window | None:
        """Return the window of a stone from its upper left corner; None where it has no room."""
        row, col = (int(k) for k in corner)
        box = slice(row, row + mask.shape[0]), slice(col, col + mask.shape[1])
        inside = min(row, col) >= 0 and self.labels[box].shape == mask.shape
        return box if inside else None

    def _lay(self, box: Window, mask: Mask) -> None:
        self.count += 1
        self.labels[box][mask] = self.count
        gap = self.gap_px
        rows, cols = (slice(max(one.start - gap, 0), one.stop + gap) for one in box)
        self.taken[rows, cols] |= ndimage.distance_transform_edt(self.labels[rows, cols] == 0) < gap


Plane = NDArray[np.float32]
"""(h, w)."""
Light = NDArray[np.float32]
"""(h, w, 3), linear, 0 to 1 for what a camera can record."""


def _light(colour: str) -> NDArray[np.float32]:
    """Return the linear light of ``"#rrggbb"``.

    >>> [round(float(part), 3) for part in _light("#ff8000")]
    [1.0, 0.216, 0.0]
    """
    return np.array([*map(linear, rgb(colour))], np.float32)


def clouds(
    shape: tuple[int, int], cells: Sequence[tuple[float, float]], rng: Generator, fall: float = 0.6
) -> Plane:
    """Return noise of several octaves with mean 0 and standard deviation about 1."""
    total, power, strength = np.zeros(shape, np.float32), 0.0, 1.0
    for down, across in cells:
        grid = (max(2, round(shape[0] / down) + 1), max(2, round(shape[1] / across) + 1))
        noise = Image.fromarray(rng.standard_normal(grid).astype(np.float32))
        fine = np.asarray(noise.resize((shape[1], shape[0]), Image.Resampling.BICUBIC))
        total += strength * fine / max(float(fine.std()), 1e-6)
        power += strength**2
        strength *= fall
    return np.asarray(total / np.sqrt(power), np.float32)


def stone_face(rock: Rock, shape: tuple[int, int], rng: Generator) -> Light:
    """Return the surface of a stone, flat and evenly lit: clouds, specks and veins on a colour."""
    colours, cloudy, speckled, veined = _FILE["rocks"][rock].values()
    base = _light(colours[int(rng.integers(len(colours)))])
    base = base * np.float32(rng.uniform(0.85, 1.15))
    size = max(shape)
    light = cloudy * clouds(shape, [(size / k, size / k) for k in (2, 4, 9, 20)], rng, 0.7)
    specks = clouds(shape, [(5, 5), (2.5, 2.5)], rng, 0.8)
    light += speckled * (0.5 * (specks > 1.1) - 0.8 * (specks < -1.2))
    ridge = 1 - np.abs(clouds(shape, [(size / 2, size / 5), (size / 6, size / 9)], rng, 0.4)) * 6
    light += veined * np.clip(ridge, 0, 1)
    tint = 0.03 * clouds(shape, [(size / 2, size / 2), (size / 6, size / 6)], rng)
    colour = base * (1 + light[..., None])
    colour[..., 0] *= 1 + tint
    colour[..., 2] *= 1 - tint
    return np.asarray(np.clip(colour, 0.01, 1.0), np.float32)


def ground_surface(ground: GroundKind, shape: tuple[int, int], rng: Generator) -> Light:
    """Return a ground, evenly lit."""

    def noise(*cells: tuple[float, float], fall: float = 0.6) -> Plane:
        return clouds(shape, cells, rng, fall)

    redder = np.zeros(shape, np.float32)
    match ground:
        case "plywood":
            grain = noise((14, 900), (5, 300), (2, 90), fall=0.8)
            light = 1 + 0.06 * grain + 0.04 * noise((400, 1500))
        case "tarpaulin":
            rows, cols = np.indices(shape, np.float32)
            weave = np.sin(rows * 1.1) * np.sin(cols * 1.1)
            light = 1 + 0.05 * weave + 0.08 * noise((500, 300), (160, 200), fall=0.4)
        case "cloth":
            folds = noise((420, 260), (120, 150), fall=0.4)
            light = 1 + 0.03 * folds + 0.02 * noise((2, 6), (6, 2), fall=0.9)
        case "rubber":
            light = 1 + 0.25 * noise((5, 5), (2.5, 2.5), fall=0.8)
        case "gravel":
            light = 1 + 0.16 * noise((7, 7), (4, 4), (2.5, 2.5), fall=0.8)
            redder = 0.04 * noise((9, 9))
        case "grass":
            blades = noise((16, 5), (9, 3), (4, 3), fall=0.8)
            patches = noise((220, 220), (70, 70))
            light = np.exp(0.35 * blades + 0.12 * patches)
            redder = 0.12 * patches
    colour = _light(_FILE["grounds"][ground]) * light[..., None]
    colour[..., 0] *= 1 + redder
    return np.asarray(np.clip(colour, 0.005, 1.0), np.float32)


Homography = NDArray[np.floating]
"""(3, 3); maps points (x, y, 1), y down, px."""

_TURNS = {
    2: Image.Transpose.FLIP_LEFT_RIGHT, 3: Image.Transpose.ROTATE_180,
    4: Image.Transpose.FLIP_TOP_BOTTOM, 5: Image.Transpose.TRANSPOSE,
    6: Image.Transpose.ROTATE_90, 7: Image.Transpose.TRANSVERSE, 8: Image.Transpose.ROTATE_270,
}  # fmt: skip
"""How a picture is stored that a viewer turns back for its EXIF orientation."""


def view_of(level: PhotoLevel) -> tuple[Homography, Mask]:
    """Return the homography from the ground to the photograph, and where the ground is seen.

    The homography takes ground px to px of the photograph; the mask is as large as the ground.
    """
    focal = 1.2 * level.width_px  # as that of a phone
    tilt, turn = math.radians(level.tilt_deg), math.radians(level.turn_deg)
    spin = np.array(
        [[math.cos(turn), -math.sin(turn), 0], [math.sin(turn), math.cos(turn), 0], [0, 0, 1]]
    )
    look = np.array([[focal, 0, 0], [0, focal * math.cos(tilt), 0], [0, -math.sin(tilt), focal]])
    middle = np.array([[1, 0, level.width_px / 2], [0, 1, level.height_px / 2], [0, 0, 1]])
    centred = middle @ look @ spin
    width, height = level.width_px, level.height_px
    frame = np.array([[0, 0], [width, 0], [width, height], [0, height]], float)
    corners = matrix_transform(frame, np.linalg.inv(centred))
    low, high = np.floor(corners.min(axis=0)), np.ceil(corners.max(axis=0))
    shift = np.array([[1, 0, low[0]], [0, 1, low[1]], [0, 0, 1]])
    homography = centred @ shift
    corners = matrix_transform(frame, np.linalg.inv(homography))
    width, height = (int(side) for side in high - low)
    return homography, polygon2mask((height, width), corners[:, ::-1])


def exposed(ground: Light, homography: Homography, level: PhotoLevel, rng: Generator) -> bytes:
    """Return the JPEG that a camera makes of a lit ground."""
    shape = (level.height_px, level.width_px)
    # Centres of px lie at halves in the homography and at whole numbers in `warp`.
    half = np.array([[1, 0, 0.5], [0, 1, 0.5], [0, 0, 1]])
    back = np.linalg.inv(half) @ np.linalg.inv(homography) @ half
    seen = warp(ground, back, output_shape=shape, order=1, mode="edge", preserve_range=True)
    light = np.clip(ndimage.gaussian_filter(seen, level.blur_px, axes=(0, 1)), 0, 1)
    grey = 255 * np.where(light <= 0.0031308, 12.92 * light, 1.055 * light ** (1 / 2.4) - 0.055)
    grey += rng.normal(0, level.noise, grey.shape)
    picture = Image.fromarray(np.clip(np.rint(grey), 0, 255).astype(np.uint8))
    if level.orientation != 1:
        picture = picture.transpose(_TURNS[level.orientation])
    exif = Image.Exif()
    exif[0x0112] = level.orientation
    file = io.BytesIO()
    picture.save(file, "JPEG", quality=level.quality, exif=exif)
    return file.getvalue()


PAPER, INK = 0.82, 0.03
"""Linear light of paper and ink."""

_FINE = 3
"""Samples along a side of a px."""


def layout_of(level: PhotoLevel) -> MarkerLayout | None:
    """Return the markers of a photograph as its user would name them; None without."""
    names = {"sheet": f"A4:{level.marker_mm:g}mm", "single": f"{level.marker_mm:g}mm"}
    return None if level.markers == "none" else parse_layout(names[level.markers])


def place_markers(level: PhotoLevel, surface: Light, seen: Mask) -> Mask:
    """Draw markers on the ground; return where no stone may lie."""
    layout = layout_of(level)
    covered = np.zeros(seen.shape, bool)
    if layout is None:
        return covered
    numbers = range(ON_A_SHEET)
    if layout.page:
        width, height = page_mm(layout.page)
        squares = tuple((layout.corners_m(k)[0], marker_modules("aruco", k)) for k in numbers)
        papers = [_Paper((width / 1000, height / 1000), squares, layout.size_m)]
    else:
        border = 0.3 * layout.size_m  # of white paper
        side, corner = layout.size_m + 2 * border, np.array([border, border])
        singles = (((corner, marker_modules("aruco", k)),) for k in numbers)
        papers = [_Paper((side, side), square, layout.size_m) for square in singles]
    for place, paper in enumerate(papers):
        wrong = level.wrong_print if place == len(papers) - 1 else 1.0
        half = math.hypot(*paper.size_m) / 2 * level.px_per_m
        room = np.argwhere(ndimage.distance_transform_edt(np.pad(seen, 1))[1:-1, 1:-1] > half + 5)
        signs = ((1, 1), (1, -1), (-1, 1), (-1, -1))[place]
        middle = room[(room * signs).sum(axis=1).argmin()][::-1] + 0.5
        _draw(paper, middle, level.px_per_m * wrong, surface, covered)
    return np.asarray(ndimage.distance_transform_edt(~covered) < level.gap_px)


class _Paper(NamedTuple):
    size_m: tuple[float, float]
    # Upper left corner and modules of every marker
    squares: tuple[tuple[NDArray[np.float64], NDArray[np.bool_]], ...]
    side_m: float


def _draw(
    paper: _Paper, middle: NDArray[np.float64], px_per_m: float, surface: Light, covered: Mask
) -> None:
    """Lay a paper down, turned a little, its middle at a place."""
    half = math.ceil(math.hypot(*paper.size_m) / 2 * px_per_m) + 2
    left, top = (int(part) - half for part in middle)
    fine = (np.arange(2 * half * _FINE) + 0.5) / _FINE
    x, y = np.meshgrid(fine + left - middle[0], fine + top - middle[1])
    turn = math.radians(12.0)
    across = (x * math.cos(turn) + y * math.sin(turn)) / px_per_m + paper.size_m[0] / 2
    down = (y * math.cos(turn) - x * math.sin(turn)) / px_per_m + paper.size_m[1] / 2
    on = (across >= 0) & (down >= 0) & (across < paper.size_m[0]) & (down < paper.size_m[1])
    light = np.where(on, PAPER, 0.0)
    for corner, modules in paper.squares:
        count = len(modules)
        row = np.floor((down - corner[1]) / paper.side_m * count).astype(int)
        col = np.floor((across - corner[0]) / paper.side_m * count).astype(int)
        inside = (row >= 0) & (col >= 0) & (row < count) & (col < count)
        dark = modules[np.where(inside, row, 0), np.where(inside, col, 0)] & inside
        light[dark] = INK
    share = downscale_local_mean(on.astype(float), (_FINE, _FINE))[..., None]
    # Near the edge of the ground the box is cut; the paper itself is not.
    rows = slice(max(-top, 0), 2 * half - max(top + 2 * half - surface.shape[0], 0))
    cols = slice(max(-left, 0), 2 * half - max(left + 2 * half - surface.shape[1], 0))
    box = (slice(top + rows.start, top + rows.stop), slice(left + cols.start, left + cols.stop))
    paper_light = downscale_local_mean(light, (_FINE, _FINE))[rows, cols][..., None]
    surface[box] = surface[box] * (1 - share[rows, cols]) + paper_light
    covered[box] |= share[rows, cols, 0] > 0


class Photograph(NamedTuple):
    """A rendered photograph and the truth."""

    jpeg: bytes  # The file
    truth: Labels  # Stones 1 ... n in the frame of the ground
    homography: Homography  # Ground px to px of the photograph as it is seen
    level: PhotoLevel

    def truth_in(self, to_photo: Homography, shape: tuple[int, int]) -> Labels:
        """Return the true stones in another frame, such as that of a label image."""
        rows, cols = np.indices(shape)
        points = np.column_stack([cols.ravel() + 0.5, rows.ravel() + 0.5])
        ground = matrix_transform(points, np.linalg.inv(self.homography) @ to_photo)
        where = np.floor(ground).astype(int)
        inside = ((where >= 0) & (where < self.truth.shape[::-1])).all(axis=1)
        where[~inside] = 0
        found = np.where(inside, self.truth[where[:, 1], where[:, 0]], 0)
        return found.reshape(shape).astype(np.uint16)


def photograph(level: PhotoLevel) -> Photograph:
    """Render a photograph."""
    rng = np.random.default_rng(level.seed)
    homography, seen = view_of(level)
    surface = ground_surface(level.ground, seen.shape, rng)
    markers = place_markers(level, surface, seen)
    labels = lay_stones(level, markers, seen, rng)
    light = _light_on_ground(labels, level, rng)
    lit = surface * light
    for number, box in enumerate(ndimage.find_objects(labels), start=1):
        mask = labels[box] == number
        rock = level.rocks[number % len(level.rocks)]
        # A stone is domed: its rim turns away from the light.
        depth = ndimage.distance_transform_edt(np.pad(mask, 1))[1:-1, 1:-1]
        dome = np.sqrt(np.clip(1 - (1 - np.clip(depth / max(depth.max(), 1), 0, 1)) ** 2, 0, 1))
        shading = (1 - (0.10 + 0.25 * level.shadow) * (1 - dome)).astype(np.float32)
        lit[box][mask] = (stone_face(rock, mask.shape, rng) * shading[..., None])[mask]
    lit *= _lamp(seen.shape, level, rng)[..., None]
    jpeg = exposed(lit, homography, level, rng)
    return Photograph(jpeg, labels, homography, level)


def _light_on_ground(labels: Labels, level: PhotoLevel, rng: Generator) -> Light:
    """Return what reaches the ground, (h, w, 3): cast shadows, and a dim rim below the stones."""
    azimuth = rng.uniform(0, 2 * math.pi)
    # A stone is .4 times as high as the root of its area.
    heights = 0.4 * np.sqrt(np.bincount(labels.ravel())[1:])
    lengths = (heights / math.tan(math.radians(level.sun_deg))).tolist()
    edge = int(max(lengths, default=0)) + 1  # a shadow may reach beyond the picture
    wide = np.zeros((labels.shape[0] + 2 * edge, labels.shape[1] + 2 * edge), np.float32)
    for number, (box, long) in enumerate(
        zip(ndimage.find_objects(labels), lengths, strict=True), 1
    ):
        mask = labels[box] == number
        for step in np.arange(0, long, 1.0):
            row = edge + box[0].start + round(step * math.sin(azimuth))
            col = edge + box[1].start + round(step * math.cos(azimuth))
            wide[row : row + mask.shape[0], col : col + mask.shape[1]][mask] = 1
    shadow = wide[edge:-edge, edge:-edge]
    shadow = ndimage.gaussian_filter(shadow, 2.5) * np.float32(level.shadow)
    near = ndimage.distance_transform_edt(labels == 0)
    rim = np.exp(-near / 3.0) * (0.25 if level.shadow else 0.08)
    # What light there is in a shadow comes from the sky.
    sky = np.array((0.92, 1.0, 1.12), np.float32)
    dark = shadow[..., None]
    light = (1 - dark) + dark * (sky - 1) * (1 - level.shadow)
    return np.asarray(light * (1 - rim[..., None]), np.float32)


def _lamp(shape: tuple[int, int], level: PhotoLevel, rng: Generator) -> Plane:
    """Return uneven light over the whole picture: a slope and a bright spot, 1 at most."""
    if not level.uneven:
        return np.ones(shape, np.float32)
    rows, cols = np.indices(shape, np.float32) / max(shape)
    angle = rng.uniform(0, 2 * math.pi)
    slope = rows * math.sin(angle) + cols * math.cos(angle)
    spot = -((rows - rng.uniform(0.2, 0.6)) ** 2 + (cols - rng.uniform(0.3, 0.7)) ** 2)
    light = slope + 1.5 * spot + 0.03 * clouds(shape, [(max(shape) / 2, max(shape) / 2)], rng)
    light = (light - light.min()) / (light.max() - light.min())
    return np.asarray(1 - level.uneven * (1 - light), np.float32)
