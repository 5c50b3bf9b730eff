"""A plan in the formats of robots, drawings, films and tables."""
