"""Kernels in Cython, and what stands in for them without a compiler: one test for both."""

import pytest

from drystone.kernels.backend import compiled


def both_ways(*modules):
    """Return a fixture: all tests of a file by NumPy, then by compiled kernels."""
    fast = [compiled(module.__name__.rpartition(".")[2]) for module in modules]
    absent = pytest.mark.skipif(None in fast, reason="kernels are not compiled here")
    ways = [pytest.param(False, id="numpy"), pytest.param(True, id="compiled", marks=absent)]

    @pytest.fixture(autouse=True, scope="module", params=ways)
    def kernel(request):
        with pytest.MonkeyPatch.context() as patch:
            for module, kernels in zip(modules, fast, strict=True):
                patch.setattr(module, "_fast", kernels if request.param else None)
            yield

    return kernel
