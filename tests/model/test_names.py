"""Dotted names: which elements an end of a path may mean."""

from __future__ import annotations

from archgen.model.names import Found, Named, Names

NAMES = Names(
    {
        "group": ["a", "b", "x"],
        "component": ["a.x", "a.y", "b.x", "b.z"],
        "output": ["a.x.o", "a.y.o", "b.x.o", "b.z.y"],
        "node": ["x", "n"],
    }
)
ALL = ("group", "component", "output")


def test_a_complete_path_hides_other_candidates() -> None:
    assert NAMES.find("x", ALL) == Found(
        (Named("group", "x"),), 1, (Named("component", "a.x"), Named("component", "b.x"))
    )


def test_only_the_kinds_that_are_asked_for_count() -> None:
    assert NAMES.find("x", ("component",), component="b.z").one == Named("component", "b.x")
    assert NAMES.find("x", ("output",)) == Found((), 0)


def test_the_own_group_wins() -> None:
    assert NAMES.find("o", ALL).count == 3
    assert NAMES.find("x.o", ALL, component="b.z").one == Named("output", "b.x.o")
    assert NAMES.find("o", ALL, component="b.z").one == Named("output", "b.x.o")


def test_one_word_never_means_the_writer_or_its_output() -> None:
    assert NAMES.find("y", ALL, component="a.y").one == Named("output", "b.z.y")
    assert NAMES.find("o", ALL, component="a.y").one == Named("output", "a.x.o")
    assert NAMES.find("z", ALL, component="b.z") == Found((), 0)


def test_a_long_list_is_counted_and_its_begin_named() -> None:
    many = Names({"output": [f"g.c{number}.o" for number in range(1000)]})
    found = many.find("o", ("output",), component="g.c3")
    assert (found.count, len(found.elements), found.one) == (999, 8, None)
    assert Named("output", "g.c3.o") not in found.elements
