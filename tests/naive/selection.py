"""Slow, obvious twin of Algorithm 2, nested as in Appendix A, with exact means (DESIGN 4.7)."""

from fractions import Fraction

SLACK = Fraction(1, 10**12)


def _mean(values):
    return sum((Fraction(v) for v in values), Fraction(0)) / len(values)


def _at_least_mean(pi, index):
    if not pi:
        return []
    mean = _mean([index(a) for a in pi])
    return [a for a in pi if Fraction(index(a)) >= mean - SLACK]


def _argmax(pi, weights, terms):
    def objective(a):
        e = (a.llc, -a.indices.NHR, _third(a), a.indices.GDS, a.indices.LFR)
        return sum((Fraction(w) * Fraction(x) for w, x in zip(weights[:terms], e, strict=False)),
                   Fraction(0))  # fmt: skip

    best = max(objective(a) for a in pi)
    level = [a for a in pi if objective(a) == best]
    return min(level, key=lambda a: a.stone_id)


def _third(a):
    return a.indices.IS if a.indices.boundary else a.indices.IWR


def algorithm2(  # noqa: PLR0911 - nested as in the paper
    pi, weights
):
    pi1 = [a for a in pi if a.indices.LLC is not None and a.indices.LLC > 0]
    if not pi1:
        return None
    pi2 = _at_least_mean(pi1, lambda a: a.llc)
    if not pi2:
        return _argmax(pi1, weights, 1)
    pi3 = _at_least_mean(pi2, lambda a: -a.indices.NHR)
    if not pi3:
        return _argmax(pi2, weights, 2)
    inner = [a for a in pi3 if not a.indices.boundary]
    boundary = [a for a in pi3 if a.indices.boundary]
    pi4 = _at_least_mean(inner, _third) + _at_least_mean(boundary, _third)
    if not pi4:
        return _argmax(pi3, weights, 3)
    pi5 = _at_least_mean(pi4, lambda a: a.indices.GDS)
    if not pi5:
        return _argmax(pi4, weights, 4)
    pi6 = _at_least_mean(pi5, lambda a: a.indices.LFR)
    if not pi6:
        return _argmax(pi5, weights, 5)
    return _argmax(pi6, weights, 5)
