"""What is kept of a plan while it is made, and the plans that a search begins with.

So a run that is killed loses little: `--resume` goes on from the folder, `--from` from any plan.
"""

import json
import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from drystone.cli.choice import clear_choice
from drystone.cli.output import note, print_json
from drystone.cli.settings import PlanRequest
from drystone.drawing.words.planned import summary_of_plan
from drystone.errors import DrystoneError, Notice, PlanError, UsageError
from drystone.io.checkpoint import CHECKPOINT, Checkpoint, read_checkpoint, write_checkpoint
from drystone.io.photo_beside import place_photo
from drystone.io.plan_folder import WRITTEN as WITH_PLAN
from drystone.io.plan_folder import write_plan_folder
from drystone.io.plan_json import read_plan
from drystone.model.plan import Plan
from drystone.model.site import Site
from drystone.model.wall import Wall
from drystone.planner.events import UNFINISHED, Stopped
from drystone.planner.planner import Planner
from drystone.planner.replay import differences, refuse
from drystone.search.plan_result import PlanResult, result_of
from drystone.search.plan_wall import SoFar
from drystone.search.state import SearchState
from drystone.verify.replay import rebuild_wall

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


@dataclass(frozen=True, eq=False)
class Earlier:
    """What an earlier run of the same command has left."""

    plan: Plan | None = None  # partial, to be gone on with; or finished
    state: SearchState | None = None  # where its search stands, which goes on whatever the plan is
    begun: bool = False  # whether there is anything of it

    def tell(self) -> None:
        """Say what is gone on with."""
        if self.state is not None:
            note(f"going on after {self.state.reached.walls} walls of {CHECKPOINT}")
        elif self.plan is not None:
            note(f"going on after {len(self.plan.stone_steps)} stones")
        elif self.begun:
            note("nothing to go on with yet, planning begins anew")


def made_of(request: PlanRequest) -> dict[str, Any]:
    """Return all that shapes the plan of a command, by what the user gives, as JSON has it."""
    source = request.stones.source
    shaped = {
        "stones": source.sha256,
        "reading": dict(source.reading),
        "--wall": request.wall,
        "--px-per-m": request.px_per_m,
        "--scale": request.scale,
        "--seed": request.options.seed,
        "--method": request.method,
        "settings": _without_budget(request.settings.as_dict()),
    }
    return dict(json.loads(json.dumps(shaped)))


def _without_budget(settings: Mapping[str, Any]) -> dict[str, Any]:
    """Leave out how many walls a search builds: an interrupted plan says how many it had built."""
    search = dict(settings.get("search", {}))
    search.pop("budget", None)
    return {**settings, "search": search}


def earlier_run(request: PlanRequest) -> Earlier:
    """Return what to go on from, if that is asked for; refuse what is of something else (E136)."""
    if not request.options.resume:
        return Earlier()
    folder, asked = request.folder, made_of(request)
    path = folder / "plan.json"
    ids = [stone.id for stone in request.stones]
    try:
        kept = read_checkpoint(folder, ids, request.settings.search)
    except PlanError as error:
        cure = "The partial plan is gone on from." if path.exists() else "Planning begins anew."
        note(Notice("W129", f"{error.where}: {error.what}", cure))
        kept = None
    if kept is not None:
        _refuse([n for n in asked if kept.made_of.get(n) != asked[n]], folder / CHECKPOINT)
        if kept.state is not None:
            return Earlier(state=kept.state, begun=True)
    plan = read_plan(path) if path.exists() else None
    different = [] if plan is None else _differences(plan, asked, request.options.method)
    if kept is None:
        if plan is not None:
            _refuse(different, path)
        return Earlier(plan, begun=(folder / CHECKPOINT).exists() or plan is not None)
    # Beside a checkpoint a finished plan is an earlier one, or was not written to the end.
    partial = plan is not None and not different and plan.stopped in UNFINISHED
    return Earlier(plan if partial else None, begun=True)


def _differences(plan: Plan, asked: Mapping[str, Any], asked_method: str) -> list[str]:
    """Name what a plan was made of that is not what is asked for, as :func:`made_of` has it."""
    wall, method, settings = asked["--wall"], plan.method, _without_budget(plan.settings)
    px_per_m = asked["--px-per-m"] or 1.0
    wall_px = plan.width * px_per_m, plan.height * px_per_m
    same_wall = np.allclose(wall_px, wall, rtol=0, atol=1e-6)
    own = (
        plan.source["sha256"], plan.source.get("reading", {}), wall if same_wall else None,
        plan.px_per_m, plan.working_scale, plan.seed,
        asked["--method"] if method == asked_method else method, settings,
    )  # fmt: skip
    return [name for name, value in zip(asked, own, strict=True) if value != asked[name]]


def _refuse(different: list[str], path: Path) -> None:
    if different:
        what = f"the partial plan was made with other {', '.join(different)}."
        cure = "Give the same command again with --resume added, or plan into another folder."
        raise UsageError("E136", what, where=str(path), cure=cure)


def tell_finished(plan: Plan, request: PlanRequest) -> str:
    """Say that there is nothing to go on with; return the status that the wall ended with."""
    note("this plan is finished, there is nothing to go on with; --from begins a search with it")
    wall = rebuild_wall(plan, request.stones)
    planner = Planner(request.stones, wall.site, seed=plan.seed, settings=request.settings)
    planner.restore(wall, plan.course_heights_px)
    # A plan keeps why it ended in words only, and the words are all that is asked for.
    planner.stopped = Stopped("search", plan.stopped)
    result = result_of(planner)
    if result.shortfall:
        note(f"{result.status}: {result.shortfall}")
    if request.options.json:
        print_json(summary_of_plan(plan, request.folder) | {"status": "finished"})
    return result.status


def plan_to_begin_with(request: PlanRequest, site: Site) -> tuple[Plan | None, Wall | None]:
    """Return the plan of `--from` and its wall; None when there is none.

    E144: it is of other stones, or in poses that the settings do not allow, or its wall is of
    something else (:func:`~drystone.planner.replay.differences`).
    """
    begin = request.options.begin
    if begin is None:
        return None, None
    plan, stones, settings = read_plan(Path(begin)), request.stones, request.settings
    if plan.source["sha256"] != stones.source.sha256:
        refuse({"other stones": ""}, begin)
    if plan.source.get("reading", {}) != dict(stones.source.reading):
        refuse({"stones that were read otherwise": ""}, begin)
    wall = rebuild_wall(plan, stones)
    different = differences(wall, stones, site, settings)
    orientations = plan.settings.get("orientations", settings.orientations)
    if orientations != settings.orientations:
        different["other orientations"] = f"--orientations {orientations}"
    refuse(different, begin)
    return plan, wall
