"""Lines across a wall."""

import numpy as np
import pytest
import shapely

from drystone.craft.joints import scan


@pytest.mark.parametrize("axis", [0, 1])
def test_runs_are_what_the_lines_have_of_the_outlines(axis):
    angles = np.linspace(0.0, 2.0 * np.pi, 60, endpoint=False)
    for seed in range(5):
        radii = np.random.default_rng(seed).uniform(0.3, 3.0, (60, 1))
        star = radii * np.column_stack([np.cos(angles), np.sin(angles)])
        outlines = {4: star, 7: star + np.array([5.0, 1.0])}
        found = scan(outlines, axis, 0.07)
        for place, runs in zip(found.places.tolist(), found.runs, strict=True):
            for block, loop in outlines.items():
                ends = np.array([[-9.0, place], [99.0, place]])[:, :: 1 - 2 * axis]
                cut = shapely.intersection(shapely.Polygon(loop), shapely.LineString(ends))
                pieces = [np.sort(part.xy[axis]) for part in shapely.get_parts(cut)]
                mine = [(run.begin, run.end) for run in runs if run.id == block]
                np.testing.assert_allclose(
                    np.reshape(mine, (-1, 2)), np.reshape(sorted(map(tuple, pieces)), (-1, 2)),
                    atol=1e-9,
                )  # fmt: skip
