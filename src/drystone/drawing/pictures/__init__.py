"""Pictures with axes, drawn by Matplotlib: ``plot_x(thing, ax=None) -> Axes``."""
