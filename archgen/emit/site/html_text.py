"""Make text and addresses safe for HTML."""

from __future__ import annotations

import re
from functools import lru_cache
from html import escape as _escape

from archgen.views.short_figures import shorten_text, split_figures, write_comparisons

_UNBROKEN_LENGTH = 17
"""Shorter texts hold no word that is long enough to be broken."""

_FORBIDDEN_CHARACTER = re.compile("[\x00-\x08\x0b\x0c\x0e-\x1f\x7f-\x9f\ud800-\udfff\ufdd0-\ufdef\ufffe\uffff]")
_LONG_WORD = re.compile(r"[^\s<>&;]{18,}")
_BREAK_POSITION = re.compile(r"(?<=[a-z0-9])([._/:-])(?=[A-Za-z0-9~])")
_MICROSECONDS = re.compile(r"([0-9][ \u00a0])us\b")
_FIGURE = re.compile("[0-9] [a-zA-Z%]")
_WEB_ADDRESS = re.compile(r"(?:https?://[^\s/]|mailto:[^\s:]+@)", re.IGNORECASE)


def replace_forbidden(text: str) -> str:
    """Replace characters that HTML forbids by U+FFFD."""
    return _FORBIDDEN_CHARACTER.sub("\ufffd", text) if _FORBIDDEN_CHARACTER.search(text) else text


@lru_cache(65536)
def escape_html(text: str) -> str:
    """Escape text for HTML, in an element or in a quoted attribute."""
    return _escape(replace_forbidden(text))


@lru_cache(65536)
def escape_breakable(text: str) -> str:
    """Escape text for an element, with places to break in long ids, topics and messages."""
    # After escaping, and not across `&` or `;`, so that no entity is broken by a `<wbr>`.
    escaped_text = escape_html(text)
    return (
        _LONG_WORD.sub(lambda long: _BREAK_POSITION.sub(r"\1<wbr>", long.group()), escaped_text)
        if len(escaped_text) > _UNBROKEN_LENGTH
        else escaped_text
    )


def write_signs(text: str) -> str:
    """Write signs before and units behind figures as people do: `<= 15 Hz` as `≤ 15 Hz`, `60 us` as `60 µs`."""
    text = write_comparisons(text)
    return _MICROSECONDS.sub("\\1µs", text) if "us" in text else text


@lru_cache(65536)
def write_figures(text: str, *, is_lower: bool = False) -> str:
    """Escape text for an element, its figures with three significant digits, rounded down where they are `is_lower`;
    pointing at one shows all of it.
    """
    # Most texts have no figure: the pattern of quantities costs more than looking for one.
    if not _FIGURE.search(text):
        return escape_breakable(write_signs(text))
    return "".join([_write_part(part, short) for part, short in split_figures(text, is_lower=is_lower)])


def _write_part(text: str, short: str) -> str:
    if not short:
        return escape_breakable(write_signs(text))
    return f'<span class="short" title="{escape_html(write_signs(text))}">{escape_html(write_signs(short))}</span>'


def shorten_figures(text: str) -> str:
    """Return text with its figures as `write_figures` shows them, for where no element can be: pictures and tips."""
    if not _FIGURE.search(text):
        return write_signs(text)
    return write_signs(shorten_text(text))


def web_address(url: str | None) -> str | None:
    """Return an outside address, escaped, if it is one that a page may link to (http, https, mailto)."""
    return escape_html(url) if url and _WEB_ADDRESS.match(url) else None


def make_element_id(anchor: str) -> str:
    """Make an id (and a fragment) from an anchor. Different anchors may get the same id: `_assign_ids` settles that."""
    return re.sub(r"[^A-Za-z0-9_.:/-]+", "-", anchor)
