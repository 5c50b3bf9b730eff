"""Surfaces of stones and grounds as linear light, 0 to 1."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.random import Generator
from numpy.typing import NDArray
from PIL import Image

from drystone_lab.photographs.level import Ground, Rock

Plane = NDArray[np.float32]
"""(h, w)."""
Light = NDArray[np.float32]
"""(h, w, 3), linear, 0 to 1 for what a camera can record."""


@dataclass(frozen=True)
class _Face:
    colours: tuple[str, ...]
    clouds: float
    specks: float
    veins: float


_ROCKS: dict[Rock, _Face] = {
    "granite": _Face(("#a3a09c", "#b3a79d", "#8f9092"), 0.10, 0.55, 0.0),
    "sandstone": _Face(("#b98f63", "#a5714f", "#c7a77c"), 0.16, 0.08, 0.15),
    "limestone": _Face(("#d6cdb9", "#c9c1ad", "#ded8cc"), 0.10, 0.05, 0.25),
    "basalt": _Face(("#4a4b4e", "#565350", "#3d4044"), 0.15, 0.15, 0.0),
    "schist": _Face(("#7b8076", "#6f7480", "#8a8272"), 0.16, 0.12, 0.35),
}


def linear(colour: str) -> NDArray[np.float32]:
    """Return the linear light of ``"#rrggbb"``.

    Examples
    --------
    >>> [round(float(part), 3) for part in linear("#ff8000")]
    [1.0, 0.216, 0.0]
    """
    value = np.array([int(colour[k : k + 2], 16) for k in (1, 3, 5)]) / 255
    low = value / 12.92
    return np.where(value <= 0.04045, low, ((value + 0.055) / 1.055) ** 2.4).astype(np.float32)


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
    face = _ROCKS[rock]
    base = linear(face.colours[int(rng.integers(len(face.colours)))])
    base = base * np.float32(rng.uniform(0.85, 1.15))
    size = max(shape)
    light = face.clouds * clouds(shape, [(size / k, size / k) for k in (2, 4, 9, 20)], rng, 0.7)
    specks = clouds(shape, [(5, 5), (2.5, 2.5)], rng, 0.8)
    light += face.specks * (0.5 * (specks > 1.1) - 0.8 * (specks < -1.2))
    ridge = 1 - np.abs(clouds(shape, [(size / 2, size / 5), (size / 6, size / 9)], rng, 0.4)) * 6
    light += face.veins * np.clip(ridge, 0, 1)
    tint = 0.03 * clouds(shape, [(size / 2, size / 2), (size / 6, size / 6)], rng)
    colour = base * (1 + light[..., None])
    colour[..., 0] *= 1 + tint
    colour[..., 2] *= 1 - tint
    return np.clip(colour, 0.01, 1.0).astype(np.float32)


def ground_surface(ground: Ground, shape: tuple[int, int], rng: Generator) -> Light:
    """Return a ground, evenly lit."""
    makers = {
        "plywood": _plywood, "tarpaulin": _tarpaulin, "cloth": _cloth,
        "rubber": _rubber, "gravel": _gravel, "grass": _grass,
    }  # fmt: skip
    return np.asarray(np.clip(makers[ground](shape, rng), 0.005, 1.0), np.float32)


def _plywood(shape: tuple[int, int], rng: Generator) -> Light:
    grain = clouds(shape, [(14, 900), (5, 300), (2, 90)], rng, 0.8)
    boards = clouds(shape, [(400, 1500)], rng)
    return np.asarray(linear("#d8b98a") * (1 + 0.06 * grain + 0.04 * boards)[..., None])


def _tarpaulin(shape: tuple[int, int], rng: Generator) -> Light:
    rows, cols = np.indices(shape, np.float32)
    weave = np.sin(rows * 1.1) * np.sin(cols * 1.1)
    folds = clouds(shape, [(500, 300), (160, 200)], rng, 0.4)
    return np.asarray(linear("#2f6fb0") * (1 + 0.05 * weave + 0.08 * folds)[..., None])


def _cloth(shape: tuple[int, int], rng: Generator) -> Light:
    folds = clouds(shape, [(420, 260), (120, 150)], rng, 0.4)
    threads = clouds(shape, [(2, 6), (6, 2)], rng, 0.9)
    return linear("#ecebe6") * (1 + 0.03 * folds + 0.02 * threads)[..., None]


def _rubber(shape: tuple[int, int], rng: Generator) -> Light:
    crumbs = clouds(shape, [(5, 5), (2.5, 2.5)], rng, 0.8)
    return linear("#26262a") * (1 + 0.25 * crumbs)[..., None]


def _gravel(shape: tuple[int, int], rng: Generator) -> Light:
    grains = clouds(shape, [(7, 7), (4, 4), (2.5, 2.5)], rng, 0.8)
    tint = 0.04 * clouds(shape, [(9, 9)], rng)
    light = linear("#c9c3b4") * (1 + 0.16 * grains)[..., None]
    light[..., 0] *= 1 + tint
    return np.asarray(light)


def _grass(shape: tuple[int, int], rng: Generator) -> Light:
    blades = clouds(shape, [(16, 5), (9, 3), (4, 3)], rng, 0.8)
    patches = clouds(shape, [(220, 220), (70, 70)], rng, 0.6)
    light = linear("#5b8a35") * np.exp(0.35 * blades + 0.12 * patches)[..., None]
    light[..., 0] *= 1 + 0.12 * patches
    return np.asarray(light)
