"""What is said of results, for people and as JSON, in notebooks as on the command line."""
