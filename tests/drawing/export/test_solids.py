"""Prisms of outlines against trimesh and shapely."""

import numpy as np
import pytest
import shapely
import trimesh

from drystone.drawing.export import solids
from drystone.errors import InputError

OUTLINES = {
    "triangle": [(0, 0), (1, 0), (0, 1)],
    "collinear corners": [(0, 0), (1, 0), (2, 0), (2, 1), (2, 2), (1, 2), (0, 2), (0, 1)],
    "hollow": [(0, 0), (4, 0), (4, 3), (2, 0.5), (0, 3)],
    "comb": [(0, 0), (5, 0), (5, 3), (4, 3), (4, 1), (3, 1), (3, 3), (2, 3), (2, 1), (1, 1), (1, 3),
             (0, 3)],
}  # fmt: skip


@pytest.mark.parametrize("name", OUTLINES)
def test_a_prism_is_closed_and_faces_outward(name):
    outline = np.array(OUTLINES[name], float)
    solid = solids.extruded(outline, -1.0, 2.0)
    mesh = trimesh.Trimesh(solid.vertices, solid.triangles, process=False)
    assert mesh.is_watertight
    assert mesh.is_winding_consistent
    assert len(solid.triangles) == 4 * len(outline) - 4
    # Inside out, the volume would be negative.
    assert mesh.volume == pytest.approx(3.0 * shapely.Polygon(outline).area, rel=1e-12)
    assert mesh.face_normals == pytest.approx(solid.normals, abs=1e-12)
    front = solid.vertices[solid.triangles][:, :, 1].max(axis=1) == -1.0
    assert solid.normals[front].tolist() == [[0.0, -1.0, 0.0]] * (len(outline) - 2)


@pytest.mark.parametrize(
    "corners",
    [
        [(0, 0), (2, 2), (2, 0), (0, 2)],
        [(0, 0), (2, 0), (1, 1), (2, 2), (0, 2), (1, 1)],
        [(0, 0), (1, 0), (2, 0)],
    ],
    ids=["crosses itself", "touches itself", "flat"],
)
def test_an_outline_that_bounds_no_solid_is_refused(corners):
    with pytest.raises(InputError, match=r"E180 .*stone_012"):
        solids.extruded(np.array(corners, float), 0.0, 1.0, "stone_012")


def test_second_moments_of_a_shifted_and_turned_box():
    # By the parallel axis theorem.
    box = np.array([[-1.0, -2.0], [1.0, -2.0], [1.0, 2.0], [-1.0, 2.0]])
    xx, zz, xz = solids.second_moments(box + np.array([3.0, 5.0]))
    assert (xx, zz, xz) == pytest.approx((8 / 3 + 8 * 9, 32 / 3 + 8 * 25, 8 * 15))
    turn = np.array([[0.6, 0.8], [-0.8, 0.6]])
    xx, zz, xz = solids.second_moments(box @ turn)
    main = turn.T @ np.diag([8 / 3, 32 / 3]) @ turn
    assert (xx, zz, xz) == pytest.approx((main[0, 0], main[1, 1], main[0, 1]))
