"""Tests of what errors in reading explain."""

from __future__ import annotations

from archgen.diagnostics.diagnostic import Diagnostic
from archgen.diagnostics.source_span import SourceTexts, Span
from archgen.findings.error_aftermath import drop_aftermath

_TEXT = """\
screen:
  input:
    image: camera.image
  role: sink
camera:
  image: Image
  depth: Image
lamp:
  light: Light
"""


def _finding(rule: str, line: int, word: str, element: str) -> Diagnostic:
    column = _TEXT.splitlines()[line - 1].index(word) + 1
    return Diagnostic(rule, word, Span("a.yaml", line, column, line, column + len(word)), element=element)


def test_what_an_error_swallowed_is_neither_lacking_nor_unused() -> None:
    sources = SourceTexts()
    sources.add_text("a.yaml", _TEXT)
    error = _finding("unknown-key", 2, "input", "g.screen")
    found = [
        _finding("disconnected-component", 1, "screen", "g.screen"),  # lacks what stands in the error
        _finding("unread-output", 6, "image", "g.camera"),  # named below the error
        _finding("unmapped-component", 8, "lamp", "g.lamp"),
        _finding("unread-output", 9, "light", "g.lamp"),
        _finding("type-mismatch", 3, "image", "g.screen"),  # not a rule about what is missing
    ]
    assert [f"{d.span.line} {d.rule}" for d in drop_aftermath(found, [error], sources)] == [
        "8 unmapped-component",
        "9 unread-output",
        "3 type-mismatch",
    ]
    assert list(drop_aftermath(found, [], sources)) == found
