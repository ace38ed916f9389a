"""Escape text for a comment on GitHub or GitLab: nothing in it is a mark, and nobody is notified.

Both turn what they find in rendered text into mentions, references, links and emoji. An escape or a comment before the
sign does not help, since they look after Markdown is rendered. A zero-width space behind the sign does; in a code span
they do not look.
"""

from __future__ import annotations

import re

_ZERO_WIDTH_SPACE = "\u200b"
_SPACE_ENTITY = "&#8203;"
_TRIGGER_POSITION = re.compile(
    r"(?<=[@#!$%~&^:])(?=[\w\"\[+/-])"  # @user, #1, !1, $1, %1, ~label, &1, ^alert, :emoji:, http://
    r"|(?<=[A-Za-z])(?=-\d)"  # GH-1, and the like that a repository may define
    r"|(?<=\w)(?=\.[^\W\d])"  # www.x, x.com
    r"|(?<=\[)(?=[\w\[])"  # [[wiki]], [vulnerability:1]
    r"|(?<=\$)$|^(?=\$)"  # math, where a code span stands beside it
)
_COMMIT_HASH = re.compile(r"(?<![A-Za-z0-9])[0-9A-Fa-f]{7,}(?![A-Za-z0-9])")


def escape_inert(text: str) -> str:
    """Escape text for a line, or for a cell of a table."""
    line = _COMMIT_HASH.sub(_break_hash, " ".join(text.split()))
    # Inserted as a character, since the escaping would break an entity; then as an entity, which people can see.
    return (
        escape_markdown(_TRIGGER_POSITION.sub(_ZERO_WIDTH_SPACE, line))
        .replace(_ZERO_WIDTH_SPACE, _SPACE_ENTITY)
        .replace("|", "\\|")
    )


def _break_hash(match: re.Match[str]) -> str:
    """Break what may be the hash of a commit into pieces of six digits: hashes are recognised from seven on."""
    return _ZERO_WIDTH_SPACE.join(match[0][at : at + 6] for at in range(0, len(match[0]), 6))


def make_code_cell(text: str) -> str:
    """Make a code span for a cell of a table. A bar would end the cell, so it becomes a broken bar."""
    return make_code_span(text.replace("|", "\u00a6"))


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
