"""What the planner talks about: stones, poses, placements, wedges, walls and plans."""
