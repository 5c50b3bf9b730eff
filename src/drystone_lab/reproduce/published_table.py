"""The figures that the paper prints in Table 2."""

from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType


@dataclass(frozen=True)
class Printed:
    """A half row of Table 2: F_SF (a share), F_AV and F_AH (percent), F_LR."""

    F_SF: float
    F_AV: float
    F_AH: float
    F_LR: float


REFERENCES: Mapping[int, Printed] = MappingProxyType(
    {
        1: Printed(0.837, 39.780, 0.000, 0.64), 2: Printed(0.883, 40.810, 0.830, 0.48),
        3: Printed(0.957, 22.410, 3.440, 0.26), 4: Printed(0.800, 6.765, 1.707, 0.60),
        5: Printed(0.753, 15.783, 6.767, 0.05),
    }
)  # fmt: skip
"""Reference walls by number: masons' (1 to 3) and of a model-free algorithm (4, 5)."""

CONSTRUCTED: Mapping[int, Printed] = MappingProxyType(
    {
        1: Printed(0.974, 39.084, 1.573, 0.83), 2: Printed(0.883, 36.598, 1.348, 0.83),
        3: Printed(0.839, 21.347, 4.163, 0.52), 4: Printed(0.839, 22.674, 2.207, 0.66),
        5: Printed(0.725, 55.851, 3.033, 0.59),
    }
)  # fmt: skip
"""Walls that the paper's algorithm built, the best of 20 trials."""
