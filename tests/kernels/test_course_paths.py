"""Paths along planned joints, against what is measured on pixels."""

import numpy as np
import pytest

from drystone.kernels import course_paths
from drystone.kernels.course_paths import (
    STARTS,
    bed_percent,
    crossing_percent,
    mean_percent,
    path_starts,
    ways_up,
)
from drystone.kernels.course_types import PIXEL_UNITS
from drystone.metrics import joints as metric_joints
from drystone.metrics import measure, paths
from drystone.model.wall import Labels


def bond(shift_px: int, courses: int) -> Labels:
    """Bricks of 60 x 20 px, each course shifted against that below."""
    labels = np.zeros((20 * courses, 300), np.uint32)
    for course in range(courses):
        x = np.arange(300) + (course % 2) * shift_px
        labels[20 * course : 20 * course + 20] = 1 + x // 60 + 10 * course
    return labels


def planned(shift_px: int, courses: int) -> tuple[float, float]:
    """F_AV and F_AH of the same bricks, by their joints."""
    starts = path_starts(300 * PIXEL_UNITS)
    joints: list[tuple[int, int]] = []
    ways = np.zeros((0, STARTS), np.int32)
    for course in range(courses):
        below = joints
        shift = (course % 2) * shift_px
        inner = [x for x in range(60 - shift, 300, 60) if x > 0]
        joints = [(x * PIXEL_UNITS,) * 2 for x in (0, *inner, 300)]
        ways = ways_up(joints, below, ways, starts)
    top = 20 * courses * PIXEL_UNITS
    beds = [(20 * i * PIXEL_UNITS, 20 * i * PIXEL_UNITS, 0) for i in range(1, courses + 1)]
    return (
        crossing_percent(joints, ways, starts, top),
        bed_percent(beds, top, 300 * PIXEL_UNITS),
    )


@pytest.mark.parametrize("courses", [3, 4, 5])
def test_bricks_are_judged_as_on_pixels(courses: int) -> None:
    found = {}
    for shift in (0, 10, 20, 30):
        across, along = planned(shift, courses)
        measured = measure.measure_labels(bond(shift, courses))
        assert measured.F_AV is not None
        assert measured.F_AH is not None
        # Joints are two px wide on pixels: corners are cut.
        cut = 100 * 4 * courses / (20 * courses)
        assert measured.F_AV - 1 <= across <= measured.F_AV + cut
        assert measured.F_AH - 0.1 <= along <= measured.F_AH + 1.5
        found[shift] = across
    assert found[0] < found[10] < found[20] < found[30]


def test_ups_and_downs_and_distance_make_a_bed_joint_longer() -> None:
    width, top = 300 * PIXEL_UNITS, 100 * PIXEL_UNITS
    heights = [top - start for start in path_starts(top)]
    straight = width + 2 * PIXEL_UNITS
    flat = [(y, y, 0) for y in heights]
    assert bed_percent(flat, top, width) == 0.0
    rough = [(y, y, 256) for y in heights]
    assert bed_percent(rough, top, width) == pytest.approx(100 * 106 / straight)
    aside = [(y + 50, y - 70, 0) for y in heights]
    assert bed_percent(aside, top, width) == pytest.approx(100 * 120 / straight)


def test_paths_also_run_along_the_ground_and_over_the_top() -> None:
    width, top = 300 * PIXEL_UNITS, 100 * PIXEL_UNITS
    half = PIXEL_UNITS // 2
    ways = sorted(2 * (min(start, top - start) + half) for start in path_starts(top))
    straight = width + 2 * PIXEL_UNITS
    assert bed_percent([], top, width) == pytest.approx(100 * sum(ways[:5]) / (5 * straight))


def test_the_definitions_are_those_of_the_metrics() -> None:
    assert course_paths.FIRST_PX == paths.FIRST_PX
    assert course_paths.STARTS == paths.STARTS
    assert metric_joints.PAD_TOP + metric_joints.PAD_BOTTOM == course_paths.PADDING_PX
    assert metric_joints.PAD_LEFT + metric_joints.PAD_RIGHT == course_paths.PADDING_PX


def test_there_are_never_more_starts_than_room_for_them() -> None:
    assert max(len(path_starts(side * PIXEL_UNITS)) for side in range(3000)) == STARTS
    assert path_starts(17 * PIXEL_UNITS) == []
    assert mean_percent([], 10) == 0.0
    assert mean_percent([7, 1, 2, 3, 4, 5], 100) == pytest.approx(3.0)
