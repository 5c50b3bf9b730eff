"""The build sheet: what a mason needs on the scaffold, on A4."""
