"""`drystone fetch`: published stone sets."""

import argparse

from drystone.cli.output import print_json
from drystone.errors import ExitCode, UsageError, counted
from drystone.io.published import LICENCE, PAPER, RAW, REPOSITORY, SETS, destination, fetch_set


def run(arguments: argparse.Namespace) -> ExitCode:
    """Bring sets to this machine; say where they are, their licence, and what to cite."""
    if arguments.list:
        for name, published in SETS.items():
            print(f"{name}: {published.text} ({counted(len(published.files), 'file')})")
        return ExitCode.DONE
    unknown = [name for name in arguments.sets if name not in SETS]
    if unknown or not arguments.sets:
        what = f"there is no set {unknown[0]!r}." if unknown else "no set is named."
        cure = f"Name {' or '.join(SETS)}; `drystone fetch --list` says what they are."
        raise UsageError("E138", what, where="fetch", cure=cure)
    names = list(dict.fromkeys(arguments.sets))
    folder = destination(arguments.output)
    fetched = [
        (name, file) for name in names for file in fetch_set(SETS[name], folder, address=RAW)
    ]
    cite = [PAPER, *(SETS[name].source for name in names)]
    if arguments.json:
        files = [
            {
                "set": name, "path": str(file.path), "downloaded": file.downloaded,
                "sha256": file.file.sha256, "source": f"{RAW}/{file.file.address}",
            }
            for name, file in fetched
        ]  # fmt: skip
        print_json({"folder": str(folder), "files": files, "cite": cite, "licence": LICENCE})
        return ExitCode.DONE
    for _, file in fetched:
        print(f"{file.path}  {'downloaded' if file.downloaded else 'was there'}, contents right")
    print(f"\nTo use the folder elsewhere: DRYSTONE_DATA={folder}")
    print(f"\nReleased with {REPOSITORY}. Cite:")
    for source in cite:
        print(f"- {source}")
    print(f"\n{LICENCE}", end="")
    return ExitCode.DONE
