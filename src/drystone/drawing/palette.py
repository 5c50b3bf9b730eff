"""Colours that stay apart for colour-blind readers, and text that stays readable on them."""

CLUSTER_COLOURS = (
    "#009eff", "#e7c261", "#c2e7c2", "#db619e", "#9ee7ff", "#79aa61", "#aaaa92", "#f3e79e",
    "#ff9ece", "#9eb6ff", "#aa9224", "#8679c2", "#008655", "#4961c2", "#6d616d", "#9e3d92",
)  # fmt: skip
"""Farthest-point choice in CIELAB: any two are at least 16 units apart for normal, protan, deutan
and tritan vision, and from the wedges' red; far apart and light ones come first."""

WEDGE_COLOUR = "#8b0000"
"""Dark red, as in the paper's Fig. 19."""

PLAIN_COLOUR = "#cfc8bb"  # stones of which no cluster is known
PALE, FIXED_COLOUR = "#efece6", "#c9c9c9"
"""Blocks below what is drawn over them, and those that cannot move."""

OUTLINE_COLOUR = "#1a1a1a"
GREY = "#8c8c8c"

SECOND_TONE = 0.6
"""Lightness of the colours of cluster 17 and on, as a share of the first sixteen's."""

Rgb = tuple[float, float, float]  # sRGB, each part in [0, 1]


def cluster_colour(cluster: int) -> str:
    """Return the colour ``"#rrggbb"`` of a cluster, numbered from 1.

    The sixteen colours come round again in a darker tone for clusters 17 to 32, then all over.
    """
    if cluster < 1:
        raise ValueError(f"clusters are numbered from 1, not {cluster}")
    turn, place = divmod(cluster - 1, len(CLUSTER_COLOURS))
    colour = CLUSTER_COLOURS[place]
    if turn % 2 == 0:
        return colour
    return "#" + "".join(f"{round(part * SECOND_TONE * 255):02x}" for part in rgb(colour))


def text_colour(background: str) -> str:
    """Return black or white, whichever has more contrast (WCAG 2) on a background."""
    luminance = relative_luminance(background)
    on_black, on_white = (luminance + 0.05) / 0.05, 1.05 / (luminance + 0.05)
    return "#000000" if on_black >= on_white else "#ffffff"


def relative_luminance(colour: str) -> float:
    """Return the luminance of ``"#rrggbb"`` as WCAG 2 defines it, 0 (black) to 1 (white)."""
    red, green, blue = (linear(part) for part in rgb(colour))
    return 0.2126 * red + 0.7152 * green + 0.0722 * blue


def rgb(colour: str) -> Rgb:
    """Read ``"#rrggbb"``."""
    red, green, blue = (int(colour[start : start + 2], 16) / 255 for start in (1, 3, 5))
    return red, green, blue


def linear(part: float) -> float:
    """Return a part of an sRGB colour as light."""
    return part / 12.92 if part <= 0.04045 else ((part + 0.055) / 1.055) ** 2.4
