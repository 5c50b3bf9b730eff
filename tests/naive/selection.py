"""Slow, obvious twin of Algorithm 2, as in Appendix A, with exact means (DESIGN 4.7)."""

import statistics
from fractions import Fraction

SLACK = Fraction(1, 10**9)


def _at_least_mean(pi, index):
    """Those with at least the mean, which are never none of some."""
    values = [Fraction(index(a)) for a in pi]
    return [a for a, v in zip(pi, values, strict=True) if v >= statistics.mean(values) - SLACK]


def _third(a):
    return a.indices.IS if a.indices.boundary else a.indices.IWR


def algorithm2(pi, weights):
    pi = [a for a in pi if a.indices.LLC is not None and a.indices.LLC > 0]
    if not pi:
        return None
    pi = _at_least_mean(pi, lambda a: a.llc)
    pi = _at_least_mean(pi, lambda a: -a.indices.NHR)
    inner = [a for a in pi if not a.indices.boundary]
    boundary = [a for a in pi if a.indices.boundary]
    pi = _at_least_mean(inner, _third) + _at_least_mean(boundary, _third)
    pi = _at_least_mean(pi, lambda a: a.indices.GDS)
    pi = _at_least_mean(pi, lambda a: a.indices.LFR)

    def objective(a):
        terms = (a.llc, -a.indices.NHR, _third(a), a.indices.GDS, a.indices.LFR)
        return sum(Fraction(w) * Fraction(x) for w, x in zip(weights, terms, strict=True))

    return min(pi, key=lambda a: (-objective(a), a.stone_id))
