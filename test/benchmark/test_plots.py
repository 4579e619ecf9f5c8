"""Figures: what stands where in them, and that the same numbers give the same text."""
import math
import xml.etree.ElementTree as ElementTree

import numpy
import pytest
from semantic_mht_slam.benchmark.plots import (Line, Members, bar_plot, draw_bars, draw_lines, draw_violins, line_plot, places, violin_plot,
                             violin_shape)
from matplotlib.figure import Figure


def texts(figure):
    """The texts of a figure; that it can be parsed shows that it is well-formed."""
    return [element.text for element in ElementTree.fromstring(figure.svg).iter("{http://www.w3.org/2000/svg}text")]


@pytest.fixture
def axes():
    return Figure().subplots()


def test_what_stands_side_by_side_in_a_category_does_not_overlap():
    (first, width), (second, _) = places(0, 2, 3), places(1, 2, 3)
    assert (second - first > width).all()
    assert (first - 0.5 * width > numpy.arange(3) - 0.5).all()
    assert (second + 0.5 * width < numpy.arange(3) + 0.5).all()


def test_bars_reach_from_zero_and_a_missing_one_keeps_the_places_of_the_others(axes):
    draw_bars(axes, [Members("a", "#112233", [30.0, -10.0]), Members("b", "#445566", [math.nan, 5.0])])
    bars = [(round(bar.get_x() + 0.5 * bar.get_width(), 3), bar.get_y(), bar.get_height()) for bar in axes.patches]
    assert bars == [(-0.2, 0.0, 30.0), (0.8, 0.0, -10.0), (1.2, 0.0, 5.0)]


def test_a_violin_is_widest_at_the_most_frequent_number_and_its_line_at_the_mean(axes):
    shape = violin_shape({1: 10.0, 8: 5.0, 2: 90.0})
    assert shape["coords"][numpy.argmax(shape["vals"])] == pytest.approx(2.0, abs=0.1)
    assert shape["coords"][0] < 1.0 and shape["coords"][-1] > 8.0
    assert shape["mean"] == pytest.approx((10.0 + 180.0 + 40.0) / 105.0)
    draw_violins(axes, [Members("a", "#112233", [{2: 30.0, 6: 10.0}, {}])])
    body, means = axes.collections
    outline = body.get_paths()[0].vertices
    assert outline[:, 0].max() == pytest.approx(-outline[:, 0].min())
    assert [line[0][1] for line in means.get_segments()] == [3.0]


def test_values_that_are_not_finite_interrupt_a_line_and_maps_have_one_scale(axes):
    points = numpy.array([0.0, 1.0, math.nan, 1.0, 0.0])
    draw_lines(axes, [Line("a", numpy.arange(5.0), points, "#112233")], is_map=True)
    assert axes.get_aspect() == 1.0
    assert numpy.isnan(axes.lines[0].get_path().vertices).any(axis=1).tolist() == [False, False, True, False, False]


def test_errors_are_drawn_from_zero_on(axes):
    draw_lines(axes, [Line("a", numpy.arange(3.0), numpy.array([2.0, 3.0, 4.0]), "#112233")], is_map=False)
    assert axes.get_ylim()[0] == 0.0


def test_labels_stand_in_the_figure_and_are_escaped():
    figure = bar_plot("title", "a < b [%]", ["first & only"], [Members("method", "#112233", [1.0])])
    assert figure.title == "title"
    assert {"a < b [%]", "first & only", "method"} <= set(texts(figure))


def test_the_same_numbers_give_the_same_text():
    def figure():
        return violin_plot("", "n", ["00"], [Members("a", "#112233", [{1: 2.0}])]).svg
    assert figure() == figure()


def test_long_lines_are_thinned_to_what_can_be_seen():
    x = numpy.arange(300000.0)
    assert len(line_plot("", "", "", [Line("", x, 1.0 + numpy.sin(1e-4 * x), "#112233")]).svg) < 200000
