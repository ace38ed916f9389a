"""What a YAML parser drops: comments that silence, that swallow, and Git's marks of a conflict."""

from __future__ import annotations

import pytest

from archgen.diagnostics.source_span import Span
from archgen.syntax import yaml_comments
from archgen.syntax.yaml_comments import LineStarts
from tests.quiet_seconds import measure_quiet_seconds


@pytest.mark.parametrize(
    ("text", "comments"),
    [
        ("a: 1 # archgen: ignore[unread-output] for tests", [(("unread-output",), "for tests", 1, 6)]),
        ("# archgen:ignore[a, b]", [(("a", "b"), "", 1, 1)]),
        ("a:\n\t# archgen: ignore why", [((), "why", 2, 2)]),
        ("a: b# archgen: ignore[c]", []),
        ("a: 1 # archgen: ignored[c]", []),
        ("a: 1 # archgen: ignore[]  \r\n# archgen: ignore[x]", [((), "", 1, 6), (("x",), "", 2, 1)]),
    ],
)
def test_a_comment_silences_the_rules_in_its_brackets(text: str, comments: list[tuple[object, ...]]) -> None:
    found = yaml_comments.read_ignore_comments("f", text, ())
    assert [(c.rules, c.why, c.span.line, c.span.column) for c in found] == comments
    assert yaml_comments.may_hold_ignore_comments(text) or not comments


def test_inside_of_quoted_text_it_is_no_comment() -> None:
    text = '"# archgen: ignore[a]"\n# archgen: ignore[b]'
    assert [c.rules for c in yaml_comments.read_ignore_comments("f", text, [(0, 22)])] == [("b",)]


@pytest.mark.parametrize(
    ("text", "messages"),
    [
        (
            "<<<<<<< HEAD\na\n=======\nb\n>>>>>>> arm\n",
            ["1:1 Git could not merge `HEAD` with `arm` here (3:1 the other side begins here; 5:1 and ends here)"],
        ),
        (
            "<<<<<<<\n|||||||\n=======\n>>>>>>>\r\n",
            [
                "1:1 Git could not merge `this side` with `the other side` here (3:1 the other side begins here; 4:1 and ends here)"
            ],
        ),
        (
            "<<<<<<< one  side\t \na\n======= \nb\n>>>>>>>   \n",
            [
                (
                    "1:1 Git could not merge `one  side` with `the other side` here"
                    " (3:1 the other side begins here; 5:1 and ends here)"
                )
            ],
        ),
        ("Title\n=======\n", []),
        (">>>>>>> a\n=======\n<<<<<<< b\n", []),
        ("  <<<<<<< a\n=======\n>>>>>>> b\n", []),
    ],
)
def test_marks_of_a_conflict_count_in_their_order_only(text: str, messages: list[str]) -> None:
    found = yaml_comments.find_merge_conflicts("f", text)
    assert [
        f"{d.span.line}:{d.span.column} {d.message} "
        f"({'; '.join(f'{label.span.line}:{label.span.column} {label.text}' for label in d.labels)})"
        for d in found
    ] == messages


@pytest.mark.parametrize(
    ("source", "end", "empty", "comment"),
    [
        ("title: Arm #2", 10, False, "`#2` is a comment, not part of the text"),
        ("title: Arm # left", 10, False, None),
        ("title: Arm #archgen: ignore", 10, False, None),
        ("title: #12", 6, True, "`#12` is a comment, not part of the text"),
        ("title: #ff8800", 6, True, "`#ff8800` is a comment, not part of the text"),
        ("title: #todo", 6, True, None),
    ],
)
def test_a_comment_right_behind_a_value_may_be_part_of_it(
    source: str,
    end: int,
    empty: bool,  # noqa: FBT001
    comment: str | None,
) -> None:
    value_span = Span("f", 1, 8, 1, end + 1)
    found = yaml_comments.find_swallowed_text(source, value_span, end, is_empty=empty)
    assert [d.message for d in found] == ([comment] if comment else [])


def test_lines_where_a_comment_may_have_swallowed_text() -> None:
    assert yaml_comments.find_lines_with_hashes("a #b\r\nc # d\r\te#f\n\t#g") == {0, 3}


def test_offsets_become_lines_and_columns_whatever_ends_a_line() -> None:
    starts = LineStarts("a\r\nbc\rd\ne")
    assert starts.span_between("f", 4, 6) == Span("f", 2, 2, 3, 1)
    assert starts.span_between("f", 8, 9) == Span("f", 4, 1, 4, 2)


@pytest.mark.parametrize("end", ["b", "b \t", "", "\r\r"])
def test_a_mark_with_many_blanks_takes_time_that_grows_with_its_length(end: str) -> None:
    text = f"<<<<<<< a{' ' * 400_000}{end}\n"
    assert measure_quiet_seconds(lambda: list(yaml_comments.find_merge_conflicts("f", text))) < 1
