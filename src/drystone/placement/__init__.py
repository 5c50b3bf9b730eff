"""Where a stone can stand, and where it stands best (§3.6)."""
