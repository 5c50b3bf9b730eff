"""What a wall looks like to a reader: one HTML file that needs nothing else, and its viewer."""
