"""Many runs: those that are kept are taken, the others done by whoever works."""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

from drystone.errors import DrystoneError, InputError
from drystone_lab.runs.outcome import RunOutcome, RunStore, execute
from drystone_lab.runs.spec import RunSpec


def died(spec: RunSpec | str, who: str) -> DrystoneError:
    """Return E402: who did a run died at it."""
    return DrystoneError(
        "E402",
        f"the {who} that did this run died, for want of memory for example.",
        where=str(spec),
        cure="Give the same command again: the runs that ended are kept. Ask for fewer at once if "
        "memory ran out.",
    )


def absent_data(absent: Sequence[str], *, known: bool) -> InputError:
    """Return the error about published stones that are not there (E100).

    >>> absent_data(["almeida/R.png", "almeida/PR.png"], known=True).where
    'almeida/R.png, almeida/PR.png'
    """
    sets = " ".join(dict.fromkeys(name.split("/")[0] for name in absent))
    why = "are not in the folder of published data" if known else "are not there"
    return InputError(
        "E100",
        f"published stones that this needs {why}.",
        where=", ".join(absent),
        cure=f"`drystone fetch {sets}` gets them; or name a folder that has them with --data or "
        "DRYSTONE_DATA.",
    )


RunWorker = Callable[[Sequence[RunSpec], Path | None], Iterator[RunOutcome]]
"""Does runs, and gives their outcomes in whatever order they end."""


def one_by_one(specs: Sequence[RunSpec], data: Path | None) -> Iterator[RunOutcome]:
    """Do runs in this process, one after the other."""
    for spec in specs:
        yield execute(spec, data)


@dataclass(frozen=True)
class Runner:
    """Does runs and keeps their outcomes."""

    store: RunStore
    data: Path | None = None  # Folder of the published data
    # Who does what is not there yet; never changes an outcome but for its times
    work: RunWorker = one_by_one
    say: Callable[[str], None] = lambda _: None  # Told of progress, a line each
    again: bool = False  # Do runs again that are kept

    def run(self, specs: Sequence[RunSpec]) -> tuple[RunOutcome, ...]:
        """Return the outcomes of runs, in their order; what ended is kept at once."""
        found = {spec.key: None if self.again else self.store.get(spec.key) for spec in specs}
        missing = {spec.key: spec for spec in specs if found[spec.key] is None}
        for count, outcome in enumerate(self.work(tuple(missing.values()), self.data), 1):
            self.store.put(outcome)
            found[outcome.key] = outcome
            self.say(f"{count} of {len(missing)} walls, {outcome.times['wall']:.1f} s")
        done = [found[spec.key] for spec in specs]
        if any(outcome is None for outcome in done):
            raise RuntimeError("runs were lost")
        return tuple(outcome for outcome in done if outcome is not None)
