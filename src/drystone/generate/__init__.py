"""Stone sets that nobody had to find: for demos, tests and the paper's §5.3.

Every generator takes its settings and a random generator, and returns a
:class:`~drystone.model.stone.StoneSet`; :func:`lay_out` draws any set as one image of labels.

Examples
--------
>>> import numpy as np
>>> from drystone import generate
>>> bricks = generate.BrickSettings(count=6, height_px=10, aspect=2)
>>> stones = generate.brick_stones(bricks, np.random.default_rng(1))
>>> generate.lay_out(stones).shape
(46, 52)
"""

from collections.abc import Callable, Mapping
from types import MappingProxyType
from typing import Any

from numpy.random import Generator

from drystone.generate.brick import BrickSettings, brick_stones
from drystone.generate.fourier import FourierSettings, fourier_stones
from drystone.generate.layout import lay_out
from drystone.generate.polygon import PolygonSettings, polygon_stones
from drystone.generate.rubble import RubbleSettings, rubble_stones
from drystone.model.stone import StoneSet

GENERATORS: Mapping[str, tuple[type[Any], Callable[[Any, Generator], StoneSet]]] = MappingProxyType(
    {
        "fourier": (FourierSettings, fourier_stones),
        "polygon": (PolygonSettings, polygon_stones),
        "brick": (BrickSettings, brick_stones),
        "rubble": (RubbleSettings, rubble_stones),
    }
)
"""By name: settings, and what makes stones from them."""

__all__ = [
    "BrickSettings",
    "FourierSettings",
    "PolygonSettings",
    "RubbleSettings",
    "brick_stones",
    "fourier_stones",
    "lay_out",
    "polygon_stones",
    "rubble_stones",
]
