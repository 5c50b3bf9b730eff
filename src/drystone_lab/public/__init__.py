"""The public benchmark: fixed walls, any method, one scorer (docs/benchmark.md)."""
