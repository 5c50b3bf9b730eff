"""Errors of runs that could not be done; what had ended before is kept."""

from collections.abc import Sequence

from drystone.errors import DrystoneError, InputError
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

    Examples
    --------
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
