"""Values read off a mapping: what is missing, or of an unexpected kind, reads as not written."""

from __future__ import annotations

from fractions import Fraction

import pytest

from archgen.diagnostics.source_span import NO_SPAN, Span
from archgen.link import mapping_values
from archgen.syntax import yaml_parser
from archgen.syntax.yaml_tree import MappingNode

TEXT = """\
text: 1.10
none: ~
flag: true
other: no
number: 12
list: [a, ~, [b], {c: d}, 1.10]
map: {a: 1, b: ~, c: [x], d: text, e: {f: g}}
title: The title
odd: {title: }
layout: {direction: top-bottom}
wrong_layout: {layout: {direction: up}}
wait: 20 ms
zero: 0
"""


@pytest.fixture
def mapping() -> MappingNode:
    """Return the text as a mapping, as the parser reads it: without any check."""
    document, _ = yaml_parser.parse_yaml("a.yaml", TEXT)
    assert document is not None
    return document.root


@pytest.mark.parametrize(
    ("key", "text"),
    [("text", "1.10"), ("none", None), ("flag", "true"), ("list", None), ("map", None), ("absent", None)],
)
def test_a_text_is_what_was_written(mapping: MappingNode, key: str, text: str | None) -> None:
    scalar = mapping_values.get_scalar(mapping, key)
    assert mapping_values.get_text(mapping, key) == text
    assert (scalar.text if scalar else None) == text


@pytest.mark.parametrize(
    ("key", "texts"),
    [("list", ("a", "1.10")), ("text", ("1.10",)), ("none", ()), ("map", ()), ("absent", ())],
)
def test_a_list_gives_its_texts_and_a_text_is_a_list_of_one(
    mapping: MappingNode, key: str, texts: tuple[str, ...]
) -> None:
    assert mapping_values.get_texts(mapping, key) == texts


@pytest.mark.parametrize(
    ("key", "number"), [("number", 12), ("zero", 0), ("text", None), ("flag", None), ("none", None), ("absent", None)]
)
def test_a_whole_number_is_no_flag(mapping: MappingNode, key: str, number: int | None) -> None:
    assert mapping_values.get_integer(mapping, key) == number


@pytest.mark.parametrize(("key", "value"), [("flag", True), ("other", False), ("number", False), ("absent", False)])
def test_a_flag_is_true_only_where_it_says_so(mapping: MappingNode, key: str, value: object) -> None:
    assert mapping_values.get_flag(mapping, key) is value


def test_a_quantity_has_its_dimension(mapping: MappingNode) -> None:
    duration = mapping_values.get_quantity(mapping, "wait", "duration")
    assert duration is not None
    assert duration.value == Fraction(20_000_000)
    assert mapping_values.get_quantity(mapping, "wait", "frequency") is None
    assert mapping_values.get_quantity(mapping, "absent", "duration") is None


def test_a_span_is_that_of_the_value(mapping: MappingNode) -> None:
    assert mapping_values.get_span(mapping, "text") == Span("a.yaml", 1, 7, 1, 11)
    assert mapping_values.get_span(mapping, "absent") == NO_SPAN


def test_a_mapping_of_texts_leaves_out_what_is_none(mapping: MappingNode) -> None:
    assert mapping_values.get_text_mapping(mapping, "map") == {"a": "1", "d": "text"}
    assert mapping_values.get_text_mapping(mapping, "text") == {}


def test_elements_are_walked_with_their_bodies(mapping: MappingNode) -> None:
    elements = mapping_values.iterate_elements(mapping, "map")
    assert [(name, entry.key_span.column, [e.key for e in body]) for name, entry, body in elements] == [
        ("a", 7, []),
        ("b", 13, []),
        ("c", 19, []),
        ("d", 27, []),
        ("e", 36, ["f"]),
    ]


def test_a_title_is_written_or_made_from_the_id(mapping: MappingNode) -> None:
    assert mapping_values.get_title(mapping, "object_recognition") == "The title"
    odd = mapping_values.get_mapping(mapping, "odd")
    assert mapping_values.get_title(odd, "object_recognition") == "Object Recognition"


def test_a_layout_that_says_nothing_known_is_the_usual_one(mapping: MappingNode) -> None:
    usual = mapping_values.get_layout(mapping_values.get_mapping(mapping, "odd"), "layout")
    assert mapping_values.get_layout(mapping, "layout").direction == "top-bottom"
    assert mapping_values.get_layout(mapping_values.get_mapping(mapping, "wrong_layout"), "layout") == usual


@pytest.mark.parametrize(
    ("written", "name"),
    [
        ("  Point \t cloud ", "Point cloud"),
        ("u\u0308ber", "\u00fcber"),
        ("sensor_msgs/Image", "sensor_msgs/msg/Image"),
        ("sensor_msgs/msg/Image", "sensor_msgs/msg/Image"),
    ],
)
def test_names_of_types_are_compared_in_one_form(written: str, name: str) -> None:
    assert mapping_values.normalise_type_name(written) == name
