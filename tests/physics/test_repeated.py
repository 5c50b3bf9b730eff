"""Several runs of one wall, and the one in the middle."""

from dataclasses import replace

import pytest

from drystone.physics.building import BuildUp, build_up
from drystone.physics.repeated import RADII, Repeated, build_up_repeatedly
from tests.physics.test_building import COURSES, single

pytest.importorskip("pymunk", reason="the engine is an extra")


def test_every_run_has_its_own_radius_and_all_are_told_of() -> None:
    told: list[int] = []
    found = build_up_repeatedly(COURSES, on_group=told.append)
    assert told == list(range(1, len(RADII) * len(COURSES) + 1))
    assert [run.stands for run in found.runs] == [True] * len(RADII)
    assert found.falls_in == 0
    moves = {tuple(move.move_px for move in run.moves) for run in found.runs}
    assert len(moves) > 1


def test_what_overhangs_falls_in_every_run() -> None:
    found = build_up_repeatedly(single((0, 0, 40, 20), (30, 20, 40, 20)))
    assert found.falls_in == len(RADII)
    assert found.typical.fallen == (2,)


def _runs(*fallen: int) -> Repeated:
    stands = build_up(single((0, 0, 40, 20), (0, 20, 40, 20), (0, 40, 40, 20)))

    def with_fallen(count: int) -> BuildUp:
        moves = tuple(replace(m, fell=i < count) for i, m in enumerate(stands.moves))
        return replace(stands, moves=moves)

    return Repeated(tuple(with_fallen(count) for count in fallen))


@pytest.mark.parametrize(
    ("fallen", "typical", "falls_in"), [((0, 3, 0), 0, 1), ((2, 0, 1), 1, 2), ((1, 3, 2), 2, 3)]
)
def test_the_run_in_the_middle_counts(
    fallen: tuple[int, int, int], typical: int, falls_in: int
) -> None:
    found = _runs(*fallen)
    assert len(found.typical.fallen) == typical
    assert found.falls_in == falls_in
