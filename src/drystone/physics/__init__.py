"""Walls in a rigid-body engine, as a check on the limit analysis that shares nothing with it."""
