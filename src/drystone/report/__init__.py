"""The report of a plan: one HTML file that needs nothing else."""

from drystone.report.html import write_report

__all__ = ["write_report"]
