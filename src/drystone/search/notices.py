"""What a user should know of how a wall was planned."""

from collections.abc import Iterator, Sequence

from drystone.errors import Notice
from drystone.planner.events import OUT_OF_TIME, Stopped
from drystone.planner.planner import Planner


def missing_stones(planner: Planner) -> tuple[int, ...]:
    """Return the ids of pinned stones that are not in the wall of a planner."""
    placed = {action.stone_id for action in planner.build.actions}
    return tuple(sorted(set(planner.settings.pin) - placed))


def planning_notices(
    asked: Planner,
    built: Planner,
    left_out: Sequence[int],
    *,
    lost: bool = False,
    fallen: Sequence[int] = (),
    cut_after: int | None = None,
    stopped: Stopped | None = None,
) -> tuple[Notice, ...]:
    """Return the notices of a plan."""
    missing = _missing(missing_stones(built))
    cut = (*_cut(cut_after), *_cut_short(built, cut_short=stopped == OUT_OF_TIME))
    begun = (*_left_out(left_out), *_fallen(fallen))
    return (*begun, *missing, *_lost(lost=lost), *cut, *_solves(asked))


def _left_out(stone_ids: Sequence[int]) -> Iterator[Notice]:
    if stone_ids:
        yield Notice(
            "W121",
            f"stones {', '.join(map(str, stone_ids))} of the plan to begin with were taken out: "
            "banned, out of their turn, or not standing without the others or with these settings.",
        )


def _fallen(stone_ids: Sequence[int]) -> Iterator[Notice]:
    if stone_ids:
        yield Notice(
            "W126",
            "the wall that is built already does not stand after stones "
            f"{', '.join(map(str, stone_ids))}; no better wall was looked for.",
            "Take down the first of them and what rests on it, and plan again.",
        )


def _missing(stone_ids: Sequence[int]) -> Iterator[Notice]:
    if stone_ids:
        yield Notice(
            "W120",
            f"pinned stones found no place in the wall: {', '.join(map(str, stone_ids))}.",
            "Look for longer (--time), or pin fewer stones.",
        )


def _lost(*, lost: bool) -> Iterator[Notice]:
    if lost:
        yield Notice(
            "W122",
            "a process of the search died, and the search ended there with the best wall so far.",
            "Give less --jobs if memory ran out.",
        )


def _cut(walls: int | None) -> Iterator[Notice]:
    if walls is not None:
        yield Notice(
            "W125",
            f"what follows a search was cut short after {walls} walls; this is the best of them.",
            "To look for a better one from here, give this plan to --from.",
        )


def _cut_short(planner: Planner, *, cut_short: bool) -> Iterator[Notice]:
    if cut_short:
        placed, fitting = len(planner.build.actions), len(planner.workshop.fitting)
        yield Notice(
            "W128",
            f"the time limit struck after {placed} of {fitting} stones of the first wall; the plan "
            "is what is built of it.",
            "Give the same command again with --resume to go on with it, or more --time.",
        )


def _solves(planner: Planner) -> Iterator[Notice]:
    if planner.failed_solves:
        yield Notice(
            "W303",
            f"the solver gave up on {planner.failed_solves} candidates, which were passed over.",
            "Please report this with the stones and the settings.",
        )
