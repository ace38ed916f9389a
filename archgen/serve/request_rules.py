"""Whom the preview answers: pages of its own address, and nobody whom another site sends.

A page on the web may have a browser ask any address of its user's machine. By its own name, which it lets lead here
(DNS rebinding), it could even read the answer: so the name that a request asks for must be one of ours. An address of
digits cannot be made to lead elsewhere.
"""

from __future__ import annotations

import ipaddress
from collections.abc import Collection, Mapping
from urllib.parse import urlsplit

_LOCAL_NAMES = frozenset({"localhost"})


def find_refusal(headers: Mapping[str, str | None], served_names: Collection[str], port: int) -> str:
    """Return why a request is refused, empty if it is not.

    `headers` are `Host`, `Origin`, `Sec-Fetch-Site` and `Sec-Fetch-Mode` of the request, None where it has none.
    """
    host = headers.get("Host") or ""
    if not _is_own_address(host, served_names, port):
        return "this address is not the one that is served here"
    origin = headers.get("Origin")
    if origin is not None and origin.lower() != f"http://{host.lower()}":
        return "another site may not ask"
    # Scripts that are loaded across sites carry no Origin, and the files of the search are scripts.
    is_foreign = (headers.get("Sec-Fetch-Site") or "none") not in {"none", "same-origin"}
    if is_foreign and headers.get("Sec-Fetch-Mode") != "navigate":
        return "another site may not load this"
    return ""


def _is_own_address(host: str, served_names: Collection[str], port: int) -> bool:
    """Whether a `Host` means this server: its name and its port."""
    try:
        address = urlsplit(f"//{host}")
        name, asked_port = address.hostname or "", address.port
    except ValueError:
        return False
    if address.username is not None or address.path or (asked_port or 80) != port:
        return False
    return name in _LOCAL_NAMES or name in {each.lower() for each in served_names} or is_ip_address(name)


def is_ip_address(name: str) -> bool:
    """Whether a name is an address of digits."""
    try:
        ipaddress.ip_address(name)
    except ValueError:
        return False
    return True
