"""What is read, and is never written over."""

from collections.abc import Iterable
from pathlib import Path

from drystone.cli.output import refusal
from drystone.io.images import SUFFIXES
from drystone.io.photo_beside import LABELS, read_sidecar
from drystone.io.plan_folder import DRAWN, WRITTEN


def files_of(stones: Path) -> tuple[Path, ...]:
    """Return the files that stones are read from: itself, or what is read of a folder."""
    if not stones.is_dir():
        return (stones,)
    if read_sidecar(stones / LABELS) is not None:
        return (stones / LABELS,)
    return tuple(entry for entry in stones.iterdir() if entry.suffix.lower() in SUFFIXES)


def plan_file(plan: Path) -> Path:
    """Return the file that a plan is read from, which its folder may stand for."""
    return plan / "plan.json" if plan.is_dir() else plan


def files_of_wall(wall: Path) -> tuple[Path, ...]:
    """Return the files that a wall is read from: an image or a model, or what a plan's folder has.

    Not all of them need be there.
    """
    if not wall.is_dir() and wall.suffix.lower() != ".json":
        return (wall,)
    file = plan_file(wall)
    return (file, *(file.parent / name for name in WRITTEN))


def refuse_inputs(read: Iterable[Path], written: Iterable[Path]) -> None:
    """Refuse to write where something is read, by any name, whatever is said of overwriting (E129).

    Files of both need not be there.
    """
    what = "is read here, and what is read is never replaced, also not with --overwrite."
    _refuse_over(read, written, what, "Choose another place for what is written.")


def _refuse_over(kept: Iterable[Path], written: Iterable[Path], what: str, cure: str) -> None:
    """Refuse to write over a file that is to be kept, by any name."""
    there = [path for path in kept if path.exists()]
    for path in written:
        if path.exists() and any(path.samefile(one) for one in there):
            raise refusal(path, what, cure)


def refuse_plans_own(wall: Path, written: Iterable[Path]) -> None:
    """Refuse to write over what `plan` drew of a wall, when it is in that plan's folder (E129)."""
    folder = plan_file(wall).parent
    if (folder / "plan.json").is_file():
        what = "belongs to the plan, and is not replaced by what is made of its wall."
        drawn = [folder / name for name in DRAWN]
        _refuse_over(drawn, written, what, "Choose another folder with -o.")


def refuse_among_masks(stones: Path, written: Iterable[Path]) -> None:
    """Refuse pictures in a folder of masks that is read: each would be one more stone (E129)."""
    if not stones.is_dir() or read_sidecar(stones / LABELS) is not None:
        return
    for path in written:
        among = path.parent.is_dir() and path.parent.samefile(stones)
        if among and path.suffix.lower() in SUFFIXES:
            what = "would lie among the masks that are read here, and be read as one of them."
            raise refusal(path, what, "Choose another place for what is written.")
