"""What a page may load and run: its own scripts, styles, fonts and pictures, and nothing from anywhere else."""

from __future__ import annotations

import base64
import hashlib

_DIRECTIVES = (
    "default-src 'none'",
    "script-src 'self'",
    "style-src 'self'",
    "font-src 'self'",
    # Pictures that a page made itself: a view that is saved is drawn from such an address.
    "img-src 'self' data: blob:",
    # By name, although the default says it: a server of live pages allows itself, and nothing else.
    "connect-src 'none'",
    "base-uri 'none'",
    "form-action 'none'",
)
PAGE_POLICY = "; ".join(_DIRECTIVES)
"""The Content-Security-Policy of each page, in an element of the page: there is no server to send a header.

Neither a script nor a style in the page itself counts, so that no text of a project can ever become one.
"""

LIVE_PAGE_POLICY = PAGE_POLICY.replace("connect-src 'none'", "connect-src 'self'")
"""The policy of a page that is served: it asks its own server for news, and nobody else."""


def write_standalone_policy(style: str) -> str:
    """Return the policy of a page that loads nothing: its one style element counts, by its hash, with the font in it.

    `style` is all that stands in the element, blanks at its ends included.
    """
    digest = base64.b64encode(hashlib.sha256(style.encode()).digest()).decode()
    return f"default-src 'none'; style-src 'sha256-{digest}'; font-src data:; base-uri 'none'; form-action 'none'"
