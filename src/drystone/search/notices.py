"""What a user should know of how a wall was planned."""

from collections.abc import Iterator, Sequence

from drystone.errors import Notice
from drystone.planner.events import OUT_OF_TIME
from drystone.planner.planner import Planner
from drystone.search.plan_result import missing_stones
from drystone.search.whole_search import SearchEnd


def planning_notices(
    first: Planner, ended: SearchEnd, left_out: Sequence[int], *, cut: bool
) -> Iterator[Notice]:
    """List the notices of a plan.

    `left_out` are stones of the wall that was begun with; `cut` says that there was no time for
    all that follows a search.
    """
    if left_out:
        yield Notice(
            "W121",
            f"stones {_listed(left_out)} of the plan to begin with were taken out: "
            "banned, out of their turn, or not standing without the others or with these settings.",
        )
    if ended.fallen:
        yield Notice(
            "W126",
            "the wall that is built already does not stand after stones "
            f"{_listed(ended.fallen)}; no better wall was looked for.",
            "Take down the first of them and what rests on it, and plan again.",
        )
    if missing := missing_stones(ended.planner):
        yield Notice(
            "W120",
            f"pinned stones found no place in the wall: {_listed(missing)}.",
            "Look for longer (--time), or pin fewer stones.",
        )
    if ended.lost:
        yield Notice(
            "W122",
            "a process of the search died, and the search ended there with the best wall so far.",
            "Give less --jobs if memory ran out.",
        )
    if cut:
        yield Notice(
            "W125",
            f"what follows a search was cut short after {ended.walls} walls; this is the best of "
            "them.",
            "To look for a better one from here, give this plan to --from.",
        )
    if ended.stopped == OUT_OF_TIME:
        placed, fitting = len(ended.planner.build.actions), len(first.workshop.fitting)
        yield Notice(
            "W128",
            f"the time limit struck after {placed} of {fitting} stones of the first wall; the plan "
            "is what is built of it.",
            "Give the same command again with --resume to go on with it, or more --time.",
        )
    if first.failed_solves:
        yield Notice(
            "W303",
            f"the solver gave up on {first.failed_solves} candidates, which were passed over.",
            "Please report this with the stones and the settings.",
        )


def _listed(stone_ids: Sequence[int]) -> str:
    return ", ".join(map(str, stone_ids))
