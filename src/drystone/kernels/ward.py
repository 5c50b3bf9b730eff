"""Ward clusters of very many points in the plane, without the distances of all pairs."""

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import KDTree

NEIGHBOURS = 8
"""How many centres around each are looked at first."""

BLOCK = 1 << 20
"""Neighbours that are compared at once."""

_SLACK = 1e-9
_NOT_KNOWN, _NONE = -2, -1

_Floats = NDArray[np.float64]
_Places = NDArray[np.intp]


def ward_clusters(points: _Floats, distance: float) -> _Places:
    """Return the flat clusters of Ward's linkage at a distance.

    Parameters
    ----------
    points : (n, 2) float array
        At least one.
    distance : float
        Above which clusters stay apart, positive; as SciPy counts it: clusters of a and b points
        are sqrt(2 a b / (a + b)) times as far apart as their centres.

    Returns
    -------
    clusters : (n,) int array
        Numbered from 0 in the order of their first points.

    Notes
    -----
    Two clusters that are the nearest to each other will be joined sooner or later, and joining
    them brings them nearer to no other; so all such pairs within the distance are joined at once,
    round after round (Murtagh 1983), and a cluster keeps its nearest until that is joined to
    another.  Of several at one distance the first is the nearest.  Memory grows as n.

    Examples
    --------
    >>> ward_clusters(np.array([[0.0, 0.0], [0.9, 0.0], [0.0, 0.1]]), 0.2).tolist()
    [0, 1, 0]
    """
    centre, weight, cluster = _different(points)
    nearest = np.full(len(centre), _NOT_KNOWN)
    while True:
        asked = np.flatnonzero(nearest == _NOT_KNOWN)
        nearest[asked] = _nearest(centre, weight, asked, nearest != _NONE, distance**2 / 2)
        one = np.flatnonzero(nearest >= 0)
        if not one.size:
            return cluster
        one = one[(nearest[nearest[one]] == one) & (one < nearest[one])]
        if not one.size:
            # A circle: a joined cluster is nearer by a rounding error.  Looked at anew, there is
            # always a pair, the first of those at the least distance.
            nearest[nearest != _NONE] = _NOT_KNOWN
            continue
        other = nearest[one]
        share = (weight[other] / (weight[one] + weight[other]))[:, None]
        centre[one] += share * (centre[other] - centre[one])
        weight[one] += weight[other]
        changed = np.zeros(len(centre), bool)
        changed[one] = changed[other] = True
        nearest[(nearest >= 0) & changed[nearest]] = _NOT_KNOWN
        stays = np.ones(len(centre), bool)
        stays[other] = False
        number = np.cumsum(stays) - 1
        number[other] = number[one]
        centre, weight, cluster = centre[stays], weight[stays], number[cluster]
        nearest = np.where(nearest >= 0, number[nearest], nearest)[stays]


def _different(points: _Floats) -> tuple[_Floats, _Floats, _Places]:
    """Join equal points, which have no distance: centres, weights, and the cluster of each."""
    values, first, inverse, count = np.unique(
        points, axis=0, return_index=True, return_inverse=True, return_counts=True
    )
    order = np.argsort(first)
    rank = np.empty_like(order)
    rank[order] = np.arange(len(order))
    return values[order], count[order].astype(float), rank[inverse.ravel()]


def _nearest(
    centre: _Floats, weight: _Floats, asked: _Places, counts: NDArray[np.bool_], limit: float
) -> _Places:
    """Return which cluster is nearest to each that is asked for; -1 when none is within a limit.

    Parameters
    ----------
    centre, weight : (m, 2) and (m,) float arrays
        Of all clusters.
    asked : (n,) int array
        The clusters in question.
    counts : (m,) bool array
        Which clusters are looked at.
    limit : float
        For a b / (a + b) times the square of the distance of the centres.
    """
    places = np.flatnonzero(counts)
    found = np.full(len(asked), _NONE)
    if len(places) < 2:
        return found
    tree = KDTree(centre[places])
    lightest = weight[places].min()
    left, looked_at = np.arange(len(asked)), NEIGHBOURS
    while left.size:
        looked_at = min(looked_at, len(places))
        sure = np.zeros(len(left), bool)
        for block in np.array_split(np.arange(len(left)), -(-len(left) * looked_at // BLOCK)):
            here = asked[left[block]]
            near = places[tree.query(centre[here], looked_at)[1]]
            apart2 = ((centre[near] - centre[here][:, None]) ** 2).sum(axis=2)
            own, others = weight[here][:, None], weight[near]
            cost = np.where(near == here[:, None], np.inf, own * others / (own + others) * apart2)
            least = cost.min(axis=1)
            first = np.where(cost == least[:, None], near, len(centre)).min(axis=1)
            found[left[block]] = np.where(least <= limit, first, _NONE)
            own = own[:, 0]
            unseen = own * lightest / (own + lightest) * apart2.max(axis=1) * (1 - _SLACK)
            sure[block] = (np.minimum(least, limit) < unseen) | (looked_at == len(places))
        left, looked_at = left[~sure], 4 * looked_at
    return found
