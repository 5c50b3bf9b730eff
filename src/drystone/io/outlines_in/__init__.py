"""Outlines of stones from labelling tools, drawings and meshes; a module a format."""
