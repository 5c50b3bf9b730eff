"""Clusters of similar stones (§3.4, Fig. 5)."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.cluster.hierarchy import fcluster, ward

from drystone.kernels.polygons import turn
from drystone.model.settings import Ranged, ranged
from drystone.model.stone import StoneSet
from drystone.poses import PoseBook


@dataclass(frozen=True, kw_only=True)
class ClusterSettings(Ranged):
    """How stones are grouped.

    Parameters
    ----------
    distance : float
        Ward distance above which clusters stay apart; the paper uses 0.2.
    """

    distance: float = ranged(0.2, above=0)


def stone_features(stones: StoneSet, book: PoseBook) -> NDArray[np.float64]:
    """Return what stones are grouped by, (n, 2), in the order of the set (§3.4, Fig. 5).

    The eccentricity of the ellipse of equal second moments, in [0, 1), and the area of the bounding
    box of the initial pose over the largest in the set, in (0, 1].
    """
    extents = [np.ptp(turn(s.hull, book.initial_angle(s)), axis=0) for s in stones]
    box = np.array([extent[0] * extent[1] for extent in extents])
    return np.column_stack([[stone.eccentricity for stone in stones], box / box.max()])


def cluster_stones(
    stones: StoneSet, book: PoseBook, settings: ClusterSettings | None = None
) -> dict[int, int]:
    """Group stones of similar eccentricity and size (:func:`stone_features`) by Ward linkage.

    Cluster of each stone's id; clusters are numbered from 1 by falling mean size.
    """
    settings = settings or ClusterSettings()
    ids = [stone.id for stone in stones]
    if len(ids) < 2:
        return dict.fromkeys(ids, 1)
    features = stone_features(stones, book)
    flat = fcluster(ward(features), settings.distance, criterion="distance")
    size = {label: -float(features[flat == label, 1].mean()) for label in np.unique(flat)}
    order = {label: rank for rank, label in enumerate(sorted(size, key=lambda k: size[k]), 1)}
    return {stone_id: order[label] for stone_id, label in zip(ids, flat, strict=True)}
