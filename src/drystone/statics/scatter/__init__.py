"""How far a load multiplier is off when a wall is not known exactly."""
