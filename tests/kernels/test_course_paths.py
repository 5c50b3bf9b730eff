"""Paths along planned joints, against what is measured on pixels."""

import numpy as np
import pytest

from drystone.kernels import course_types
from drystone.kernels.course_types import PIXEL_UNITS, STARTS, Arrangement, Ground, Rules, Weights
from drystone.kernels.courses import evaluate, path_starts
from drystone.kernels.raster import turn
from drystone.metrics import measure, paths
from drystone.metrics import paths as metric_paths
from drystone.search.course_task import poses_of

RULES = Rules(Weights(*[1.0] * 17), 32, 0.0, 0, 0, 9, 1000.0)
COLUMN_PX = 0.5


def bond(shift_px, courses):
    """Bricks of 60 x 20 px, each course shifted against that below."""
    labels = np.zeros((20 * courses, 300), np.uint32)
    for course in range(courses):
        x = np.arange(300) + (course % 2) * shift_px
        labels[20 * course : 20 * course + 20] = 1 + x // 60 + 10 * course
    return labels


def laid(rows, height_px, beds=()):
    """F_AV and F_AH of courses of bricks, given by their widths, on nothing but bed joints."""
    widths = [width for row in rows for width in row]
    corners = [
        turn(np.array([(0, 0), (width, 0), (width, height_px), (0, height_px)], float), quarter)
        for width in widths
        for quarter in (0, 90, 180, 270)
    ]
    poses = poses_of(corners, np.array(widths, float) * height_px, COLUMN_PX)
    sizes = np.array([len(row) for row in rows], np.int32)
    numbers = np.arange(len(widths), dtype=np.int32)
    side = sum(rows[0]) * PIXEL_UNITS
    nothing = (np.zeros((0, size), np.int32) for size in (2, STARTS))
    over = np.array(beds, np.int32).reshape(-1, 3)
    ground = Ground(np.zeros(2 * sum(rows[0]), np.int32), *nothing, over, side, side)
    terms = evaluate(poses, Arrangement(numbers, 0 * numbers, sizes, sizes), ground, RULES).terms
    return RULES.target - float(terms[-1, 16]), float(terms[-1, 15])


@pytest.mark.parametrize("courses", [3, 4, 5])
def test_bricks_are_judged_as_on_pixels(courses):
    found = {}
    for shift in (0, 10, 20, 30):
        shifted = [60 - shift, 60, 60, 60, 60, shift] if shift else [60] * 5
        across, along = laid([shifted if i % 2 else [60] * 5 for i in range(courses)], 20)
        measured = measure.measure_labels(bond(shift, courses))
        assert measured.F_AV is not None
        assert measured.F_AH is not None
        # Joints are two px wide on pixels: corners are cut.
        cut = 100 * 4 * courses / (20 * courses)
        assert measured.F_AV - 1 <= across <= measured.F_AV + cut
        assert measured.F_AH - 0.1 <= along <= measured.F_AH + 1.5
        found[shift] = across
    assert found[0] < found[10] < found[20] < found[30]


def test_ups_and_downs_and_distance_make_a_bed_joint_longer():
    top = 100 * PIXEL_UNITS
    heights = [top - start for start in path_starts(top)]
    straight = 302 * PIXEL_UNITS
    for aside, ups, longer in ((0, 0, 0), (0, 256, 106), (60, 0, 120)):
        beds = [(y + aside, y - aside, ups) for y in heights]
        assert laid([[300]], 100, beds)[1] == pytest.approx(100 * longer / straight)


def test_paths_also_run_along_the_ground_and_over_the_top():
    top, half = 100 * PIXEL_UNITS, PIXEL_UNITS // 2
    # The wall's own top is a bed joint too.
    ways = sorted(2 * min(start, top - start + half) for start in path_starts(top))
    straight = 302 * PIXEL_UNITS
    assert laid([[300]], 100)[1] == pytest.approx(100 * sum(ways[:5]) / (5 * straight))


def test_the_definitions_are_those_of_the_metrics():
    assert course_types.FIRST_PX == paths.FIRST_PX
    assert course_types.STARTS == paths.STARTS
    assert metric_paths.PAD_TOP + metric_paths.PAD_BOTTOM == course_types.PADDING_PX
    assert metric_paths.PAD_LEFT + metric_paths.PAD_RIGHT == course_types.PADDING_PX


def test_there_are_never_more_starts_than_room_for_them():
    # One more would be thrown away.
    for side in range(3000):
        rest = side + course_types.PADDING_PX - course_types.FIRST_PX
        starts = path_starts(side * PIXEL_UNITS)
        step = max(1, (side + course_types.PADDING_PX) // STARTS)
        assert len(starts) == len(range(course_types.FIRST_PX, rest, step)) <= STARTS
    assert path_starts(17 * PIXEL_UNITS) == []
