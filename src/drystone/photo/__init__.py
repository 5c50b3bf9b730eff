"""Stones in photographs: markers and scale, and which px are stone."""
