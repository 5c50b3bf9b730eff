"""What the user may say about exports."""

from dataclasses import dataclass


@dataclass(frozen=True, kw_only=True)
class ExportSettings:
    """How drawings and films are made.

    Parameters
    ----------
    paper_scale : float
        The build sheet is drawn at 1 to this; the next usual scale where the wall does not fit.
    title : str
        In the title block; empty for the name of the stones.
    projector_px : (int, int)
        Width and height of a projector.
    projector_px_per_m : float
        Px of the projector in a metre on the wall.
    projector_offset_px : (int, int) or None
        Where the wall's lower left corner is in the projector's picture, from its lower left
        corner; None for a wall in the middle, a strip for words above the lower edge.
    seconds_per_step : float
        Of films.
    film_px : int
        Width of films, about; that of walls higher than wide is less.
    """

    paper_scale: float = 10.0
    title: str = ""
    projector_px: tuple[int, int] = (1920, 1080)
    projector_px_per_m: float = 1000.0
    projector_offset_px: tuple[int, int] | None = None
    seconds_per_step: float = 0.6
    film_px: int = 960
