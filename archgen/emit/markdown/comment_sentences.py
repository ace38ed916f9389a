"""Sentences of ours in a comment, with names from the project in them: shortened, visible, and inert.

GitHub and GitLab turn what they find in rendered text into mentions, references, links and emoji. An escape or a comment
before the sign does not help, since they look after Markdown is rendered. A zero-width space behind the sign does; in a code
span they do not look.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from urllib.parse import quote

from archgen.diagnostics import make_visible
from archgen.frozen import dataclass
from archgen.views.changes.change_wording import text_runs

_ADDRESS_SIGNS = ":/?#@!$&'*+,;=%"
_MAX_SENTENCE, _MAX_TITLE = 700, 100
"""Maximal number of characters of a sentence, and of a title."""


@dataclass(frozen=True, slots=True)
class ElementNames:
    """Titles of elements and the addresses of where they are written, by id."""

    titles: Mapping[str, str]
    addresses: Mapping[str, str]


NO_ELEMENTS = ElementNames({}, {})


def write_sentence(text: str, elements: ElementNames = NO_ELEMENTS) -> str:
    """Return a sentence as Markdown; what is in backticks is code, or where `elements` has an address, a title with a link."""
    runs = text_runs(_shorten_text(make_visible(" ".join(text.split())), _MAX_SENTENCE))
    return "".join(_escape_piece(run.text) if not run.code else _write_name(run.text, elements) for run in runs)


def _write_name(name: str, elements: ElementNames) -> str:
    address = elements.addresses.get(name)
    title = write_title(elements.titles.get(name, ""))
    # A place is no text: in an address nothing is made to a mention, and `<` and `>` end it.
    return f"[{title}](<{quote(address, safe=_ADDRESS_SIGNS)}>)" if address and title else make_code_span(name)


def write_title(text: str) -> str:
    """Return a title as Markdown."""
    return escape_inert(_shorten_text(make_visible(text), _MAX_TITLE))


def write_code(text: str) -> str:
    """Return a name or a place as code."""
    return make_code_span(shorten_sentence_name(text))


def shorten_sentence_name(text: str) -> str:
    """Return a name that is not escaped yet, no longer than a sentence."""
    return make_visible(text)[:_MAX_SENTENCE]


def _shorten_text(text: str, limit: int) -> str:
    return text if len(text) <= limit else f"{text[: limit - 1]}…"


def _escape_piece(text: str) -> str:
    """Escape a piece of a sentence, keeping the blanks at its ends."""
    leading_blank, trailing_blank = (" " if text[:1] == " " else ""), (" " if text[-1:] == " " and text.strip() else "")
    return f"{leading_blank}{escape_inert(text)}{trailing_blank}" if text.strip() else " "


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
