"""How often the solver had trouble with candidates."""

from dataclasses import dataclass


@dataclass(frozen=True)
class Solves:
    """How often the solver had trouble with a candidate while walls were built."""

    failed: int = 0  # it gave up, and the candidate was passed over
    cold: int = 0  # it had to start anew, which costs time alone

    def __add__(self, other: "Solves") -> "Solves":
        """Add up."""
        return Solves(self.failed + other.failed, self.cold + other.cold)

    def __sub__(self, other: "Solves") -> "Solves":
        """Return the trouble since then."""
        return Solves(self.failed - other.failed, self.cold - other.cold)
