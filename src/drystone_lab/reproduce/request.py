"""What is asked for when an item is made, and with what it was made."""

import os
import platform
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from datetime import UTC, datetime
from hashlib import sha256
from importlib.metadata import version
from pathlib import Path
from typing import Any

from drystone.errors import InputError
from drystone.io.published_sets import SETS
from drystone.kernels.backend import describe

PACKAGES = (
    "numpy", "scipy", "scikit-image", "shapely", "highspy", "clarabel", "pillow", "matplotlib",
)  # fmt: skip
"""That results depend on, beside drystone itself."""

Clock = Callable[[], datetime]


def utc_now() -> datetime:
    """Return the time of day."""
    return datetime.now(UTC)


@dataclass(frozen=True)
class Request:
    """What the contents of an item depend on, beside its name.

    Parameters
    ----------
    version : str
        Of drystone.
    quick : bool
        The smaller version.
    seed : int
        Of all random choices, or the first of several.
    image_sha256 : str or None
        Of a user's own stones.
    published : tuple of str
        Published files that are there; some items leave out rows whose stones are not.
    """

    version: str
    quick: bool
    seed: int
    image_sha256: str | None
    published: tuple[str, ...]

    def is_met_by(self, record: Mapping[str, Any]) -> bool:
        """Return whether an item that was made before is what is asked for now.

        Examples
        --------
        >>> full = Request("1", False, 1, None, ("almeida/R.png",))
        >>> less = Request("1", False, 1, None, ())
        >>> less.is_met_by(full.as_dict()), full.is_met_by(less.as_dict())
        (True, False)
        """
        same = all(
            record[name] == getattr(self, name)
            for name in ("version", "quick", "seed", "image_sha256")
        )
        return same and {*self.published} <= {*record["published"]}

    def as_dict(self) -> dict[str, Any]:
        """Return what JSON writes."""
        return {
            "version": self.version, "quick": self.quick, "seed": self.seed,
            "image_sha256": self.image_sha256, "published": list(self.published),
        }  # fmt: skip


def request_of(*, quick: bool, seed: int, image: Path | None, data: Path | None) -> Request:
    """Return what is asked for.

    Raises
    ------
    InputError
        E100: there is no such image.
    """
    files = [file.name for each in SETS.values() for file in each.files]
    there = tuple(name for name in files if data is not None and (data / name).is_file())
    digest = None if image is None else _sha256(image)
    return Request(version("drystone"), quick, seed, digest, there)


def made_with(now: Clock) -> dict[str, Any]:
    """Return when, and on what kind of machine with what packages, something is made."""
    return {
        "date": now().strftime("%Y-%m-%d %H:%M UTC"),
        "machine": f"{platform.system()} {platform.machine()}, {os.cpu_count()} cores",
        "python": platform.python_version(),
        "kernels": describe(),
        "packages": {name: version(name) for name in PACKAGES},
    }


def _sha256(image: Path) -> str:
    """Return the hash of a file, or of the names and contents of all files of a folder."""
    if not image.exists():
        raise InputError(
            "E100", "the picture does not exist.", where=str(image), cure="Check the path."
        )
    if image.is_file():
        return sha256(image.read_bytes()).hexdigest()
    whole = sha256()
    for path in sorted(path for path in image.iterdir() if path.is_file()):
        whole.update(f"{path.name}\0".encode() + sha256(path.read_bytes()).digest())
    return whole.hexdigest()
