"""The published stone sets: what they are, where they are looked for, and how they get there."""

import json
import os
import shlex
from contextlib import suppress
from dataclasses import dataclass
from functools import lru_cache
from hashlib import sha256
from pathlib import Path

from drystone.errors import InputError
from drystone.whole_files import write_whole

REPOSITORY = "eesd-epfl/StablePacking-2D"
"""Where the authors of the paper released the stones, under the MIT licence."""

RAW = f"https://raw.githubusercontent.com/{REPOSITORY}"
"""Address of its files, to be followed by a commit and a path."""

NOTICE = "LICENSE-StablePacking-2D.txt"
"""Name of the licence that is written beside the files, as it asks for."""

_PUBLISHED = json.loads(Path(__file__).with_name("published.json").read_text())

LICENCE = "\n".join(_PUBLISHED["licence"])
"""The MIT licence of the files."""

PAPER = (
    "Q. Wang, K. R. M. dos Santos and K. Beyer (2024), An image-based stacking method for 2D "
    "dry-stone masonry walls"
)
"""The paper that the files were released with."""


@dataclass(frozen=True)
class PublishedFile:
    """One file of a published set."""

    name: str  # where it belongs in a folder of published data, for example "almeida/R.png"
    address: str  # where it follows `RAW`: commit of the repository, and path there
    sha256: str


@dataclass(frozen=True)
class PublishedSet:
    """Files that belong together."""

    text: str  # what they show
    source: str  # whose stones they are: to be cited beside :data:`PAPER`
    files: tuple[PublishedFile, ...]  # label images, one id a stone


SETS = {
    name: PublishedSet(one["text"], one["source"], tuple(PublishedFile(*f) for f in one["files"]))
    for name, one in _PUBLISHED["sets"].items()
}
"""What there is, by name."""

VARIABLE = "DRYSTONE_DATA"
"""Environment variable that names a folder of published data."""


@dataclass(frozen=True)
class Fetched:
    """A file of a published set that is there and has the right contents."""

    file: PublishedFile
    path: Path
    downloaded: bool  # it was not there before


def published_folder(given: str | None) -> Path | None:
    """Return the folder that published data is read from: what is named, there or not.

    Else it is the cache of ``drystone fetch``, when that has something in it.
    """
    if named := given or os.environ.get(VARIABLE):
        return Path(named)
    cache = _cache()
    return cache if cache is not None and cache.is_dir() and any(cache.iterdir()) else None


def destination(given: str | None) -> Path:
    """Return the folder that files are fetched into: the option, ``DRYSTONE_DATA`` or the cache."""
    if named := given or os.environ.get(VARIABLE):
        return Path(named)
    if (cache := _cache()) is None:
        raise _extra_missing("fetch", f"Or name a folder: `-o DIR`, or {VARIABLE}.")
    return cache


def published_file(folder: Path, name: str) -> Path:
    """Return the path of a published file or folder, which has the contents that were released.

    Other contents are refused (E160): figures of other stones would pass for those of the
    published ones.  A file that is missing or in no set is not checked: whoever opens it says so.
    """
    for known, published in SETS.items():
        for file in published.files:
            path = folder / file.name
            if name != file.name and not file.name.startswith(f"{name}/"):
                continue
            with suppress(OSError):
                found = path.stat()
                if _hash_of(path, found.st_size, found.st_mtime_ns) != file.sha256:
                    to = "" if folder == _cache() else f" -o {shlex.quote(str(folder))}"
                    cure = f"Move it away and fetch it again (`drystone fetch {known}{to}`), or"
                    raise _other_contents(path, cure, f"{RAW}/{file.address}")
    return folder / name


def fetch_set(wanted: PublishedSet, folder: Path, *, address: str = RAW) -> list[Fetched]:
    """Bring the files of a set into a folder, with their licence; what is there is only checked.

    A file of other contents is never replaced, and a download of that kind is never kept (E160).
    """
    fetched = []
    for file in wanted.files:
        path, url = folder / file.name, f"{address}/{file.address}"
        missing = not path.exists()
        if missing:
            _download(file, path, url)
            if not (folder / NOTICE).exists():  # at once, as it asks for: the next file may fail
                write_whole(folder / NOTICE, LICENCE.encode())
        elif sha256(path.read_bytes()).hexdigest() != file.sha256:
            raise _other_contents(path, "Move it away and fetch it again, or", url)
        fetched.append(Fetched(file, path, missing))
    return fetched


@lru_cache
def _hash_of(path: Path, _size: int, _mtime_ns: int) -> str:
    """Return the hash of a file, read once as long as it stays the same."""
    return sha256(path.read_bytes()).hexdigest()


def _download(file: PublishedFile, path: Path, url: str) -> None:
    """Write a file that is not there yet."""
    try:
        import pooch  # noqa: PLC0415 - an extra
    except ImportError:
        raise _extra_missing(str(path), _by_hand(url, path)) from None
    path.parent.mkdir(parents=True, exist_ok=True)
    try:
        pooch.retrieve(url, known_hash=f"sha256:{file.sha256}", fname=path.name, path=path.parent)
    except ValueError as error:  # what arrived hashes to something else; pooch threw it away
        cure = "Something on the way may have changed it: try another network, or"
        raise _other_contents(path, cure, url) from error
    except OSError as error:
        # Errors of the network are OSErrors without a number; what the disk refuses is E141.
        if error.errno is not None or isinstance(error, PermissionError):
            raise
        if (answer := getattr(error, "response", None)) is not None:
            answer.close()  # pooch leaves the connection of a refusal (404) open
        reason: BaseException = error
        while reason.__context__ is not None:  # the innermost error knows
            reason = reason.__context__
        what = f"cannot be downloaded ({type(reason).__name__}: {reason})."
        raise InputError("E161", what, where=str(path), cure=_by_hand(url, path)) from error


def _cache() -> Path | None:
    """Return the folder of the cache; None when pooch is not installed."""
    try:
        import pooch  # noqa: PLC0415 - an extra
    except ImportError:
        return None
    return Path(pooch.os_cache("drystone"))


def _by_hand(url: str, path: Path) -> str:
    return (
        f"By hand: save {url} as {path}. Or name a folder that has {path.parent.name}/{path.name} "
        f"with {VARIABLE}."
    )


def _other_contents(path: Path, cure: str, url: str) -> InputError:
    what = "has other contents than the published file (SHA-256)."
    return InputError("E160", what, where=str(path), cure=f"{cure} save {url} there.")


def _extra_missing(where: str, cure: str) -> InputError:
    what = "pooch, which downloads, is not installed."
    return InputError("E162", what, where=where, cure=f"`pip install 'drystone[fetch]'`. {cure}")
