"""What is kept of a plan while it is made, so that a run that is killed loses little."""

import time
from collections.abc import Callable, Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

from drystone.cli.choice import clear_choice
from drystone.cli.output import note
from drystone.errors import DrystoneError, Notice
from drystone.io.checkpoint import CHECKPOINT, Checkpoint, write_checkpoint
from drystone.io.photo_beside import place_photo
from drystone.io.plan_folder import WRITTEN as WITH_PLAN
from drystone.io.plan_folder import write_plan_folder
from drystone.planner.events import UNFINISHED
from drystone.search.plan_result import PlanResult
from drystone.search.plan_wall import SoFar
from drystone.search.state import SearchState

WRITTEN = (
    "plan.json", "report.html", "wall.png", "wall.tif", "picture.png", "mechanism_left.png",
    "mechanism_right.png", "settings.toml", "blocks.json", "build.gif",
)  # fmt: skip
"""What a plan's folder may hold, the most useful first."""

EVERY_S = 4.0
"""Nothing is kept more often, but for the first wall when it is whole,"""

SHARE = 0.005
"""and neither the plan nor the checkpoint takes a larger share of the time."""


class Keeper:
    """Keeps the best plan so far and the checkpoint of its search in the folder of the plan.

    `made_of`: see :class:`~drystone.io.checkpoint.Checkpoint`; `photo` is put beside the plan.
    """

    def __init__(
        self,
        folder: Path,
        made_of: Mapping[str, Any],
        photo: Path | None,
        clock: Callable[[], float] = time.monotonic,
    ) -> None:
        self._folder, self._made_of, self._photo = folder, made_of, photo
        self._search, self._plan = _Pace(clock), _Pace(clock)
        self._state: SearchState | None = None
        self._kept: SearchState | None = None
        self._merit: float | None = None
        self._record: Mapping[str, Any] | None = None
        self._told = False

    def begin(self, state: SearchState | None) -> None:
        """Say in the folder what is planned there, and from where a search goes on."""
        self._state = state
        self._keep_search()

    def __call__(self, so_far: SoFar) -> None:
        """Keep what there is so far, if it is time to; a full disk does not end a search."""
        progress = so_far.progress
        if progress is not None and progress.state is not None:
            self._state = progress.state
        merit = None if progress is None else progress.best.merit
        better = merit is None or self._merit is None or merit > self._merit
        whole = progress is not None and progress.walls == 1
        try:
            # A plan is never better than what the checkpoint leads to.
            if better and (whole or self._plan.due):
                self._keep_search()
                with self._plan:
                    self._keep_plan(so_far.plan())
                self._merit = merit
            elif self._state is not self._kept and self._search.due:
                self._keep_search()
        except (DrystoneError, OSError) as error:
            if not self._told:
                why = error.what.rstrip(".") if isinstance(error, DrystoneError) else error.strerror
                what = f"what is planned so far cannot be kept in {self._folder}: {why}."
                cure = "Planning goes on; if it is killed, what it has found is lost."
                note(Notice("W130", what, cure))
            self._told = True

    def end(self, result: PlanResult) -> None:
        """Keep where a search stands that is to be gone on with; a finished plan is enough."""
        if result.plan.stopped in UNFINISHED and self._state is not None:
            self._keep_search()
        else:
            (self._folder / CHECKPOINT).unlink(missing_ok=True)

    def _keep_search(self) -> None:
        with self._search:
            write_checkpoint(Checkpoint(self._made_of, self._state), self._folder)
            self._kept = self._state

    def _keep_plan(self, result: PlanResult) -> None:
        """Write a plan that is not finished, without pictures; those of another plan go."""
        if self._record is None:
            _, self._record = place_photo(self._photo, self._folder)
            clear_choice(self._folder)
            for name in set(WRITTEN) - set(WITH_PLAN):
                (self._folder / name).unlink(missing_ok=True)
        plan = replace(result.plan, source={**result.plan.source, **self._record})
        write_plan_folder(replace(result, plan=plan), self._folder)


class _Pace:
    """When something may be done again, by how long it has taken; a context around it."""

    def __init__(self, clock: Callable[[], float]) -> None:
        self._clock = clock
        self._begun = clock()
        self._next = self._begun + EVERY_S

    @property
    def due(self) -> bool:
        return self._clock() >= self._next

    def __enter__(self) -> None:
        self._begun = self._clock()

    def __exit__(self, *_: object) -> None:
        now = self._clock()
        self._next = max(self._next, now + max(EVERY_S, (now - self._begun) / SHARE))
