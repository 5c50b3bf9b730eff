"""The public benchmark: fixed walls, any method, one scorer (docs/evidence/benchmark.md)."""
