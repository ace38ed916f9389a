"""What is no YAML is said in our words, at the place that helps, whichever parser noticed."""

from __future__ import annotations

import pytest

from archgen.diagnostics.source_span import Span
from archgen.syntax import yaml_parser
from archgen.syntax.yaml_errors import (
    ParserProblem,
    diagnose_duplicate_key,
    diagnose_problem,
    find_forbidden_character,
)


@pytest.mark.parametrize("has_libyaml", [True, False])
@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("a: b: c", "1:5 a second `: ` in one line: text that holds `: ` must be quoted"),
        ("a: [1, 2\nb: 3", "1:4 this `[` is not closed"),
        ("a: {b: 1\nc: 3", "1:4 this `{` is not closed"),
        ("a: @b", "1:4 text cannot begin with `@`"),
        ("a: `b", "1:4 text cannot begin with a backtick"),
        ("a: *", "1:4 text cannot begin with `*`"),
        ('a: "b', "1:4 this quote is never closed"),
        ("a: 'b' c", "1:8 the value ends before this"),
        ("a: 1\n\tb: 2", "2:1 a tab cannot stand in the indentation"),
        ("a:\n  b: 1\n c: 2", "3:2 this line does not belong to anything above it"),
        ("a: - b", "1:4 a list cannot begin on the line of its key"),
    ],
)
def test_both_parsers_say_the_same(text: str, said: str, has_libyaml: bool, monkeypatch: pytest.MonkeyPatch) -> None:  # noqa: FBT001
    monkeypatch.setattr(yaml_parser, "HAS_LIBYAML", has_libyaml and yaml_parser.HAS_LIBYAML)
    _, (diagnostic, *_) = yaml_parser.parse_yaml("f", text)
    assert f"{diagnostic.span.line}:{diagnostic.span.column} {diagnostic.message}" == said


def test_a_message_that_nobody_foresaw_is_still_said_inside_of_the_text() -> None:
    diagnostic = diagnose_problem("f", "a: 1\n", ParserProblem("something new", 99, 99))
    assert (diagnostic.message, diagnostic.span.line, diagnostic.span.column) == ("this is not YAML", 1, 5)


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("a: b\r\nc: \x07", "2:4 the control character U+0007 cannot stand in YAML"),
        ("a\ufeff", "1:2 the byte order mark U+FEFF cannot stand in YAML"),
        ("tab\t and line\x85end", None),
    ],
)
def test_characters_that_no_yaml_holds(text: str, said: str | None) -> None:
    found = find_forbidden_character("f", text)
    assert (found and f"{found.span.line}:{found.span.column} {found.message}") == said


def test_a_key_written_twice_names_both_places() -> None:
    first, second = Span("f", 1, 1, 1, 2), Span("f", 3, 1, 3, 2)
    found = diagnose_duplicate_key("a", second, first)
    assert (found.rule, found.span, [label.span for label in found.labels]) == ("duplicate-key", second, [first])


def test_a_line_that_ends_its_block_too_early_is_shown() -> None:
    text = "components:\n    a:\n      x: 1\n  b:\n      x: 1\n    c:\n      x: 1\n"
    _, (diagnostic,) = yaml_parser.parse_yaml("f", text)
    assert (diagnostic.span.line, diagnostic.message) == (4, "this line does not belong to anything above it")
    deeper = "g:\n  components:\n    a:\n      x: 1\n  b:\n      x: 1\n    c:\n      x: 1\n"
    _, (diagnostic,) = yaml_parser.parse_yaml("f", deeper)
    assert diagnostic.span.line == 7
    assert [(label.span.line, label.text) for label in diagnostic.labels] == [
        (5, "or this line is indented too little")
    ]
