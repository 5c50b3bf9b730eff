"""What experiments are made of: plans, one each, that can be run anywhere, kept and found again."""
