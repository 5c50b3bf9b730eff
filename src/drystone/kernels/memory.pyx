# cython: language_level=3
"""What of :mod:`drystone.kernels.memory` is not in its ``.pxd``."""

from cpython.buffer cimport PyBUF_FORMAT, PyBuffer_Release, PyObject_GetBuffer
from cpython.bytearray cimport PyByteArray_AS_STRING
from libc.stdlib cimport realloc


cdef void *start(object array, const char *kinds, Py_ssize_t size, int access) except? NULL:
    """Return where the numbers of an array begin; TypeError when they are of another kind."""
    cdef Py_buffer view
    cdef void *at
    cdef Py_ssize_t i = 0
    PyObject_GetBuffer(array, &view, PyBUF_FORMAT | access)
    at = view.buf
    while kinds[i] != 0 and kinds[i] != view.format[0]:
        i += 1
    if kinds[i] == 0 or view.itemsize != size:
        found = (<bytes>view.format).decode()
        PyBuffer_Release(&view)
        raise TypeError(f"a kernel got numbers of kind {found!r}, not {kinds.decode()!r}")
    PyBuffer_Release(&view)
    return at


cdef void *resized(void *at, Py_ssize_t size) except? NULL nogil:
    cdef void *more = realloc(at, size)
    if more == NULL:
        with gil:
            raise MemoryError
    return more


cdef char *kept(list room, Py_ssize_t size):
    zeros = bytearray(size)
    room.append(zeros)
    return PyByteArray_AS_STRING(zeros)
