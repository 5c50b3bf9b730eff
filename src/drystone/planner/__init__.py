"""Algorithm 1: the wall, stone by stone."""
