"""Outcomes with figures that a test chooses."""

from drystone_lab.runs.outcome import FIGURES, RunOutcome


def outcome(key="", **figures):
    """An outcome of 10 stones with everything else 1, but for the figures that are named."""
    return RunOutcome(
        key, {**dict.fromkeys(FIGURES, 1), "stones": 10, **figures}, {"steps": []}, {}
    )
