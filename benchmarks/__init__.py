"""Times of the package beside slow twins, in one run: ``python -m benchmarks``."""
