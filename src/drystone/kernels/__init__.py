"""Arrays in, arrays out: raster, outlines, courses, linear programs."""

from drystone.kernels.backend import take_sources

take_sources(__path__[0])
