"""Studies that show how good the numbers are: their data, their measures, their tables."""
