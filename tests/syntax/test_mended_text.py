"""Half-written texts are mended by blanking lines."""

from __future__ import annotations

import pytest

from archgen.diagnostics.diagnostic import Diagnostic
from archgen.syntax.mended_text import MendedText, measure_common_lines, mend_text, split_lines
from archgen.syntax.yaml_parser import parse_yaml

GOOD = """\
groups:
  arm:
    components:
      grip: {outputs: {state: Pose}}
      plan:
        inputs: {state: grip.state}
"""


def find_errors(text: str) -> tuple[Diagnostic, ...]:
    document, diagnostics = parse_yaml("a.yaml", text)
    return diagnostics if document is None else ()


def mend(text: str, cursor_line: int, good_text: str | None = None) -> MendedText:
    return mend_text(text, cursor_line, good_text, find_errors)


def test_what_can_be_read_stays() -> None:
    assert mend(GOOD, 3) == MendedText(GOOD)


def test_the_line_of_the_cursor_is_taken_out() -> None:
    text = GOOD.replace("grip.state}", "grip.state")
    mended = mend(text, 6)
    assert mended.text == text.replace("        inputs: {state: grip.state\n", "\n")
    assert mended.lost_text == "        inputs: {state: grip.state\n"
    assert [error.rule for error in mended.errors] == ["syntax-error"]


def test_a_slip_that_was_left_behind_is_found_by_its_error() -> None:
    text = GOOD.replace("grip.state}", "grip.state") + "nodes:\n  n: {implements: grip}\n"
    mended = mend(text, 8)
    assert not find_errors(mended.text)
    assert "implements: grip" in mended.text or "grip: {outputs" in mended.text
    assert mended.text.count("\n") == text.count("\n")


def test_where_nothing_helps_the_text_is_as_it_was_below_new_lines() -> None:
    text = "<<<<<<< ours\n" + GOOD.replace("arm", "leg") + "=======\n>>>>>>> theirs\n"
    mended = mend(text, 1, GOOD)
    assert mended.lost_text == text
    assert not find_errors(mended.text)
    assert split_lines(mended.text)[:3] == split_lines(GOOD)[:3]


def test_lines_above_what_changed_push_down_the_text_of_before() -> None:
    lines = split_lines(GOOD)
    text = "".join((*lines[:3], "<<<<<<< a\n", "=======\n", ">>>>>>> b\n", *lines[3:]))
    assert mend(text, 4, GOOD).text == "".join((*lines[:3], "\n" * 3, *lines[3:]))


def test_without_an_earlier_text_nothing_is_mended() -> None:
    text = "<<<<<<< a\nx: 1\n=======\nx: 2\n>>>>>>> b\n"
    assert mend(text, 1) == MendedText(text)


@pytest.mark.parametrize("end", ["\n", "\r\n", "\r"])
def test_line_ends_stay(end: str) -> None:
    text = GOOD.replace("grip.state}", "grip.state").replace("\n", end)
    mended = mend(text, 6)
    assert mended.errors
    assert mended.text.count(end) == text.count(end)


def test_a_large_text_is_not_read_again_and_again() -> None:
    reads: list[int] = []

    def count_reads(text: str) -> tuple[Diagnostic, ...]:
        reads.append(len(text))
        return find_errors(text)

    text = "\n".join(f"{{ a{number}:" for number in range(200_000))
    assert mend_text(text, 3, None, count_reads).text == text
    assert sum(reads) < 5 * len(text)


def test_every_state_of_typing_can_be_read() -> None:
    lines = split_lines(GOOD)
    for number, line in enumerate(lines, 1):
        for length in range(len(line.rstrip("\n"))):
            text = "".join((*lines[: number - 1], f"{line[:length]}\n", *lines[number:]))
            mended = mend(text, number, GOOD)
            assert not find_errors(mended.text), text


def test_common_lines_are_measured_once() -> None:
    assert measure_common_lines(["a", "a"], ["a", "a", "a"]) == (2, 0)
    assert measure_common_lines(["a", "b", "c"], ["a", "x", "c"]) == (1, 1)
    assert measure_common_lines([], ["a"]) == (0, 0)
