"""How hard a test photograph is, and the ten that there are."""

from dataclasses import dataclass
from typing import Literal

Markers = Literal["sheet", "single", "none"]
Ground = Literal["plywood", "tarpaulin", "cloth", "rubber", "gravel", "grass"]
Rock = Literal["granite", "sandstone", "limestone", "basalt", "schist"]


@dataclass(frozen=True, kw_only=True)
class Level:
    """What a photograph shows, and what the camera does to it.

    Parameters
    ----------
    name : str
        For tables.
    seed : int
        Of everything at random.
    count : int
        Stones; a few less when they find no place.
    angular : float
        Share of the stones that are rubble, 0 to 1; the others are rounded.
    rocks : tuple of str
        Kinds of rock, in turn.
    ground : str
        What the stones lie on.
    gap_px : int
        Empty px between stones and between stones and the edge, at least.
    touching : int
        Stones that are pushed against another one.
    cut : int
        Stones that the edge of the photograph cuts.
    shadow : float
        How much light a cast shadow takes, 0 to 1.
    sun_deg : float
        Height of the light above the ground.
    uneven : float
        How much darker the darkest place of the ground is lit than the brightest, 0 to 1.
    markers : str
        A sheet of four, four single ones, or none.
    marker_mm : float
        Side of a marker.
    wrong_print : float
        How much too large the last paper was printed; 1 is right.
    tilt_deg : float
        How far the camera looks away from the vertical.
    turn_deg : float
        How far the photograph is turned about the line of sight.
    blur_px, noise, quality
        Radius (sigma) of the defocus, standard deviation of the sensor's noise in grey values,
        quality of the JPEG.
    orientation : int
        EXIF orientation, 1 to 8, with which the file is stored.
    width_px, height_px : int
        Of the photograph as it is seen.
    px_per_m : float
        About, in the middle of the photograph.
    """

    name: str
    seed: int = 1
    count: int = 24
    angular: float = 0.5
    rocks: tuple[Rock, ...] = ("granite", "sandstone", "limestone")
    ground: Ground = "tarpaulin"
    gap_px: int = 24
    touching: int = 0
    cut: int = 0
    shadow: float = 0.0
    sun_deg: float = 50.0
    uneven: float = 0.0
    markers: Markers = "sheet"
    marker_mm: float = 75.0
    wrong_print: float = 1.0
    tilt_deg: float = 0.0
    turn_deg: float = 0.0
    blur_px: float = 0.6
    noise: float = 1.5
    quality: int = 92
    orientation: int = 1
    width_px: int = 2000
    height_px: int = 1500
    px_per_m: float = 1250.0


LEVELS: tuple[Level, ...] = (
    Level(name="1 flat, even light", seed=1),
    Level(name="2 dark ground, turned", seed=2, ground="rubber", rocks=("granite", "limestone"),
          turn_deg=8.0, orientation=6),
    Level(name="3 plywood, uneven light", seed=3, ground="plywood", uneven=0.3, markers="single",
          marker_mm=100.0, rocks=("granite", "basalt", "schist")),
    Level(name="4 soft shadows", seed=4, shadow=0.3, sun_deg=60.0, tilt_deg=10.0),
    Level(name="5 many stones, blur", seed=5, count=45, gap_px=12, blur_px=1.6, noise=3.0,
          ground="cloth", rocks=("sandstone", "basalt", "granite"), tilt_deg=12.0),
    Level(name="6 hard shadows", seed=6, ground="plywood", shadow=0.5, sun_deg=45.0, tilt_deg=15.0,
          rocks=("granite", "basalt", "schist", "limestone"), orientation=8),
    Level(name="7 touching stones", seed=7, touching=6, cut=2, shadow=0.3, uneven=0.25,
          tilt_deg=15.0, rocks=("granite", "sandstone", "basalt")),
    Level(name="8 gravel, strong perspective", seed=8, ground="gravel", uneven=0.2, shadow=0.3,
          rocks=("basalt", "sandstone", "schist"), tilt_deg=28.0, noise=4.0, markers="single",
          marker_mm=100.0),
    Level(name="9 grass, shadows, touching", seed=9, ground="grass", touching=4, shadow=0.45,
          tilt_deg=22.0, uneven=0.3, noise=4.0, blur_px=1.2),
    Level(name="10 low contrast, everything", seed=10, ground="cloth", count=32, touching=5, cut=2,
          rocks=("limestone", "granite", "sandstone"), shadow=0.5, sun_deg=40.0, uneven=0.4,
          tilt_deg=30.0, blur_px=1.6, noise=6.0, quality=75),
)  # fmt: skip
"""Test photographs, from easy to hard."""
