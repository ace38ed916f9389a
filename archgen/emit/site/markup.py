"""Make text and addresses safe for HTML."""

from __future__ import annotations

import re
from functools import lru_cache
from html import escape as _escape

_FORBIDDEN = re.compile("[\x00-\x08\x0b\x0c\x0e-\x1f\x7f-\x9f\ud800-\udfff\ufdd0-\ufdef\ufffe\uffff]")
_LONG = re.compile(r"[^\s<>&;]{18,}")
_JOINTS = re.compile(r"(?<=[a-z0-9])([._/:-])(?=[A-Za-z0-9~])")
_WEB = re.compile(r"(?:https?://[^\s/]|mailto:[^\s:]+@)", re.IGNORECASE)


def clean(text: str) -> str:
    """Replace characters that HTML forbids by U+FFFD."""
    return _FORBIDDEN.sub("\ufffd", text) if _FORBIDDEN.search(text) else text


@lru_cache(65536)
def escape(text: str) -> str:
    """Escape text for HTML, in an element or in a quoted attribute."""
    return _escape(clean(text))


@lru_cache(65536)
def words(text: str) -> str:
    """Escape text for an element, with places to break in long ids, topics and messages."""
    # After escaping, and not across `&` or `;`, so that no entity is broken by a `<wbr>`.
    safe = escape(text)
    return _LONG.sub(lambda long: _JOINTS.sub(r"\1<wbr>", long.group()), safe) if len(safe) > 17 else safe  # noqa: PLR2004


def web(url: str | None) -> str | None:
    """Return an outside address, escaped, if it is one that a page may link to (http, https, mailto)."""
    return escape(url) if url and _WEB.match(url) else None


def element_id(anchor: str) -> str:
    """Make an id (and a fragment) from an anchor. Different anchors may get the same id: `_assign_ids` settles that."""
    return re.sub(r"[^A-Za-z0-9_.:/-]+", "-", anchor)
