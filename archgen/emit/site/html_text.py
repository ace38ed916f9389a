"""Make text and addresses safe for HTML, and draw states: chips with an icon and words, bars of a share, and marks in the
tree.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from functools import lru_cache
from html import escape as _escape

from archgen.views.shapes import Meter, Status
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


_RING = "M8 2.5a5.5 5.5 0 1 1 0 11a5.5 5.5 0 1 1 0-11"
_TRIANGLE = "M8 2.5 14.5 13.5H1.5ZM8 6.5v3.2M8 11.6v.2"
_ICON_PATHS: Mapping[Status, str] = {
    "met": "M3 8.5 6.5 12 13 4.5",
    "not proven": "M5 6a3 3 0 1 1 4.2 2.8C8.3 9.3 8 9.7 8 10.5M8 12.8v.2",
    "missed": "M4 4 12 12M12 4 4 12",
    "open": _RING,
    "uncovered": f"{_RING}M4.2 11.8 11.8 4.2",
    "error": "M4 4 12 12M12 4 4 12",
    "warning": _TRIANGLE,
    "note": f"{_RING}M8 7.3v3.4M8 5.1v.2",
    "changed": "M3 5.5h9L9.5 3M13 10.5H4L6.5 13",
}
"""What is drawn in a square of 16 by 16, with a line of 1.6."""
_METER_LENGTH = 72
_METER_HEIGHT = 7


def write_chip(status: Status, text: str) -> str:
    """Write a chip: an icon, the word of the state, and what the words behind a ` · ` add."""
    word, _, addition = text.partition(" · ")
    addition_html = f' <span class="addition">{escape_html(addition)}</span>' if addition else ""
    return f'<span class="chip {_class_name(status)}">{write_icon(status)}{escape_html(word)}{addition_html}</span>'


def write_icon(status: Status) -> str:
    """Write the icon of a state."""
    return f'<svg class="icon" viewBox="0 0 16 16" width="12" height="12" aria-hidden="true"><path d="{_ICON_PATHS[status]}"/></svg>'


def list_icons() -> tuple[tuple[str, str], ...]:
    """Return the path of each state's icon, for scripts that draw chips."""
    return tuple(_ICON_PATHS.items())


def write_meter(meter: Meter) -> str:
    """Write a bar. Screen readers leave it out: the figures beside it say the same.

    Beyond the whole it is drawn in full, with a mark where the whole ends.
    """
    scale = _METER_LENGTH / max(1.0, meter.share)
    length = max(0.0, meter.share) * scale
    parts = [f'<rect class="ground" width="{_METER_LENGTH}" height="{_METER_HEIGHT}" rx="3"/>']
    if meter.is_partial:
        parts.append(f'<path class="hatch" d="{_hatch(length)}"/>')
    parts.append(f'<rect class="known" width="{min(length, scale):.4g}" height="{_METER_HEIGHT}" rx="3"/>')
    if meter.share > 1:
        parts.append(
            f'<rect class="over" x="{scale:.4g}" width="{length - scale:.4g}" height="{_METER_HEIGHT}"/>'
            f'<path class="limit" d="M{scale:.4g} -2V{_METER_HEIGHT + 2}"/>'
        )
    return (
        f'<svg class="meter {_class_name(meter.status)}" viewBox="0 -2 {_METER_LENGTH} {_METER_HEIGHT + 4}"'
        f' width="{_METER_LENGTH}" height="{_METER_HEIGHT + 4}" preserveAspectRatio="none" aria-hidden="true">'
        f"{''.join(parts)}</svg>"
    )


def _hatch(start: float) -> str:
    """Return slanted lines from the end of what is known to the end of the bar."""
    first = int(start) + 1
    return "".join(f"M{x} {_METER_HEIGHT}l5-{_METER_HEIGHT}" for x in range(first, _METER_LENGTH - 5, 4))


_MARK_WORDS = {
    "error": "there is an error",
    "missed": "a deadline is missed",
    "open": "something is open",
    "changed": "changed",
}


def write_mark(mark: str) -> str:
    """Write the mark of an entry of the tree: a ring for something open, a disc for an error or a missed deadline, a square
    for what has changed.
    """
    words = _MARK_WORDS[mark]
    return f'<span class="mark {mark}"><span class="spoken"> ({words})</span></span>'


def _class_name(status: Status) -> str:
    return status.replace(" ", "-")
