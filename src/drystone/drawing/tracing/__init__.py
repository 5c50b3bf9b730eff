"""The page on which a person corrects or draws outlines over a photograph."""
