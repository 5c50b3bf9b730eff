"""Values of a picture to ids: whole numbers from 0 to 2^32-1 (DESIGN 4.1); their census."""

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from drystone.errors import InputError, LabelImageError, Notice
from drystone.io.file_errors import several_pages
from drystone.kernels.ids import counted, looked_up, numbered

MAX_ID = 2**32 - 1
_GREY_TOLERANCE = 48
"""Colour fringe that an anti-aliased black-and-white picture may have, of 255."""


@dataclass(frozen=True, eq=False)
class Census:
    """The different values of an image."""

    index: NDArray[np.int32]  # (h, w), 1 + the position of its value in `values`
    values: NDArray[np.int64]  # (n,), different values, ascending

    @cached_property
    def counts(self) -> NDArray[np.int64]:
        """Number of pixels of each value."""
        return counted(self.index, len(self.values))[1:]

    @property
    def commonest(self) -> int:
        """Position of the most frequent value."""
        return int(np.argmax(self.counts))

    @cached_property
    def solid(self) -> NDArray[np.bool_]:
        """True where the 3 x 3 px around a pixel all have its value; (h, w), the rim is False."""
        solid = np.zeros(self.index.shape, bool)
        a = self.index
        if min(a.shape) >= 3:
            same = (a[:, :-2] == a[:, 1:-1]) & (a[:, 1:-1] == a[:, 2:])
            down = a[:-1, 1:-1] == a[1:, 1:-1]
            solid[1:-1, 1:-1] = same[:-2] & same[1:-1] & same[2:] & down[:-1] & down[1:]
        return solid

    def pixels(self, chosen: NDArray[np.bool_]) -> NDArray[np.bool_]:
        """Return the (h, w) mask of the pixels whose value is chosen; `chosen` is (n,) bool."""
        return self.of(chosen)

    def of(self, told: NDArray[Any], out: NDArray[Any] | None = None) -> NDArray[Any]:
        """Return pixel by pixel, (h, w), what is told of each value; `told` is (n,)."""
        return looked_up(np.concatenate((told[:1], told)), self.index, out)


def take_census(ids: NDArray[Any]) -> Census:
    """Count the values of an image of integers, none of them negative."""
    return Census(*numbered(ids))


@dataclass(frozen=True, eq=False)
class IdImage:
    """An image of ids, and how bright it was."""

    ids: NDArray[Any]  # (h, w), values in 0 ... 2^32-1; the background still has its own
    background: int  # the value that is not stone
    brightness: NDArray[Any] | None = None
    """(h, w), largest channel of a colour picture; None when `ids` are its values."""
    nearly_grey: bool = True  # False when the picture shows colours
    notices: tuple[Notice, ...] = ()  # how colours became ids


def to_ids(values: NDArray[Any], background: int) -> IdImage:
    """Read ids from grey values, palette indices, numbers or colours; (h, w) or (h, w, c).

    Values are bools, integers or whole floats; c = 1, 2 (grey, alpha), 3 (RGB) or 4 (RGBA), where
    alpha tells nothing that the other channels do not.  A background of -1 is allowed for arrays.

    Where R = G = B the id is the grey value, else R + 256 G + 65536 B; alpha is ignored.  When
    that would give two colours one id, R + 256 G + 65536 B is used for the greys as well.
    """
    values = _whole_numbers(_as_picture(values))
    if values.ndim == 2:
        return _ids_of_numbers(values, background)
    if values.shape[2] == 2:
        image = _ids_of_numbers(values[:, :, 0], background)
    else:
        image = _ids_of_colours(values[:, :, :3], background)
    if values.shape[2] in (2, 4):
        _check_alpha(values[:, :, -1], image)
    return image


def _ids_of_numbers(values: NDArray[Any], background: int) -> IdImage:
    ids, background = _without_negative_background(values, background)
    low, high = int(ids.min()), int(ids.max())
    if low < 0 or high > MAX_ID:
        bad = (ids < 0) | (ids > MAX_ID)
        raise _not_ids(f"{int(bad.sum())} px are {low} ... {high} outside 0 ... 2^32-1", bad)
    return IdImage(ids, background)


def _as_picture(values: NDArray[Any]) -> NDArray[Any]:
    """Drop planes of one; refuse stacks."""
    found = np.asarray(values)
    if found.size == 0:
        what = f"there are no pixels: the shape is {found.shape}."
        raise LabelImageError("E104", what, cure="Give an image of at least one pixel.")
    while found.ndim > 3 and found.shape[0] == 1:
        found = found[0]
    if found.ndim == 3 and found.shape[0] == 1 and found.shape[2] > 4:
        found = found[0]
    if found.ndim == 3 and found.shape[2] == 1:
        found = found[:, :, 0]
    if found.ndim == 2 or (found.ndim == 3 and found.shape[2] in (2, 3, 4)):
        return found
    raise several_pages(f"{found.ndim} dimensions of shape {found.shape}")


def _whole_numbers(values: NDArray[Any]) -> NDArray[Any]:
    kind = values.dtype.kind
    if kind == "b":
        return values.view(np.uint8)
    if kind in "iu":
        return values
    if kind != "f":
        cure = "Give whole numbers (or bools for a mask)."
        raise LabelImageError("E108", f"values of type {values.dtype} are no ids.", cure=cure)
    if values.dtype.itemsize < 4:
        # The largest id is beyond what 16 bits can be compared with.
        values = values.astype(np.float32)
    with np.errstate(invalid="ignore"):  # some NaNs are warned of, and all are refused
        found = (
            ("not finite (NaN or infinite)", ~np.isfinite(values)),
            ("no whole numbers", values != np.floor(values)),
            ("not from 0 to 2^32-1", np.abs(values) > MAX_ID),
        )
    for name, bad in found:
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
        "the last channel is no transparency: it does not go with where stones are.",
        cure="Give ids in one channel, or colours in three; masks of one stone each in a folder "
        "of pictures, or as the arrays of an NPZ.",
    )


def _not_ids(what: str, bad: NDArray[np.bool_]) -> LabelImageError:
    row, col = np.argwhere(bad)[0][:2]
    return LabelImageError(
        "E108",
        f"{what} (first at column {col}, row {row}), so they cannot be ids.",
        cure="Ids are whole numbers from 1 to 4294967295, 0 is the background; name any other "
        "with --background (background in Python).",
    )


def _without_negative_background(ids: NDArray[Any], background: int) -> tuple[NDArray[Any], int]:
    """Let 0 stand for a negative background; where 0 is taken, it stays and is refused later."""
    if background >= 0:
        return ids, background
    if (ids == background).any() and not (ids == 0).any():
        return np.where(ids == background, 0, ids), 0
    return ids, 0


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
    census = take_census(codes)
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
    spread = int((brightest - parts.min(axis=1)).max())
    brightness = census.of(brightest.astype(np.uint8))
    return IdImage(codes, background, brightness, spread <= _GREY_TOLERANCE, (notice,))


def check_no_zero(values: NDArray[Any], background: int) -> None:
    """Refuse the value 0 where another one is the background (E108)."""
    if background != 0 and (values == 0).any():
        what = f"the value 0 is there beside the background {background}, and no stone can be 0."
        cure = f"Set those pixels to {background} if they are background, else to a free id."
        raise LabelImageError("E108", what, cure=cure)
