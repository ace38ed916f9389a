"""Names of generic types: their parts, and generic names replaced."""

from __future__ import annotations

import pytest

from archgen.compose.expanded_project import bind_type_name, parse_type_expression


@pytest.mark.parametrize(
    ("text", "name", "arguments"),
    [
        ("motor", "motor", ()),
        ("filter<Pose>", "filter", ("Pose",)),
        (" filter < Laser pose > ", "filter", ("Laser pose",)),
        ("pair<A, Pair<B, C>>", "pair", ("A", "Pair<B, C>")),
    ],
)
def test_an_expression_has_a_name_and_arguments(text: str, name: str, arguments: tuple[str, ...]) -> None:
    expression = parse_type_expression(text)
    assert expression is not None
    assert (expression.name, expression.arguments) == (name, arguments)


@pytest.mark.parametrize("text", ["", "<A>", "a<>", "a<A", "a>", "a<A,>", "a<A>b", "a<A>>", "a<A>, b<C>"])
def test_brackets_that_do_not_match_are_no_expression(text: str) -> None:
    assert parse_type_expression(text) is None


@pytest.mark.parametrize(
    ("text", "bound"),
    [("T", "Pose"), ("Tool", "Tool"), ("Envelope<T>", "Envelope<Pose>"), ("Pair<T, U>", "Pair<Pose, Laser scan>")],
)
def test_generic_names_are_replaced_as_whole_words(text: str, bound: str) -> None:
    assert bind_type_name(text, {"T": "Pose", "U": "Laser scan"}) == bound
