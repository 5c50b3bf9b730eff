"""Figures of merit of any wall, ours or a mason's, from its image of labels (§5.2)."""
