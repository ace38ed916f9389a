"""Dotted names: which elements an end of a path may mean."""

from __future__ import annotations

from archgen.model.path_resolver import ElementRef, PathMatch, PathResolver

NAMES = PathResolver(
    {
        "group": ["a", "b", "x"],
        "component": ["a.x", "a.y", "b.x", "b.z"],
        "output": ["a.x.o", "a.y.o", "b.x.o", "b.z.y"],
        "node": ["x", "n"],
    }
)
ALL = ("group", "component", "output")


def test_a_complete_path_hides_other_candidates() -> None:
    assert NAMES.resolve_path("x", ALL) == PathMatch(
        (ElementRef("group", "x"),), 1, (ElementRef("component", "a.x"), ElementRef("component", "b.x"))
    )


def test_only_the_kinds_that_are_asked_for_count() -> None:
    assert NAMES.resolve_path("x", ("component",), component_id="b.z").unique_element == ElementRef("component", "b.x")
    assert NAMES.resolve_path("x", ("output",)) == PathMatch((), 0)


def test_the_own_group_wins() -> None:
    assert NAMES.resolve_path("o", ALL).count == 3
    assert NAMES.resolve_path("x.o", ALL, component_id="b.z").unique_element == ElementRef("output", "b.x.o")
    assert NAMES.resolve_path("o", ALL, component_id="b.z").unique_element == ElementRef("output", "b.x.o")


def test_one_word_never_means_the_writer_or_its_output() -> None:
    assert NAMES.resolve_path("y", ALL, component_id="a.y").unique_element == ElementRef("output", "b.z.y")
    assert NAMES.resolve_path("o", ALL, component_id="a.y").unique_element == ElementRef("output", "a.x.o")
    assert NAMES.resolve_path("z", ALL, component_id="b.z") == PathMatch((), 0)


def test_a_long_list_is_counted_and_its_begin_named() -> None:
    many = PathResolver({"output": [f"g.c{number}.o" for number in range(1000)]})
    found = many.resolve_path("o", ("output",), component_id="g.c3")
    assert (found.count, len(found.elements), found.unique_element) == (999, 8, None)
    assert ElementRef("output", "g.c3.o") not in found.elements
