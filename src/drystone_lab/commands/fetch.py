"""`drystone fetch`: published stone sets."""

import argparse
from pathlib import Path

from drystone.cli.output import print_json
from drystone.errors import ExitCode, UsageError, counted
from drystone.io.published import (
    LICENCE,
    PAPER,
    RAW,
    REPOSITORY,
    SETS,
    Fetched,
    destination,
    fetch_set,
)


def run(arguments: argparse.Namespace) -> ExitCode:
    """Bring sets to this machine; say where they are, their licence, and what to cite."""
    if arguments.list:
        for name, published in SETS.items():
            print(f"{name}: {published.text} ({counted(len(published.files), 'file')})")
        return ExitCode.DONE
    names = _names(arguments.sets)
    folder = destination(arguments.output)
    fetched = {name: fetch_set(SETS[name], folder, address=RAW) for name in names}
    if arguments.json:
        print_json(_record(folder, fetched))
    else:
        _print(folder, fetched)
    return ExitCode.DONE


def _names(given: list[str]) -> list[str]:
    """Return the sets that are asked for; E138 for none, or one that there is not."""
    unknown = [name for name in given if name not in SETS]
    if unknown or not given:
        raise UsageError(
            "E138",
            f"there is no set {unknown[0]!r}." if unknown else "no set is named.",
            where="fetch",
            cure=f"Name {' or '.join(SETS)}; `drystone fetch --list` says what they are.",
        )
    return list(dict.fromkeys(given))


def _print(folder: Path, fetched: dict[str, list[Fetched]]) -> None:
    for files in fetched.values():
        for file in files:
            print(
                f"{file.path}  {'downloaded' if file.downloaded else 'was there'}, contents right"
            )
    print(f"\nTo use the folder elsewhere: DRYSTONE_DATA={folder}")
    print(f"\nReleased with {REPOSITORY}. Cite:")
    for source in [PAPER, *(SETS[name].source for name in fetched)]:
        print(f"- {source}")
    print(f"\n{LICENCE}", end="")


def _record(folder: Path, fetched: dict[str, list[Fetched]]) -> dict[str, object]:
    return {
        "folder": str(folder),
        "files": [
            {
                "set": name,
                "path": str(file.path),
                "downloaded": file.downloaded,
                "sha256": file.file.sha256,
                "source": f"{RAW}/{file.file.address}",
            }
            for name, files in fetched.items()
            for file in files
        ],
        "cite": [PAPER, *(SETS[name].source for name in fetched)],
        "licence": LICENCE,
    }
