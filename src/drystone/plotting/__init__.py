"""Pictures that studies need."""
