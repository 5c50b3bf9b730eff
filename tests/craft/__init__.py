"""Tests of the masons' rules."""
