"""Many runs: what came out of them, and the folder that keeps it, so that none is done twice."""

import json
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from drystone.errors import DrystoneError, InputError
from drystone.io.plan_json import plan_from_json, plan_to_json
from drystone.model.plan import Plan, StoneStep, WedgeStep
from drystone.model.stone import StoneSet
from drystone.model.wall import Wall
from drystone.search.plan_wall import plan_wall
from drystone.verify.replay import replay_plan
from drystone.whole_files import write_whole
from drystone_lab.runs.spec import STRIPS, RunSpec

FIGURES = (
    "placed", "stones", "F_SF", "F_AV", "F_AH", "F_LR", "alpha_left", "alpha_right", "T_LEVEL",
    "E_FLUSH", "wedges", "wedge_area", "candidates",
)  # fmt: skip
"""Of a finished wall; they depend on the run alone.  Candidates are those that were evaluated."""


@dataclass(frozen=True, eq=False)
class RunOutcome:
    """A planned wall, as it is kept."""

    key: str
    # By the names of :data:`FIGURES`; lengths and areas in source px; None where a figure is not
    # defined
    figures: Mapping[str, float | int | None]
    plan: Mapping[str, Any]  # Contents of its plan.json
    # Seconds on the machine where it ran: ``"wall"`` from the stones to the last step, and the
    # parts of the work (:mod:`drystone.planner.profile`).  Nothing else differs between machines
    times: Mapping[str, float]

    @property
    def as_plan(self) -> Plan:
        """The plan."""
        return plan_from_json(self.plan)

    @property
    def clusters(self) -> dict[int, int]:
        """Cluster of each placed stone, by id."""
        steps = self.as_plan.steps
        return {step.stone: step.cluster for step in steps if isinstance(step, StoneStep)}

    def wall(self, spec: RunSpec, data: Path | None) -> Wall:
        """Return the wall with its stones, built again from the poses of the plan."""
        replay = replay_plan(self.as_plan, spec.source.stones(data))
        if replay.broken_at is not None or not replay.stages:
            raise ValueError(f"run {self.key} cannot be built again")
        return replay.stages[-1].after


def execute(spec: RunSpec, data: Path | None, stones: StoneSet | None = None) -> RunOutcome:
    """Plan the wall of a run, in this process.

    >>> from drystone_lab.runs.spec import generated
    >>> spec = RunSpec(source=generated("brick", 1, count=6, height_px=10, aspect=2),
    ...                width=60, height=20)
    >>> execute(spec, None).figures["placed"]
    6
    """
    if spec.method == STRIPS:
        from drystone_lab.packing import packed  # noqa: PLC0415 - it needs this module

        return packed(spec, data)
    stones = spec.source.stones(data) if stones is None else stones
    result = plan_wall(
        stones,
        *spec.size(stones),
        seed=spec.seed,
        method=spec.method,
        settings=spec.settings(),
        scale=spec.scale,
        coulomb=False,  # no figure of a run
    )
    if result.status == "interrupted":  # planning takes Ctrl-C for the end of its time
        raise KeyboardInterrupt
    plan, metrics = result.plan, result.metrics
    figures: dict[str, float | int | None] = {
        "placed": sum(isinstance(step, StoneStep) for step in plan.steps),
        "stones": len(stones),
        **{name: getattr(metrics, name) for name in FIGURES[2:10]},
        "wedges": sum(isinstance(step, WedgeStep) for step in plan.steps),
        "wedge_area": metrics.wedge_area,
        "candidates": result.profile.candidates,
    }
    times = {"wall": result.seconds} | {
        name: sum(step.parts.get(name, 0.0) for step in result.profile.steps)
        for name in ("placement", "stabilisation", "contacts", "limit analysis", "indices")
    }
    return RunOutcome(spec.key, figures, plan_to_json(plan), times)


def died(spec: RunSpec | str, who: str) -> DrystoneError:
    """Return E402: who did a run died at it."""
    what = f"the {who} that did this run died, for want of memory for example."
    cure = (
        "Give the same command again: the runs that ended are kept. Ask for fewer at once if "
        "memory ran out."
    )
    return DrystoneError("E402", what, where=str(spec), cure=cure)


def absent_data(absent: Sequence[str], *, known: bool) -> InputError:
    """Return the error about published stones that are not there (E100).

    >>> absent_data(["almeida/R.png", "almeida/PR.png"], known=True).where
    'almeida/R.png, almeida/PR.png'
    """
    sets = " ".join(dict.fromkeys(name.split("/")[0] for name in absent))
    why = "are not in the folder of published data" if known else "are not there"
    what = f"published stones that this needs {why}."
    cure = (
        f"`drystone fetch {sets}` gets them; or name a folder that has them with --data or "
        "DRYSTONE_DATA."
    )
    return InputError("E100", what, where=", ".join(absent), cure=cure)


RunWorker = Callable[[Sequence[RunSpec], Path | None], Iterator[RunOutcome]]
"""Does runs, and gives their outcomes in whatever order they end."""


def one_by_one(specs: Sequence[RunSpec], data: Path | None) -> Iterator[RunOutcome]:
    """Do runs in this process, one after the other."""
    for spec in specs:
        yield execute(spec, data)


@dataclass(frozen=True)
class Runner:
    """Does runs and keeps their outcomes."""

    folder: Path  # Of the outcomes, a file a run
    data: Path | None = None  # Folder of the published data
    # Who does what is not there yet; never changes an outcome but for its times
    work: RunWorker = one_by_one
    say: Callable[[str], None] = lambda _: None  # Told of progress, a line each
    again: bool = False  # Do runs again that are kept

    def run(self, specs: Sequence[RunSpec]) -> tuple[RunOutcome, ...]:
        """Return the outcomes of runs, in their order; what ended is kept at once."""
        found = {spec.key: None if self.again else self.kept(spec.key) for spec in specs}
        missing = {spec.key: spec for spec in specs if found[spec.key] is None}
        for count, outcome in enumerate(self.work(tuple(missing.values()), self.data), 1):
            self.keep(outcome)
            found[outcome.key] = outcome
            self.say(f"{count} of {len(missing)} walls, {outcome.times['wall']:.1f} s")
        done = tuple(one for spec in specs if (one := found[spec.key]) is not None)
        if len(done) < len(specs):
            raise RuntimeError("runs were lost")
        return done

    def kept(self, key: str) -> RunOutcome | None:
        """Return the outcome of a run; None when it is not there."""
        path = self.folder / f"{key}.json"
        try:
            data = json.loads(path.read_text(encoding="utf-8"))
            figures, plan, times = (dict(data[name]) for name in ("figures", "plan", "times"))
            if not ("wall" in times and "steps" in plan and set(FIGURES) <= figures.keys()):
                raise KeyError(key)
        except FileNotFoundError:
            return None
        except (ValueError, TypeError, KeyError) as error:
            what = "the outcome of a run that is kept here is damaged."
            cure = "Delete the file: its run is then done again."
            raise InputError("E401", what, where=str(path), cure=cure) from error
        return RunOutcome(key, figures, plan, times)

    def keep(self, outcome: RunOutcome) -> None:
        """Keep an outcome; the file is whole or not there."""
        self.folder.mkdir(parents=True, exist_ok=True)
        data = {"figures": outcome.figures, "plan": outcome.plan, "times": outcome.times}
        text = json.dumps(data, ensure_ascii=False, allow_nan=False)
        write_whole(self.folder / f"{outcome.key}.json", text.encode())
