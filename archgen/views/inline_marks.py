"""Emphasis and code that authors write as Markdown, in cells: `*wrap*` stands there in italics."""

from __future__ import annotations

import re
from dataclasses import replace

from archgen.views.inline_text import share_text
from archgen.views.shapes import Inlines, Text

# Marks stand around words, never inside of one: `2*3*4` and `*` alone are no emphasis.
_MARK = re.compile(r"(?<![\w*`])(?:\*\*(?=\S)([^*`]+?)(?<=\S)\*\*|\*(?=\S)([^*`]+?)(?<=\S)\*|`([^`]+)`)(?![\w*`])")


def render_marks(inlines: Inlines) -> Inlines:
    """Return runs of text with marked words set in bold, in italics or as code."""
    return tuple(run for part in inlines for run in _split_marks(part))


def read_marks(markdown: str) -> Inlines:
    """Return a line of Markdown as runs of text."""
    return render_marks((share_text(markdown),))


def strip_marks(markdown: str) -> str:
    """Return a line of Markdown as text alone, for where nothing can be set in italics."""
    return "".join([run.text for run in read_marks(markdown)])


def _split_marks(part: Text) -> list[Text]:
    if part.code or not ("*" in part.text or "`" in part.text):
        return [part]
    runs, end = [], 0
    for found in _MARK.finditer(part.text):
        strong, emphasis, code = found.groups()
        runs.append(replace(part, text=part.text[end : found.start()]))
        runs.append(
            replace(
                part,
                text=strong or emphasis or code,
                strong=part.strong or strong is not None,
                emphasis=part.emphasis or emphasis is not None,
                code=code is not None,
                line_break=False,
            )
        )
        end = found.end()
    runs.append(replace(part, text=part.text[end:], line_break=part.line_break and not runs))
    return [run for run in runs if run.text or run.line_break]
