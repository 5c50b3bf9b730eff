"""Charts: the scatter of the load multiplier, and the load multiplier over friction."""

from dataclasses import replace
from itertools import combinations

import pytest
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

from drystone.contacts.blocks import model_from_labels
from drystone.drawing.pictures.curves import plot_friction, plot_scatter
from drystone.statics.result import LimitStatus
from drystone.statics.scatter.scatter import ScatterSettings, scatter
from drystone.statics.sensitivity import AtFriction
from tests.statics.walls import coursed, stacked


@pytest.fixture(scope="module")
def shaken():
    settings = ScatterSettings(samples=40, mu=(0.4, 0.8), outline_noise=0.1, placement_noise=0.2)
    return scatter(model_from_labels(coursed(3, 2, 50)).model, settings)


@pytest.fixture(scope="module")
def falling():
    model = model_from_labels(stacked((20, 10, 0), (20, 10, 9))).model
    return scatter(model, ScatterSettings(samples=40, placement_noise=1.0, mu=(0.4, 0.8)))


def lines(panel):
    return {line.get_gid(): line for line in panel.lines}


def test_histograms_count_every_wall_that_stands_and_mark_quantiles(falling):
    ax = plot_scatter(falling)
    fallen = falling.counts[LimitStatus.UNSTABLE]
    assert f"{fallen} of 40 ({100 * fallen / 40:.3g} %) do not stand" in ax.get_title("left")
    alpha, value, friction = ax.child_axes
    for panel, name in ((alpha, "alpha"), (value, "value")):
        values, quantiles = getattr(falling, name), getattr(falling, f"{name}_quantiles")
        assert sum(bar.get_height() for bar in panel.patches) == len(values) < 40
        marked = [lines(panel)[f"quantile-{name}"].get_xdata()[0] for name in ("5", "50", "95")]
        assert marked == pytest.approx(quantiles)
        assert f"95 %: {quantiles.high:.3f}" in panel.get_title()
    assert lines(alpha)["unshaken"].get_xdata()[0] == pytest.approx(0.2)  # about the toe
    assert lines(value)["unshaken"].get_xdata()[0] == falling.unshaken.value
    assert (alpha.get_xlabel(), value.get_xlabel()) == ("min alpha", "F_LR = min alpha / mu")
    # Friction is drawn against alpha, with the wall itself and those that fall.
    drawn = lines(friction)
    assert drawn["walls"].get_xdata().tolist() == falling.standing_mu.tolist()
    assert drawn["walls"].get_ydata().tolist() == falling.alpha.tolist()
    least = min(falling.unshaken.left.alpha, falling.unshaken.right.alpha)
    assert drawn["unshaken-point"].get_xydata().tolist() == [[0.58, least]]
    assert len(drawn["falling"].get_xdata()) == fallen
    assert "sliding" not in drawn  # out of reach here
    flat = model_from_labels(stacked((20, 10, 0))).model
    slides = plot_scatter(scatter(flat, ScatterSettings(samples=5, mu=(0.4, 0.8))))
    line = lines(slides.child_axes[2])["sliding"]
    assert line.get_xdata().tolist() == line.get_ydata().tolist()


def test_panels_are_those_that_there_is_something_for(shaken):
    words = plot_scatter(shaken).get_title("left")
    said = "40 walls, shaken: friction 0.4 to 0.8, outlines by 0.1, places by 0.2"
    assert f"{said} (lengths of the model)" in words
    assert "All of them stand" in words
    model = model_from_labels(stacked((10, 20, 0))).model
    assert len(plot_scatter(scatter(model, ScatterSettings(samples=9))).child_axes) == 2
    smooth = scatter(model, ScatterSettings(samples=9, mu=(0.0, 0.0)))
    assert len(plot_scatter(smooth).child_axes) == 1
    settings = ScatterSettings(samples=40, mu=(0.4, 0.8), mu_per_interface=True)
    alphas = {side: getattr(shaken, side)[1:] for side in ("alpha_left", "alpha_right")}
    status = (LimitStatus.FAILED, *shaken.status[1:])
    one = replace(shaken, settings=settings, status=status, **alphas)
    words = plot_scatter(one).get_title("left")
    assert "gave up on 1" in words
    assert "for each interface" in words
    # When no wall stands the picture says so.
    model = model_from_labels(stacked((20, 10, 0), (20, 10, 19))).model
    ax = plot_scatter(scatter(model, ScatterSettings(samples=3, mu=(0.4, 0.8))))
    assert [text.get_text() for text in ax.child_axes[0].texts] == ["no wall stands"]
    assert (len(ax.child_axes), ax.get_legend()) == (1, None)
    assert "3 of 3 (100 %) do not stand" in ax.get_title("left")


def all_texts(ax):
    yield from (ax.title, ax._left_title, *ax.get_legend().get_texts())
    for panel in ax.child_axes:
        yield from (panel.title, panel.xaxis.label, panel.yaxis.label)
        yield from panel.texts
        for axis, limits in ((panel.xaxis, panel.get_xlim()), (panel.yaxis, panel.get_ylim())):
            for place, label in zip(axis.get_ticklocs(), axis.get_ticklabels(), strict=True):
                if limits[0] <= place <= limits[1]:
                    yield label


@pytest.mark.parametrize("name", ["falling", "all equal", "small"])
def test_no_text_overlaps_another(name, shaken, falling):
    if name == "all equal":
        model = model_from_labels(stacked((20, 10, 0))).model
        ax = plot_scatter(scatter(model, ScatterSettings(samples=9)))
    elif name == "falling":
        ax = plot_scatter(falling)
    else:
        ax = plot_scatter(shaken, where := Figure(figsize=(9, 3.6)).add_subplot())
        assert ax is where
    renderer = FigureCanvasAgg(ax.figure).get_renderer()
    ax.figure.draw(renderer)
    boxes = [
        (text.get_text(), text.get_window_extent(renderer))
        for text in all_texts(ax)
        if text.get_text() and text.get_visible()
    ]
    assert len(boxes) > 20
    for (one, box), (other, second) in combinations(boxes, 2):
        assert not box.overlaps(second), f"{one} / {other}"


def test_a_wall_slides_at_mu_on_a_tilting_table_only():
    curve = (AtFriction(0.4, 0.3, 0.4), AtFriction(0.6, None, 0.5))
    for slides_at_mu in (True, False):
        axes = plot_friction(curve, 0.58, slides_at_mu=slides_at_mu)
        words = [text.get_text() for text in axes.get_legend().get_texts()]
        assert ("the whole wall slides" in words) == slides_at_mu
        assert {"to the left", "to the right"} <= set(words)
