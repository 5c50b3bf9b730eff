"""How badly the stones of a wall are bonded, in one number that a search can lower."""

from drystone.craft import cross_joints, laps, one_over_two
from drystone.craft.masonry import Masonry


def bond_faults(masonry: Masonry) -> float:
    """Count the faults against the four rules of bond, for each stone of a wall.

    Parameters
    ----------
    masonry : Masonry
        Any wall.

    Returns
    -------
    float
        0 for a sound bond, about 2 for a stack bond.  The sum, over the number of stones, of

        * the courses that upright joints go through beyond the first (running joints),
        * the points at which four stones meet (cross joints),
        * the stones above the foot and between the ends that rest on one stone only (one over
          two),
        * what laps over joints fall short of a quarter of the stone's width, over this quarter.

    Examples
    --------
    >>> import numpy as np
    >>> brick = np.array([[0, 0], [2, 0], [2, 1], [0, 1]])
    >>> stack = {3 * y + x: brick + [2 * x, y] for x in range(3) for y in range(3)}
    >>> round(bond_faults(Masonry(stack)), 2)
    1.11
    >>> bond = [brick, brick + [2, 0], brick + [1, 1]]
    >>> bond_faults(Masonry(dict(enumerate(bond))))
    0.0
    """
    stones = len(masonry.stones)
    if not stones:
        return 0.0
    running = sum(chain.courses - 1 for chain in masonry.chains)
    crosses = len(cross_joints.find(masonry).cases)
    single = len(one_over_two.find(masonry).cases)
    quarter = masonry.settings.lap
    short = sum(1.0 - lap.value / quarter for lap in laps.find(masonry).cases)
    return (running + crosses + single + short) / stones
