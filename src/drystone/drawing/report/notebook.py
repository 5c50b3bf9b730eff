"""Walls in notebooks."""

from dataclasses import dataclass, field
from pathlib import Path

from drystone.drawing.assembly.read import read_assembly
from drystone.drawing.report.html import viewer_frame, viewer_page
from drystone.drawing.report.viewer_data import ViewerData, view_of_assembly, view_of_result
from drystone.search.plan_result import PlanResult
from drystone.whole_files import write_whole


@dataclass(frozen=True)
class Shown:
    """A wall that shows itself at the end of a notebook's cell.

    Parameters
    ----------
    data : dict
        Plain JSON of the schema "drystone-view/1".
    """

    data: ViewerData = field(repr=False)

    def _repr_html_(self) -> str:
        return viewer_frame(self.data)

    def write(self, path: str | Path) -> Path:
        """Write the viewer as one HTML file that needs no network and no other file."""
        path = Path(path)
        write_whole(path, viewer_page(self.data).encode("utf-8", "replace"))
        return path


def view(wall: PlanResult | str | Path) -> Shown:
    """Show a plan: a result of planning, or the files of an earlier one.

    Parameters
    ----------
    wall : PlanResult, str or Path
        From :func:`drystone.plan_wall`, or a plan.json or its folder.

    Raises
    ------
    InputError
        E132, E133 for files that are no plan or do not belong together.
    """
    if isinstance(wall, PlanResult):
        return Shown(view_of_result(wall))
    return Shown(view_of_assembly(read_assembly(wall)))
