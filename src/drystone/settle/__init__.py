"""Exact settling: stones come to rest on the outlines of others (DESIGN 4.9)."""
