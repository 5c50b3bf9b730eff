"""The names of the files that make a plan's folder."""

WRITTEN = ("plan.json", "settings.toml", "blocks.json", "wall.png", "wall.tif")
"""What is written with a plan, or taken out because it would belong to another wall."""

DRAWN = ("report.html", "picture.png", "mechanism_left.png", "mechanism_right.png")
"""What `drystone plan` draws of it."""
