"""Addresses outside: which of them a document may hold, and how."""

from __future__ import annotations

import re
from urllib.parse import quote, urlsplit

_HOST = re.compile(r"(?:[^@/\s]*@)?(?:[A-Za-z0-9](?:[A-Za-z0-9.-]*[A-Za-z0-9])?)(?::[0-9]{1,5})?\Z")
_MAIL = re.compile(r"mailto:[A-Za-z0-9._%+-]+@[A-Za-z0-9.-]+(?:\?[^\s]*)?\Z")
_MAX_LENGTH = 2000
"""Word takes 2,083 characters at most."""


def quote_address(url: str) -> str | None:
    """Return an address as a relationship may hold it; None if it is none that a reader should follow."""
    try:
        scheme = urlsplit(url).scheme.lower()
        host = urlsplit(url).netloc
    except ValueError:
        return None
    address = quote(url, safe="%/:=&?~#+!$,;'@()*[]-._", errors="replace")
    # A relationship's target must be a URI (ECMA-376 part 2): with half of an escape in it the file is damaged.
    if len(address) > _MAX_LENGTH or re.search(r"%(?![0-9A-Fa-f]{2})", address):
        return None
    if scheme == "mailto":
        return address if _MAIL.match(address) else None
    return address if scheme in {"http", "https"} and _HOST.match(host) else None
