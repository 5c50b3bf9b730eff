"""What a wall looks like to a reader: one HTML file that needs nothing else, and its viewer."""

from drystone.drawing.report.from_result import view_of_result
from drystone.drawing.report.html import write_report
from drystone.drawing.report.viewer_data import view_of_assembly, view_of_wall

__all__ = ["view_of_assembly", "view_of_result", "view_of_wall", "write_report"]
