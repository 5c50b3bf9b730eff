"""How much of the wall is stone (Eq. 25)."""


def filling(stone_area_px: float, wall_px: tuple[float, float]) -> float:
    """Return F_SF, the area of the stones over the area of the wall (Eq. 25).

    Parameters
    ----------
    stone_area_px : float
        Of the placed stones, without wedges, in px of the working resolution.  For plans the
        areas at the source resolution times scale squared: nearest sampling changes a mask by up
        to 3.5 %, and a search would pick the larger ones.
    wall_px : (float, float)
        Width and height of the wall in the same px, positive.

    Returns
    -------
    F_SF : float
        0 to 1, more only when stones overlap or leave the wall.

    Examples
    --------
    >>> filling(120, (20, 10))
    0.6
    """
    width, height = wall_px
    return stone_area_px / (width * height)
