"""What Graphviz wrote becomes one element of a page: without prologue, with ids, titles and a name of its own."""

from __future__ import annotations

import pytest

from archgen.emit.graphviz.graph_drawing import clean_graphviz_svg, clean_outlines, find_drawn_edges
from archgen.views.picture_shapes import Graph

_GRAPH = Graph("groups/a b", "A & B", "flow", (), (), alt="Two <boxes>", kind="component")
_PROLOGUE = '<?xml version="1.0"?>\n<!DOCTYPE svg>\n<!-- Generated -->\n'


def _clean(body: str, graph: Graph = _GRAPH) -> str:
    return clean_graphviz_svg(f'{_PROLOGUE}<svg width="9pt">\n{body}</svg>\n', graph).decode()


def test_the_root_has_a_class_a_name_and_a_description_and_nothing_before_it() -> None:
    assert _clean("") == (
        '<svg class="archgen" role="group" width="9pt">\n<title>A &amp; B</title>\n'
        "<desc>Two &lt;boxes&gt;</desc>\n</svg>\n"
    )


def test_ids_begin_with_the_pictures_own_and_graphvizs_comments_and_titles_are_gone() -> None:
    node = '<!-- n1 -->\n<g id="n1" class="node box">\n<title>n1</title>\n<path/>\n</g>\n'
    graph = '<g id="graph0" class="graph">\n<title>groups/a b</title>\n'
    assert _clean(graph + node).split("</desc>\n")[1] == (
        '<g id="groups-a-b-graph0" class="graph">\n<g id="groups-a-b-n1" class="node box">\n<path/>\n</g>\n</svg>\n'
    )


@pytest.mark.parametrize(
    ("written", "cleaned"),
    [
        (
            '<g id="a_n1"><a xlink:href="x.html" xlink:title="Tip" target="_top">\n<path/>\n</a>\n</g>\n',
            '<a xlink:href="x.html" target="_top">\n<title>Tip</title>\n<path/>\n</a>\n',
        ),
        (
            '<g id="a_n1"><a xlink:href="x.html" xlink:title=" " target="_top">\n<path/>\n</a>\n</g>\n',
            '<a xlink:href="x.html" target="_top">\n<path/>\n</a>\n',
        ),
        ('<g id="a_n1"><a xlink:title="Tip">\n<path/>\n</a>\n</g>\n', "<title>Tip</title>\n<path/>\n"),
    ],
    ids=["a link and a tooltip", "a link", "a tooltip"],
)
def test_a_tooltip_is_a_title_and_a_link_without_an_address_is_none(written: str, cleaned: str) -> None:
    assert _clean(written).split("</desc>\n")[1] == f"{cleaned}</svg>\n"


def test_what_is_no_svg_stays_as_it_is() -> None:
    assert clean_graphviz_svg("nothing", _GRAPH) == b"nothing"


def test_an_edge_without_a_line_is_not_drawn() -> None:
    drawn = '<g id="e1" class="edge a">\n<path/>\n</g>\n'
    empty = '<g id="e2" class="edge b">\n</g>\n'
    assert find_drawn_edges(empty + drawn) == {"e1"}


def test_surfaces_are_counted_from_one_and_numbers_have_two_decimals() -> None:
    outlines = b'<g id="surface17"/><use href="#surface17" x="1.23456"/><g id="surface9" y="0.5"/>'
    assert clean_outlines(outlines) == b'<g id="surface1"/><use href="#surface1" x="1.23"/><g id="surface2" y="0.5"/>'
