"""Values of a picture to ids: whole numbers from 0 to 2^32-1 (DESIGN 4.1); their census."""

from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage

from drystone.errors import InputError, LabelImageError, Notice
from drystone.io.files import several_pages
from drystone.io.images import Picture
from drystone.kernels.ids import counted, looked_up, numbered
from drystone.kernels.raster import Mask

MAX_ID = 2**32 - 1
_GREY_TOLERANCE = 48
"""Colour fringe that an anti-aliased black-and-white picture may have, of 255."""

_AT_ONCE_PX = 1_000_000

_FEW_COLOURED = 0.001
"""Share of the pixels of a black-and-white picture that may be coloured; measured: .0002."""


@dataclass(frozen=True, eq=False)
class Census:
    """The different values of an image."""

    index: NDArray[Any]  # (h, w), integers: 1 + the position of its value in `values`
    values: NDArray[np.int64]  # (n,), different values, ascending

    @cached_property
    def counts(self) -> NDArray[np.int64]:
        """Number of pixels of each value."""
        return counted(self.index, len(self.values))[1:]

    @cached_property
    def solid(self) -> NDArray[np.bool_]:
        """True where the 3 x 3 px around a pixel all have its value; (h, w), the rim is False."""
        solid = np.zeros(self.index.shape, bool)
        # By rows, for a picture may have 200 million pixels.
        step = max(1, _AT_ONCE_PX // len(solid[0]))
        for top in range(1, len(solid) - 1, step):
            bottom = min(top + step, len(solid) - 1)
            a = self.index[top - 1 : bottom + 1]
            same = (a[:, :-2] == a[:, 1:-1]) & (a[:, 1:-1] == a[:, 2:])
            down = a[:-1, 1:-1] == a[1:, 1:-1]
            solid[top:bottom, 1:-1] = same[:-2] & same[1:-1] & same[2:] & down[:-1] & down[1:]
        return solid

    def of(self, told: NDArray[Any], out: NDArray[Any] | None = None) -> NDArray[Any]:
        """Return pixel by pixel, (h, w), what is told of each value; `told` is (n,)."""
        return looked_up(np.concatenate((told[:1], told)), self.index, out)


@dataclass(frozen=True, eq=False)
class IdImage:
    """An image of ids, and how bright it was."""

    ids: NDArray[Any]  # (h, w), values in 0 ... 2^32-1; the background still has its own
    background: int  # the value that is not stone
    brightness: NDArray[Any] | None = None
    """(h, w), largest channel of a colour picture; None when `ids` are its values."""
    nearly_grey: bool = True  # False when the picture shows colours
    notices: tuple[Notice, ...] = ()  # how colours became ids, and what is ground by the format
    has_edges: bool = False  # some pixels are -1, as a watershed leaves edges and a rim
    alpha: NDArray[Any] | None = None  # (h, w), that of the file, 0 is transparent

    @cached_property
    def census(self) -> Census:
        """The different ids."""
        return Census(*numbered(self.ids))

    @property
    def said(self) -> tuple[Notice, ...]:
        """Its notices but for the rule by which colours would be ids: of a mask or a wall."""
        return tuple(notice for notice in self.notices if notice.code != "W115")

    @property
    def stones(self) -> NDArray[np.bool_]:
        """True where the id is not that of the background, (h, w)."""
        return self.census.of(self.census.values != self.background)


def components(mask: Mask) -> tuple[NDArray[np.int32], int]:
    """Label the 8-connected components of a mask, from 1 in row order."""
    found, count = ndimage.label(mask, np.ones((3, 3)))
    return np.asarray(found, np.int32), int(count)


def to_ids(picture: Picture, background: int) -> IdImage:
    """Read ids from grey values, palette indices, numbers or colours; (h, w) or (h, w, c).

    Values are bools, integers or whole floats; c = 1, 2 (grey, alpha), 3 (RGB) or 4 (RGBA), where
    alpha tells nothing that the other channels do not.  A background below 0 is allowed.

    Where R = G = B the id is the grey value, else R + 256 G + 65536 B.  When that would give two
    colours one id, R + 256 G + 65536 B is used for the greys as well.  What the format says is
    nothing is ground: alpha 0, NaN, the value of no data; and so is -1, which is no id.
    """
    values, notices = _as_picture(picture.values), picture.notices
    fill, channels = max(background, 0), 1 if values.ndim == 2 else values.shape[2]
    transparent, mask, said = _transparent(values, picture.alpha, fill)
    if mask is not None:
        return IdImage(mask, 0, notices=(*notices, *said))
    no_ids = _no_numbers(values, picture.nodata, background)
    grounds = [there for _, there in no_ids]
    grounds += [] if transparent is None else [transparent]
    ground = np.logical_or.reduce(grounds) if grounds else None
    if ground is not None:
        grey = fill <= 255 or channels < 3
        parts = [fill if grey else fill >> shift & 255 for shift in (0, 8, 16, 24)][:channels]
        kind = values.dtype
        if kind.kind != "f":  # whole numbers may need more room
            kind = np.result_type(kind, np.min_scalar_type(max(parts)))
        planes = np.where(ground[..., None], np.asarray(parts, kind), np.atleast_3d(values))
        values = planes[..., 0] if channels == 1 else planes
    values = _whole_numbers(values)
    if channels > 2:
        image = _ids_of_colours(values[:, :, :3], fill)
    else:
        image = _ids_of_numbers(values if channels == 1 else values[:, :, 0], fill)
    if values.ndim == 3 and values.shape[2] in (2, 4):
        _check_alpha(values[:, :, -1], image)
    if ground is not None:
        _check_no_stone_of_zero(image, ground, named=background < 0)
        said += tuple(_ground_notice(name, there) for name, there in no_ids if name)
    edges = picture.values.dtype.kind in "if" and bool((picture.values == -1).any())
    said = (*notices, *said, *image.notices)
    return replace(image, notices=said, has_edges=edges, alpha=picture.alpha)


def _transparent(
    values: NDArray[Any], alpha: NDArray[Any] | None, background: int
) -> tuple[NDArray[np.bool_] | None, NDArray[Any] | None, tuple[Notice, ...]]:
    """Return where a picture is transparent, or its alpha if that is the mask; and what to say."""
    if alpha is None or alpha.min() == alpha.max() != 0:
        return None, None, ()
    clear = alpha == 0
    if clear.all():
        return None, None, (Notice("W174", "alpha is 0 everywhere, so it was ignored."),)
    visible = values[~clear]
    if (visible == visible[0]).all():
        soft = np.any((alpha != 0) & (alpha != alpha.max()))
        if soft or (visible[0] == background).all() or (values == visible[0]).all():
            what = "all that is not transparent has one colour: alpha was read in place of it."
            cure = "Draw stones in ids of their own if they should keep them."
            mask = alpha.view(np.uint8) if alpha.dtype == bool else alpha
            return None, mask, (Notice("W135", what, cure),)
    changed = values != background
    changed = clear & (changed.any(axis=2) if changed.ndim == 3 else changed)
    if not changed.any():
        return clear, None, ()
    cure = "Make them opaque if stones should be there."
    return clear, None, (_ground_notice("transparent, whatever their colour", changed, cure),)


def _no_numbers(
    values: NDArray[Any], nodata: float | None, background: int
) -> list[tuple[str, NDArray[np.bool_]]]:
    """Return where numbers stand for nothing, and their names; the named background has none."""
    kind = values.dtype.kind
    if values.ndim > 2 or kind not in "iuf":
        return []
    found = []
    if kind == "f":
        found.append(("NaN", np.isnan(values)))
    if nodata is not None and nodata != background:
        found.append((f"{nodata:g}, which the file says is no data", values == nodata))
    if kind != "u":
        edges = "-1 (edges, as a watershed leaves them)"
        found.append((edges if background != -1 else "", values == -1))
        if background < -1:
            found.append(("", values == background))
    return [(name, there) for name, there in found if there.any()]


def _ground_notice(name: str, there: NDArray[np.bool_], cure: str = "") -> Notice:
    what = f"{int(there.sum())} px are {name}: read as background."
    return Notice("W135", what, cure or "Give them an id from 1 if stones should be there.")


def _check_no_stone_of_zero(image: IdImage, ground: NDArray[np.bool_], *, named: bool) -> None:
    """Refuse stones of the value 0 on ground that is something else (E108)."""
    zero = (image.ids == 0) & ~ground
    if image.background != 0 or not zero.any():
        return
    corners = ground[[0, 0, -1, -1], [0, -1, 0, -1]].sum() >= 3
    inner_px = np.count_nonzero(zero[_RIM:-_RIM, _RIM:-_RIM])
    # Whether a piece as large as a stone has only ground around it.
    found, count = components(zero)
    alone = np.bincount(found.ravel(), minlength=count + 1) >= _LEAST_PX
    alone[ndimage.maximum_filter(found, 3)[~ground & ~zero]] = False
    if named or (corners and inner_px == np.count_nonzero(zero) and alone[1:].any()):
        raise LabelImageError(
            "E108",
            f"{int(zero.sum())} px are 0 on a background that is another value or transparent, "
            "and no stone can be 0.",
            cure="Give them a free id (add 1 to all ids), or make them background too.",
        )


_RIM = 2
"""Pixels at the border of a picture that programs leave as they are."""

_LEAST_PX = 10


def _ids_of_numbers(ids: NDArray[Any], background: int) -> IdImage:
    if int(ids.min()) < 0 or int(ids.max()) > MAX_ID:
        bad = (ids < 0) | (ids > MAX_ID)
        found = " ... ".join(map(str, dict.fromkeys((ids[bad].min(), ids[bad].max()))))
        raise _not_ids(f"{int(bad.sum())} px are {found}, outside 0 ... 2^32-1", bad)
    return IdImage(ids, background)


def _as_picture(values: NDArray[Any]) -> NDArray[Any]:
    """Drop planes of one; refuse stacks."""
    if values.size == 0:
        what = f"there are no pixels: the shape is {values.shape}."
        raise LabelImageError("E104", what, cure="Give an image of at least one pixel.")
    while values.ndim > 2 and values.shape[0] == 1 and (values.ndim > 3 or values.shape[2] > 4):
        values = values[0]
    if values.ndim == 3 and values.shape[2] == 1:
        values = values[:, :, 0]
    if values.ndim == 2 or (values.ndim == 3 and values.shape[2] in (2, 3, 4)):
        return values
    raise several_pages(f"{values.ndim} dimensions of shape {values.shape}")


def _whole_numbers(values: NDArray[Any]) -> NDArray[Any]:
    kind = values.dtype.kind
    if kind == "b":
        return values.view(np.uint8)
    if kind in "iu":
        return values
    if kind != "f":
        cure = "Give whole numbers (or bools for a mask)."
        raise LabelImageError("E108", f"values of type {values.dtype} are not ids.", cure=cure)
    if values.dtype.itemsize < 4:
        # The largest id is beyond what 16 bits can be compared with.
        values = values.astype(np.float32)
    with np.errstate(invalid="ignore"):
        for name, bad in (
            ("not finite", ~np.isfinite(values)),
            ("not whole numbers", values != np.floor(values)),
            ("not from 0 to 2^32-1", np.abs(values) > MAX_ID),
        ):
            if bad.any():
                raise _not_ids(f"{int(bad.sum())} px are {name}", bad)
    return values.astype(np.int64)


def _check_alpha(alpha: NDArray[Any], image: IdImage) -> None:
    """Refuse a last channel that is neither of one value nor the same as where stones are (E109).

    Anything else may be the mask of a further stone.
    """
    stone = image.ids != image.background
    highest = alpha.max()
    if alpha.min() == highest or np.array_equal(alpha, np.where(stone, highest, 0)):
        return
    raise InputError(
        "E109",
        "the last channel is not transparency: it does not go with where stones are.",
        cure="Give ids in one channel, or colours in three; masks of one stone each in a folder "
        "of pictures, or as the arrays of an NPZ.",
    )


def _not_ids(what: str, bad: NDArray[np.bool_]) -> LabelImageError:
    row, col = np.argwhere(bad)[0][:2]
    return LabelImageError(
        "E108",
        f"{what} (first at column {col}, row {row}), so they cannot be ids.",
        cure="Ids are whole numbers from 1 to 4294967295. Background is 0, -1, NaN, or the "
        "number of --background (background in Python).",
    )


def _ids_of_colours(colours: NDArray[Any], background: int) -> IdImage:
    red, green, blue = (colours[:, :, i] for i in range(3))
    if np.array_equal(red, green) and np.array_equal(green, blue):
        return _ids_of_numbers(red, background)
    if colours.dtype != np.uint8 and (int(colours.min()) < 0 or int(colours.max()) > 255):
        cure = "Export ids as one channel of 16 or 32 bits, or colours of 8 bits."
        raise LabelImageError("E108", "colours have values outside 0 ... 255.", cure=cure)
    codes = blue.astype(np.uint32)
    for channel in (green, red):
        codes <<= 8
        codes |= channel.astype(np.uint8, copy=False)
    census = Census(*numbered(codes))
    # What follows is asked of the colours, and not of every pixel.
    present = census.values
    parts = present[:, None] >> np.array([0, 8, 16]) & 255
    is_grey = (parts[:, :1] == parts).all(axis=1)
    mixed = np.where(is_grey, parts[:, 0], present)
    rule, values = "R + 256 G + 65536 B", present
    if len(np.unique(mixed)) == len(mixed):
        rule += " (greys: their value)" if is_grey[present > 0].any() else ""
        values = mixed
        census.of(mixed.astype(np.uint32), out=codes)
    stones = len(present) - int((values == background).any())
    notice = Notice("W115", f"{len(present)} colours read as ids {rule}: {stones} stones.")
    brightest = parts.max(axis=1)
    # A mask keeps a few coloured pixels where a coloured picture was cut or drawn over.
    coloured = census.counts[brightest - parts.min(axis=1) > _GREY_TOLERANCE].sum()
    brightness = census.of(brightest.astype(np.uint8))
    nearly_grey = bool(coloured <= _FEW_COLOURED * codes.size)
    return IdImage(codes, background, brightness, nearly_grey, (notice,))


def check_no_zero(image: IdImage) -> None:
    """Refuse the value 0 where another one is the background (E108)."""
    if image.background != 0 and (image.census.values == 0).any():
        ground = image.background
        what = f"the value 0 is there beside the background {ground}, and no stone can be 0."
        cure = f"Set those pixels to {ground} if they are background, else to a free id."
        raise LabelImageError("E108", what, cure=cure)
