"""Where published stone sets are looked for, and how they get there."""

import os
import shlex
from dataclasses import dataclass
from functools import lru_cache
from hashlib import sha256
from pathlib import Path

from drystone.errors import InputError
from drystone.io.published_sets import LICENCE, NOTICE, RAW, SETS, PublishedFile, PublishedSet
from drystone.whole_files import write_whole

VARIABLE = "DRYSTONE_DATA"
"""Environment variable that names a folder of published data."""


@dataclass(frozen=True)
class Fetched:
    """A file of a published set that is there and has the right contents."""

    file: PublishedFile  # what it is
    path: Path  # where it is
    downloaded: bool  # whether it was not there before


def published_folder(given: str | None) -> Path | None:
    """Return the folder that published data is read from."""
    named = given or os.environ.get(VARIABLE)
    if named:
        return Path(named)
    cache = _cache()
    return cache if cache is not None and cache.is_dir() and any(cache.iterdir()) else None


def destination(given: str | None) -> Path:
    """Return the folder that files are fetched into: the option, ``DRYSTONE_DATA`` or the cache."""
    named = given or os.environ.get(VARIABLE)
    if named:
        return Path(named)
    cache = _cache()
    if cache is None:
        raise _extra_missing("fetch", f"Or name a folder: `--to DIR`, or {VARIABLE}.")
    return cache


def published_file(folder: Path, name: str) -> Path:
    """Return the path of a published file, which has the contents that were released."""
    path = folder / name
    for known, published in SETS.items():
        for file in published.files:
            if file.name == name and _sha256(path) not in (file.sha256, None):
                to = "" if folder == _cache() else f" --to {shlex.quote(str(folder))}"
                cure = f"Move it away and fetch it again (`drystone fetch {known}{to}`), or"
                raise _other_contents(path, cure, f"{RAW}/{file.address}")
    return path


def fetch_set(wanted: PublishedSet, folder: Path, *, address: str = RAW) -> list[Fetched]:
    """Bring the files of a set into a folder, with their licence; what is there is only checked."""
    fetched = []
    for file in wanted.files:
        path, url = folder / file.name, f"{address}/{file.address}"
        missing = not path.exists()
        if missing:
            _download(file, path, url)
            _write_notice(folder)  # at once: the next file may fail
        elif sha256(path.read_bytes()).hexdigest() != file.sha256:
            raise _other_contents(path, "Move it away and fetch it again, or", url)
        fetched.append(Fetched(file, path, missing))
    return fetched


def _sha256(path: Path) -> str | None:
    """Return the hash of a file; None when it cannot be read."""
    try:
        found = path.stat()
        return _hash_of(path, found.st_size, found.st_mtime_ns)
    except OSError:
        return None


@lru_cache
def _hash_of(path: Path, _size: int, _mtime_ns: int) -> str:
    """Return the hash of a file, read once as long as it stays the same."""
    return sha256(path.read_bytes()).hexdigest()


def _write_notice(folder: Path) -> None:
    """Write the licence beside the files, as it asks for."""
    if not (folder / NOTICE).exists():
        write_whole(folder / NOTICE, LICENCE.encode())


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
        raise InputError(
            "E161",
            f"cannot be downloaded ({_reason(error)}).",
            where=str(path),
            cure=_by_hand(url, path),
        ) from error


def _cache() -> Path | None:
    """Return the folder of the cache; None when pooch is not installed."""
    try:
        import pooch  # noqa: PLC0415 - an extra
    except ImportError:
        return None
    return Path(pooch.os_cache("drystone"))


def _reason(error: BaseException) -> str:
    """Say in a few words why a download failed: the innermost error knows."""
    while error.__context__ is not None:
        error = error.__context__
    return f"{type(error).__name__}: {error}"


def _by_hand(url: str, path: Path) -> str:
    """Say how to do without a download."""
    return (
        f"By hand: save {url} as {path}. Or name a folder that has {path.parent.name}/{path.name} "
        f"with {VARIABLE}."
    )


def _other_contents(path: Path, cure: str, url: str) -> InputError:
    """Return the error for a file that is not the published one."""
    return InputError(
        "E160",
        "has other contents than the published file (SHA-256).",
        where=str(path),
        cure=f"{cure} save {url} there.",
    )


def _extra_missing(where: str, cure: str) -> InputError:
    """Return the error for the missing library."""
    return InputError(
        "E162",
        "pooch, which downloads, is not installed.",
        where=where,
        cure=f"`pip install 'drystone[fetch]'`. {cure}",
    )
