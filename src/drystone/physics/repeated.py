"""Walls built up several times: an engine is no instrument without scatter."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

from drystone.physics.building import BuildSettings, BuildUp, Group, build_up

RADII = (0.002, 0.003, 0.006)
"""How far corners are rounded in each run, in mean block sizes.

The faces of stones stay where they are, so the runs are of one wall; but where faces with steps
meet, a contact that the engine misreads in one run throws a stone in that run alone.
"""


@dataclass(frozen=True, eq=False)
class Repeated:
    """Several runs of one wall.

    Parameters
    ----------
    runs : tuple of BuildUp
        With corners rounded by `RADII`.
    """

    runs: tuple[BuildUp, ...]

    @property
    def typical(self) -> BuildUp:
        """The run in the middle, by how many blocks fall and how far the furthest moves."""

        def rank(run: BuildUp) -> tuple[int, float]:
            return len(run.fallen), max((move.share for move in run.moves), default=0.0)

        return sorted(self.runs, key=rank)[len(self.runs) // 2]

    @property
    def falls_in(self) -> int:
        """In how many runs something falls."""
        return sum(not run.stands for run in self.runs)


def build_up_repeatedly(
    groups: Sequence[Group],
    mu: float = 0.58,
    settings: BuildSettings | None = None,
    on_group: Callable[[int], object] | None = None,
) -> Repeated:
    """Build a wall up with corners rounded by different amounts.

    Parameters
    ----------
    groups, mu, settings
        As for :func:`drystone.physics.building.build_up`.
    on_group : callable, optional
        Told the number of groups placed in all runs so far, after each.

    Returns
    -------
    Repeated
        Same input, same result.

    Raises
    ------
    InputError, UsageError
        As :func:`drystone.physics.building.build_up`.

    Examples
    --------
    >>> import numpy as np
    >>> block = np.array([[0, 0], [40, 0], [40, 20], [0, 20]])
    >>> build_up_repeatedly([[(1, block)], [(2, block + [0, 20])]]).falls_in
    0
    """
    settings = settings or BuildSettings()
    runs: list[BuildUp] = []
    for radius in RADII:
        done = len(runs) * len(groups)
        engine = replace(settings.engine, corner_radius=radius)

        def told(number: int, done: int = done) -> None:
            if on_group is not None:
                on_group(done + number)

        runs.append(build_up(groups, mu, replace(settings, engine=engine), on_group=told))
    return Repeated(tuple(runs))
