"""The indices of an action, one a file (§3.5; DESIGN 4.5)."""
