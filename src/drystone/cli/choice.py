"""Several walls of one search, to choose from (`--pareto`)."""

from pathlib import Path
from typing import Any

from drystone.cli.output import make_folder, refuse_file
from drystone.drawing.words.content import number
from drystone.io.plan_folder import WRITTEN, write_plan_folder
from drystone.search.plan_result import PlanResult
from drystone.whole_files import refuse_existing

FOLDER, PICTURE = "pareto", "pareto.png"
PLACES = f"{FOLDER}/[0-9][0-9]/"
"""Pattern of the folders of the walls."""

FIGURES = {"F_SF": 3, "F_AV": 1, "F_AH": 2, "F_LR": 3}
"""Figures of merit of the table, with their digits."""


def files_of_choice(folder: Path) -> tuple[Path, ...]:
    """Return what lies where the choice of a search is: a plan replaces it, or takes it out."""
    return (folder / PICTURE, *(folder / FOLDER).glob("*/*"))


def prepare_choice(folder: Path) -> None:
    """Refuse what would be in the way of a choice, before one is searched for (E129)."""
    refuse_existing(folder / PICTURE, overwrite=True)
    for place in (folder / FOLDER, *(folder / FOLDER).glob("[0-9][0-9]")):
        refuse_file(place)
        for name in WRITTEN:
            refuse_existing(place / name, overwrite=True)


def write_choice(result: PlanResult, folder: Path) -> None:
    """Write the walls to choose from, a folder each, and one picture of all."""
    walls = _walls(result)
    for index, one in enumerate(walls, 1):
        place = _place(folder, index)
        make_folder(place)
        write_plan_folder(one, place)
    clear_choice(folder, len(walls) + 1)
    # Drawing loads matplotlib, which takes as long as a small plan.
    from drystone.drawing import plot_choice, save  # noqa: PLC0415

    figure = plot_choice([one.wall for one in walls], [_figures(one) for one in walls])
    save(figure, folder / PICTURE)


def clear_choice(folder: Path, index: int = 1) -> None:
    """Take out what an earlier run left, from a wall on: it belongs to another search."""
    if (_place(folder, 1) / "plan.json").exists():
        (folder / PICTURE).unlink(missing_ok=True)
    while ((place := _place(folder, index)) / "plan.json").exists():
        for name in WRITTEN:
            (place / name).unlink(missing_ok=True)
        if not any(place.iterdir()):
            place.rmdir()
        index += 1
    if (folder / FOLDER).is_dir() and not any((folder / FOLDER).iterdir()):
        (folder / FOLDER).rmdir()


def choice_summary(result: PlanResult, folder: Path) -> list[dict[str, Any]]:
    """Return the walls to choose from for JSON."""
    return [
        {"plan": str(_place(folder, index) / "plan.json"), "placed": len(one.plan.stone_steps)}
        | _figures(one)
        for index, one in enumerate(_walls(result), 1)
    ]


def print_choice(walls: list[dict[str, Any]]) -> None:
    """Print what :func:`choice_summary` returns, one wall a line."""
    columns = " ".join(f"{name:>8}" for name in FIGURES)
    print(f"\nwalls that none beats in every figure (pareto.png)\n{'':9} {columns}   stones")
    for index, one in enumerate(walls, 1):
        values = " ".join(f"{number(one[name], digits):>8}" for name, digits in FIGURES.items())
        print(f"{FOLDER}/{index:02} {values} {one['placed']:>8}")


def _walls(result: PlanResult) -> tuple[PlanResult, ...]:
    return result.choice or (result,)  # a single pass has one


def _figures(result: PlanResult) -> dict[str, float | None]:
    return {name: getattr(result.metrics, name) for name in FIGURES}


def _place(folder: Path, index: int) -> Path:
    return folder / FOLDER / f"{index:02}"
