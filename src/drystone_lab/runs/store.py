"""Outcomes in a folder, so that a run that was finished once is never run again."""

import json
from pathlib import Path
from typing import Any

from drystone.errors import InputError
from drystone.whole_files import write_whole
from drystone_lab.runs.outcome import FIGURES, Outcome


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
        """Return the outcome of a run; None when it is not there.

        Raises
        ------
        InputError
            E401: its file is no outcome; it was cut short or changed.
        """
        path = self._path(key)
        try:
            return _outcome(key, json.loads(path.read_text(encoding="utf-8")))
        except FileNotFoundError:
            return None
        except (ValueError, TypeError, KeyError) as error:
            raise InputError(
                "E401",
                "the outcome of a run that is kept here is damaged.",
                where=str(path),
                cure="Delete the file: its run is then done again.",
            ) from error

    def put(self, outcome: Outcome) -> None:
        """Keep an outcome; the file is whole or not there."""
        self.folder.mkdir(parents=True, exist_ok=True)
        data = {"figures": outcome.figures, "plan": outcome.plan, "times": outcome.times}
        text = json.dumps(data, ensure_ascii=False, allow_nan=False)
        write_whole(self._path(outcome.key), text.encode())

    def _path(self, key: str) -> Path:
        return self.folder / f"{key}.json"


def _outcome(key: str, data: Any) -> Outcome:
    """Return what a file holds; anything else is one of the errors of plain Python."""
    figures, plan, times = (dict(data[name]) for name in ("figures", "plan", "times"))
    if not {"wall"} <= times.keys() or not set(FIGURES) <= figures.keys() or "steps" not in plan:
        raise KeyError(key)
    return Outcome(key, figures, plan, times)
