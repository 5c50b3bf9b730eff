"""HiGHS without a word on standard output, where the JSON of `--json` goes."""

from collections.abc import Mapping
from typing import Any

import highspy


class _Silent(highspy.Highs):
    """HiGHS that is told to be silent before it is made ready for callbacks.

    From 1.16 on its constructor, which enables them, already prints who it is: that is too early
    for an option that is set afterwards.
    """

    def enableCallbacks(self) -> None:  # noqa: N802 - a name of highspy
        """Say no more, then do what highspy does."""
        self.setOptionValue("output_flag", False)
        super().enableCallbacks()  # type: ignore[no-untyped-call]  # it has no types


def silent_highs(options: Mapping[str, Any]) -> highspy.Highs:
    """Return HiGHS with these options, that prints nothing.

    Parameters
    ----------
    options : mapping from str to bool, int, float or str
        Options of HiGHS by name.
    """
    highs = _Silent()  # type: ignore[no-untyped-call]  # nor has its constructor
    set_options(highs, {"output_flag": False, **options})
    return highs


def set_options(highs: highspy.Highs, options: Mapping[str, Any]) -> None:
    """Set options of HiGHS by name."""
    for name, value in options.items():
        highs.setOptionValue(name, value)
