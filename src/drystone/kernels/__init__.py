"""Arrays in, arrays out: the fast inner pieces, free of domain types."""
