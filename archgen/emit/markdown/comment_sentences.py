"""Sentences of ours in a comment, with names from the project in them: shortened, visible, and inert."""

from __future__ import annotations

from collections.abc import Mapping
from urllib.parse import quote

from archgen.diagnostics import make_visible
from archgen.emit.markdown.inert_text import escape_inert, make_code_span
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
