"""Outcomes in a folder, so that a run that was finished once is never run again."""

import json
from pathlib import Path

from drystone.experiments.runs.outcome import Outcome
from drystone.io.atomic import write_atomically


class RunStore:
    """Outcomes as files, one a run.

    Parameters
    ----------
    folder : Path
        Made when the first outcome is kept.
    """

    def __init__(self, folder: Path) -> None:
        self.folder = folder

    def get(self, key: str) -> Outcome | None:
        """Return the outcome of a run; None when it is not there."""
        path = self._path(key)
        if not path.is_file():
            return None
        data = json.loads(path.read_text(encoding="utf-8"))
        return Outcome(key, data["figures"], data["plan"], data["times"])

    def put(self, outcome: Outcome) -> None:
        """Keep an outcome; the file is whole or not there."""
        self.folder.mkdir(parents=True, exist_ok=True)
        data = {"figures": outcome.figures, "plan": outcome.plan, "times": outcome.times}
        text = json.dumps(data, ensure_ascii=False, allow_nan=False)
        write_atomically(self._path(outcome.key), text.encode())

    def _path(self, key: str) -> Path:
        return self.folder / f"{key}.json"
