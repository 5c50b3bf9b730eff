"""The photograph of the stones that a plan is made of, on its way beside the plan."""

import sys
from dataclasses import replace
from pathlib import Path

from drystone.io.photo_beside import check_place, photo_beside, place_photo
from drystone.io.photo_picture import read_photo_picture
from drystone.model.stone import StoneSet
from drystone.search.plan_result import PlanResult


def check_photo(photo: Path | None, stones: StoneSet, folder: Path) -> None:
    """Refuse before the search what would stop the report after it: E129, E189."""
    check_place(photo, folder)
    if photo is not None:
        read_photo_picture(photo, (stones.source.width_px, stones.source.height_px))


def with_photo(
    result: PlanResult, photo: Path | None, folder: Path
) -> tuple[PlanResult, Path | None]:
    """Put the photograph beside the plan and into its source; name one that is of no plan."""
    beside, record = place_photo(photo, folder)
    found = photo_beside(folder)
    if found != beside:
        print(
            f"drystone: {found} was not put there by a plan and stays; `drystone export` would "
            "take it for the photograph of these stones",
            file=sys.stderr,
        )
    plan = replace(result.plan, source={**result.plan.source, **record})
    return replace(result, plan=plan), beside
