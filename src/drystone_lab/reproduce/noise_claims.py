"""What §5.3 says of the noise of stones, beside the walls that were built."""

from collections.abc import Sequence

from drystone_lab.reproduce.findings import Finding, Trend
from drystone_lab.reproduce.noise_sets import NOISES
from drystone_lab.reproduce.noise_walls import (
    FILLED,
    Level,
    Rule,
    is_full,
    reference_trend,
    residuals,
    trends,
)

MIXED = 60
"""Noise in % below which the paper's walls are always filled above :data:`FILLED`."""


def findings(levels: Sequence[Level]) -> tuple[Finding, ...]:
    """Compare the levels with what §5.3 says of them."""
    return (
        _falls(levels),
        _always_filled(levels),
        *((_hardest(levels),) if len(levels) > 1 else ()),
        *((_surprise(levels),) if len(levels) > 2 else ()),
        _against_random(levels),
        _no_trend(levels, "F_LR", "Lateral resistance has no clear trend."),
        *_interlocks(levels),
        _no_trend(levels, "F_AH", "Horizontality has no obvious trend."),
        _against_reference(levels, "F_SF", "The wall is filled as much as the reference."),
        _against_reference(
            levels, "F_AV", "Head joints are better staggered than the reference's."
        ),
    )


def _falls(levels: Sequence[Level]) -> Finding:
    each = trends(levels, "F_SF")
    sets = each["sets"]
    return Finding(
        "Filling falls as the noise rises (Fig. 24a).",
        _said(each),
        None if sets is None else sets.rho < 0 and sets.clear,
    )


def _always_filled(levels: Sequence[Level]) -> Finding:
    low = [outcome for level in levels if level.noise < MIXED for outcome in level.ours]
    high = [outcome for level in levels if level.noise >= MIXED for outcome in level.ours]
    full, rest = sum(map(is_full, low)), sum(map(is_full, high))
    public = [o for level in levels if level.noise < MIXED and not level.wall.stand_in
              for o in level.ours]  # fmt: skip
    return Finding(
        f"Below {MIXED} % noise F_SF is always above {FILLED:g}.",
        f"{full} of {len(low)} walls below {MIXED} % are above {FILLED:g}, and {rest} of "
        f"{len(high)} of the others; of published stones {sum(map(is_full, public))} of "
        f"{len(public)} below {MIXED} %.",
        full == len(low) if low else None,
    )


def _hardest(levels: Sequence[Level]) -> Finding:
    hardest = max(level.noise for level in levels)
    worst = {name: min(levels, key=lambda level: _least(level, name)) for name in ("F_SF", "F_LR")}
    words = [
        f"the lowest median {name} is that of {level.noise} % noise, {_least(level, name):.3f}"
        for name, level in worst.items()
    ]
    return Finding(
        "The set of 80 % is the most difficult: walls unfilled and weak.",
        f"{'; '.join(words)}.",
        all(level.noise == hardest for level in worst.values()) if hardest == NOISES[-1] else None,
    )


def _surprise(levels: Sequence[Level]) -> Finding:
    above = residuals(levels)
    # The first and the last have a neighbour on one side only: a mere trend sets them apart.
    inner = [level.noise for level in levels[1:-1]]
    best = max(inner, key=lambda noise: above[noise])
    return Finding(
        "One noisy level is filled surprisingly well.",
        f"the median F_SF of {best} % less that of the levels beside it is {above[best]:+.3f}, the "
        "most of all that have one on either side.",
        None,
    )


def _against_random(levels: Sequence[Level]) -> Finding:
    low = [level for level in levels if level.noise < MIXED]
    counts = {
        name: sum(_least(level, name) > _least(level, name, "random") for level in low)
        for name in ("F_SF", "F_LR")
    }
    return Finding(
        f"Below {MIXED} % noise the walls are better filled than by the random strategy.",
        f"against a random choice among the same candidates the median F_SF is higher in "
        f"{counts['F_SF']} of {len(low)} sets, the median F_LR in {counts['F_LR']}. The random "
        "strategy of that study is another one, so this is our yardstick, not its.",
        counts["F_SF"] == len(low) if low else None,
    )


def _interlocks(levels: Sequence[Level]) -> tuple[Finding, Finding]:
    each, reference = trends(levels, "F_AV"), reference_trend(levels, "F_AV")
    sets = each["sets"]
    walls = "too few of them." if reference is None else f"{reference.words()}."
    # Few walls are published: a correlation that is not clear is not yet against the claim.
    told = reference is not None and (reference.clear or reference.rho <= 0)
    return (
        Finding(
            "Interlocking F_AV rises with the noise.",
            _said(each),
            None if sets is None else sets.rho > 0 and sets.clear,
        ),
        Finding(
            "F_AV of the reference walls rises with the noise.",
            f"of the published walls: {walls}",
            reference.rho > 0 if reference is not None and told else None,
        ),
    )


def _no_trend(levels: Sequence[Level], name: str, claim: str) -> Finding:
    each = trends(levels, name)
    sets = each["sets"]
    if sets is None:
        return Finding(claim, _said(each), None)
    # Eight medians may miss a trend that the walls, or the published sets alone, do show.
    others = any(found.clear for found in each.values() if found is not None)
    return Finding(claim, _said(each), False if sets.clear else None if others else True)


def _against_reference(levels: Sequence[Level], name: str, claim: str) -> Finding:
    known = [(level, level.reference) for level in levels if level.reference is not None]
    better = [
        level.noise
        for level, wall in known
        # Sizes of walls are rounded to px, so that walls of all stones differ in later digits.
        if round(_least(level, name), 3) >= round(wall.metric(name) or 0.0, 3)
    ]
    each = "; ".join(
        f"{level.noise} %: {_least(level, name):.3g} against {wall.metric(name) or 0.0:.3g}"
        for level, wall in known
    )
    return Finding(
        claim,
        f"the median is at least the published wall's in {len(better)} of {len(known)} sets"
        f"{f' ({each})' if each else ''}.",
        len(better) == len(known) if known else None,
    )


def _said(each: dict[str, Trend | None]) -> str:
    words = {
        "walls": "over walls",
        "sets": "over medians of sets",
        "published": "of published sets",
    }
    told = [f"{words[over]}: {found.words()}" for over, found in each.items() if found is not None]
    return "; ".join(told) + "." if told else "too few levels."


def _least(level: Level, name: str, rule: Rule = "paper") -> float:
    """Return the median of a figure, 0 when no wall has it: one that does not stand has none."""
    return level.median(name, rule) or 0.0
