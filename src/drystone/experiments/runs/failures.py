"""Errors of runs that could not be done; what had ended before is kept."""

from drystone.errors import DrystoneError
from drystone.experiments.runs.spec import RunSpec


def died(spec: RunSpec, who: str) -> DrystoneError:
    """Return E402: who did a run died at it.

    Parameters
    ----------
    spec : RunSpec
        The run.
    who : str
        What did it, without an article.
    """
    return DrystoneError(
        "E402",
        f"the {who} that did this run died, for want of memory for example.",
        where=str(spec),
        cure="Give the same command again: the runs that ended are kept. Ask for fewer at once if "
        "memory ran out.",
    )
