"""What a wall looks like to a reader: one HTML file that needs nothing else, and its viewer."""

from drystone.report.from_result import view_of_result
from drystone.report.html import write_report
from drystone.report.viewer_data import view_of_assembly, view_of_wall

__all__ = ["view_of_assembly", "view_of_result", "view_of_wall", "write_report"]
