"""How a wall fails, told from its mechanism."""
