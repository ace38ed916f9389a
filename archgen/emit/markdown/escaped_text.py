"""Text in Markdown in which nothing is a mark."""

from __future__ import annotations

import re

_MARKDOWN_MARKS = re.compile(r"([\\`*_{}\[\]<>&~$])")
_LINE_START_MARK = re.compile(r"^(\d*)([-+=#]|(?<=\d)[.)](?=\s|$))")
_TICK_RUN = re.compile(r"`+")
CONTROL_CHARACTER = re.compile(r"[\x00-\x08\x0b\x0c\x0e-\x1f\x7f-\x9f]")


def escape_markdown(text: object) -> str:
    """Escape text for a line of Markdown: nothing in the result is a mark."""
    line = _join_lines(text)
    return _LINE_START_MARK.sub(r"\1\\\2", _MARKDOWN_MARKS.sub(r"\\\1", line))


def make_code_span(text: object) -> str:
    """Make a code span of one line, with more ticks around it than in it."""
    line = _join_lines(text) or " "
    # CommonMark: a code span ends at the first run of exactly as many ticks as began it.
    ticks = "`" * (max((len(run) for run in _TICK_RUN.findall(line)), default=0) + 1)
    pad = " " if line[0] == "`" or line[-1] == "`" else ""
    return f"{ticks}{pad}{line}{pad}{ticks}"


def _join_lines(text: object) -> str:
    return CONTROL_CHARACTER.sub("\ufffd", " ".join(str(text).split()))
