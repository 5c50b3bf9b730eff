"""What the user may say about a picture of stones."""

from dataclasses import dataclass, fields
from typing import Any, Literal, get_args

from drystone.errors import UsageError
from drystone.model.settings import typed

Pieces = Literal["auto", "keep-largest", "split", "error"]
Holes = Literal["fill", "keep"]
Unit = Literal["", "px", "mm", "cm", "m", "in", "ft"]
Up = Literal["", "y", "z", "y-back", "z-back"]

MOST_PX_PER_M = 1e9
"""A larger scale is none: a px would be less than a nanometre."""


@typed
@dataclass(frozen=True, kw_only=True)
class ReadSettings:
    """How to read stones from a picture (DESIGN 4.1).

    Parameters
    ----------
    background : int
        The value that is not stone; so are NaN and -1, whatever it is.
    pieces : {"auto", "keep-largest", "split", "error"}
        What to do with a stone of several pieces: "auto" keeps the largest when the others are
        less than 2 % of the stone and refuses the picture otherwise, "keep-largest" always keeps
        the largest, "split" makes every piece a stone (new ids after the largest id), "error"
        refuses any second piece.
    holes : {"fill", "keep"}
        Fill holes before areas and centroids are taken, or leave them open; outlines are the outer
        ones either way.
    min_area_px : int or None
        Smaller stones are left out and listed; None is max(10 px, 0.1 % of the median area), of the
        components of a mask also 1 % of it, up to 50 px.
    mask : bool or None
        True reads the picture as a binary mask, False as ids; None decides by its values, and takes
        a net of edges around stones for background.
    skip : tuple of int
        Ids of stones to leave out.
    keep : tuple of int
        Ids of outlines or masks that are stones, though they look like a frame, the ground, a
        repeat or a part of another.
    label : tuple of str
        The classes of annotations that are stones; empty leaves out those whose names say
        something else (a marker, the ground …).
    max_image_mpx : float
        Largest picture that is decoded, in millions of pixels; above 0, up to 1e6.
    px_per_m : float or None
        Px in a metre, up to 1e9, at which a drawing or mesh is drawn; None is such that the
        longer side of the median stone has about 160 px.  Pictures, and annotations in px of an
        image, keep their own px.
    unit : {"px", "mm", "cm", "m", "in", "ft"}
        Of a drawing or mesh, also of a DXF or SVG that says another; empty is what the file says.
    up : {"y", "z", "y-back", "z-back"}
        Which axis of a mesh or a DXF is up; "-back" sees it from the other side.  Empty is Z,
        unless the file cannot be told from its mirror image then.
    image : str
        Which image of annotations of several: its file name or id, its id in masks of SAM; or the
        file of the picture of which coordinates are shares.

    Examples
    --------
    >>> ReadSettings(background=255, pieces="split").holes
    'fill'
    """

    background: int = 0
    pieces: Pieces = "auto"
    holes: Holes = "fill"
    min_area_px: int | None = None
    mask: bool | None = None
    skip: tuple[int, ...] = ()
    keep: tuple[int, ...] = ()
    label: tuple[str, ...] = ()
    max_image_mpx: float = 200.0
    px_per_m: float | None = None
    unit: Unit = ""
    up: Up = ""
    image: str = ""

    @property
    def max_px(self) -> int:
        """Px of the largest picture that is decoded."""
        return int(self.max_image_mpx * 1e6)

    def changed(self) -> tuple[tuple[str, Any], ...]:
        """Return the settings that are not the defaults, as names and JSON values."""
        values = [(field.name, getattr(self, field.name), field.default) for field in fields(self)]
        return tuple(
            (name, list(value) if isinstance(value, tuple) else value)
            for name, value, default in values
            if value != default
        )

    def __post_init__(self) -> None:
        wrong = {
            name: f"one of: {', '.join(filter(None, get_args(kind)))}"
            for name, kind in (("pieces", Pieces), ("holes", Holes), ("unit", Unit), ("up", Up))
            if getattr(self, name) not in get_args(kind)
        }
        if self.min_area_px is not None and self.min_area_px < 1:
            wrong["min_area_px"] = "1 or more"
        if not 0.0 < self.max_image_mpx <= 1e6:
            wrong["max_image_mpx"] = "a number above 0, up to 1e6"
        if self.px_per_m is not None and not 0.0 < self.px_per_m <= MOST_PX_PER_M:
            wrong["px_per_m"] = "a number above 0, up to 1e9"
        for name, instead in wrong.items():
            what = f"{name} is {getattr(self, name)!r}, which means nothing."
            raise UsageError("E119", what, where="ReadSettings", cure=f"Use {instead}.")
