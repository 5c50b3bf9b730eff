"""The colours are checked against published models of colour vision, not against themselves."""

from itertools import combinations

import numpy as np
import pytest
from skimage.color import xyz2lab
from skimage.color.colorconv import xyz_from_rgb

from drystone.drawing import palette

# Machado, Oliveira and Fernandes 2009, full severity, on linear RGB.
VISION = {
    "normal": np.eye(3),
    "protan": np.array([[0.152286, 1.052583, -0.204868], [0.114503, 0.786281, 0.099216],
                        [-0.003882, -0.048116, 1.051998]]),
    "deutan": np.array([[0.367322, 0.860646, -0.227968], [0.280085, 0.672501, 0.047413],
                        [-0.011820, 0.042940, 0.968881]]),
    "tritan": np.array([[1.255528, -0.076749, -0.178779], [-0.078411, 0.930809, 0.147602],
                        [0.004733, 0.691367, 0.303900]]),
}  # fmt: skip


def _lab(colour, vision):
    part = np.array(palette.rgb(colour))
    linear = np.where(part <= 0.04045, part / 12.92, ((part + 0.055) / 1.055) ** 2.4)
    seen = np.clip(VISION[vision] @ linear, 0, 1)
    return xyz2lab(xyz_from_rgb @ seen)


@pytest.mark.parametrize("vision", VISION)
def test_clusters_and_wedges_stay_apart_for_every_kind_of_vision(vision):
    colours = (*palette.CLUSTER_COLOURS, palette.WEDGE_COLOUR)
    places = [_lab(colour, vision) for colour in colours]
    assert len(palette.CLUSTER_COLOURS) == 16
    assert min(np.linalg.norm(one - other) for one, other in combinations(places, 2)) > 16


def test_numbers_are_readable_on_every_colour_also_of_the_second_tone_after_sixteen_clusters():
    """WCAG 2 level AA asks for a contrast of 4.5."""
    colours = [palette.cluster_colour(number) for number in range(1, 33)]
    for colour in (*colours, palette.WEDGE_COLOUR, palette.PLAIN_COLOUR):
        both = colour, palette.text_colour(colour)
        dark, light = sorted(map(palette.relative_luminance, both))
        assert (light + 0.05) / (dark + 0.05) >= 4.5, colour
    assert len(set(colours)) == 32
    for light, dark in zip(colours[:16], colours[16:], strict=True):
        assert palette.relative_luminance(dark) < palette.relative_luminance(light)
    assert palette.cluster_colour(33) == palette.cluster_colour(1)
    with pytest.raises(ValueError, match="from 1, not 0"):
        palette.cluster_colour(0)
