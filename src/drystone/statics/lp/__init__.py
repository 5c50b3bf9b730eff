"""The linear program of the limit analysis, what solves it, and what proves the answers."""
