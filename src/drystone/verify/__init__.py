"""Re-derive walls from the input stones and plans alone, and verify what plans claim."""
