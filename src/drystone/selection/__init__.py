"""Which stones are tried, and which of them is placed (§3.4, §3.8)."""
