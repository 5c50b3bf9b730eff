# cython: language_level=3, boundscheck=False, wraparound=False, cdivision=True, initializedcheck=False
"""What the compiled kernels of courses share: stones, wall and rules; and room for courses."""

from libc.stdint cimport int32_t, int64_t
from libc.stdlib cimport calloc, free, malloc

import numpy as np

from drystone.kernels.compiled.course_paths cimport STARTS, path_starts


cdef int fill_scene(Scene *scene, poses, ground, rules, const double[::1] weights) except -1:
    """Point to the arrays of poses, and make room for what is worked out."""
    cdef const int64_t[::1] first = poses.first, first_row = poses.first_row, area = poses.area
    cdef const int32_t[::1] bottoms = poses.bottoms, tops = poses.tops
    cdef const int32_t[::1] lefts = poses.lefts, rights = poses.rights
    cdef const int32_t[::1] width = poses.width, middle = poses.middle
    cdef const int32_t[:, ::1] peaks = poses.peaks, part_at = poses.part_at, faces = poses.faces
    cdef const int32_t[:, ::1] beds = ground.beds
    scene.first, scene.first_row, scene.area = &first[0], &first_row[0], &area[0]
    scene.bottoms, scene.tops = &bottoms[0], &tops[0]
    scene.lefts, scene.rights = &lefts[0], &rights[0]
    scene.width, scene.middle = &width[0], &middle[0]
    scene.peaks, scene.part_at, scene.faces = &peaks[0, 0], &part_at[0, 0], &faces[0, 0]
    scene.weights = &weights[0]
    scene.stones = area.shape[0]
    scene.columns = ground.tops.shape[0]
    scene.wall_width, scene.wall_height = ground.width, ground.height
    scene.reach, scene.margin, scene.steepest = rules.reach, rules.margin, rules.steepest
    scene.joint = rules.joint
    scene.target, scene.beds, scene.bed_count = rules.target, &beds[0, 0], beds.shape[0]
    scene.start_count = path_starts(scene.wall_width, scene.starts)
    scene.lift = <int32_t *> malloc(scene.columns * sizeof(int32_t))
    if scene.lift == NULL:
        raise MemoryError
    return 0


cdef void free_scene(Scene *scene) noexcept nogil:
    """Give back what :func:`fill_scene` took."""
    free(scene.lift)


cdef double weighted(const Scene *scene, const double *terms) noexcept nogil:
    """Return the sum of terms times their weights, one after the other."""
    cdef Py_ssize_t i
    cdef double cost = 0.0
    for i in range(TERMS):
        cost += terms[i] * scene.weights[i]
    return cost


cdef class Layers:
    """Room for courses, each on the one before, the first on the ground; and to list courses."""

    def __cinit__(self, ground, Py_ssize_t count, Py_ssize_t stones):
        cdef Py_ssize_t i, columns = ground.tops.shape[0], given = ground.joints.shape[0]
        cdef Py_ssize_t most = max(stones + 1, given)
        self.courses = <Course *> calloc(count + 1, sizeof(Course))
        self.seen = <const Course **> calloc(count, sizeof(Course *))
        self.lain = <Lain *> calloc((count + 1) * stones, sizeof(Lain))
        if self.courses == NULL or self.seen == NULL or self.lain == NULL:
            raise MemoryError
        self.tops = np.zeros((count + 1, columns), np.int32)
        self.joints = np.zeros((count + 1, most, 2), np.int32)
        self.ways = np.zeros((count + 1, most, STARTS), np.int32)
        np.asarray(self.tops)[0] = ground.tops
        np.asarray(self.joints)[0, :given] = ground.joints
        np.asarray(self.ways)[0, :given] = ground.ways
        for i in range(count + 1):
            self.courses[i].tops = &self.tops[i, 0]
            self.courses[i].joints = &self.joints[i, 0, 0]
            self.courses[i].ways = &self.ways[i, 0, 0]
            self.courses[i].lain = self.lain + i * stones
        self.courses[0].joint_count = given

    def __dealloc__(self):
        free(self.courses)
        free(self.seen)
        free(self.lain)

    cpdef tuple last(self, Py_ssize_t course):
        """Return the profile and the joints of a course."""
        cdef Py_ssize_t count = self.courses[course].joint_count
        tops, joints = np.asarray(self.tops)[course], np.asarray(self.joints)[course, :count]
        return tops.copy(), joints.copy()
