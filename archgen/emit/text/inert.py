"""Escape text for a comment on GitHub or GitLab: nothing in it is a mark, and nobody is notified.

Both turn what they find in rendered text into mentions, references, links and emoji. An escape or a comment before the
sign does not help, since they look after Markdown is rendered. A zero-width space behind the sign does; in a code span
they do not look.
"""

from __future__ import annotations

import re

from archgen.emit.text import filters

_GAP = "\u200b"
_ENTITY = "&#8203;"
_SPOTS = re.compile(
    r"(?<=[@#!$%~&^:])(?=[\w\"\[+/-])"  # @user, #1, !1, $1, %1, ~label, &1, ^alert, :emoji:, http://
    r"|(?<=[A-Za-z])(?=-\d)"  # GH-1, and the like that a repository may define
    r"|(?<=\w)(?=\.[^\W\d])"  # www.x, x.com
    r"|(?<=\[)(?=[\w\[])"  # [[wiki]], [vulnerability:1]
    r"|(?<=\$)$|^(?=\$)"  # math, where a code span stands beside it
)
_HEX = re.compile(r"(?<![A-Za-z0-9])[0-9A-Fa-f]{7,}(?![A-Za-z0-9])")


def plain(text: str) -> str:
    """Escape text for a line, or for a cell of a table."""
    line = _HEX.sub(_gapped, " ".join(text.split()))
    # Inserted as a character, since the escaping would break an entity; then as an entity, which people can see.
    return filters.markdown(_SPOTS.sub(_GAP, line)).replace(_GAP, _ENTITY).replace("|", "\\|")


def _gapped(found: re.Match[str]) -> str:
    """Break what may be the hash of a commit into pieces of six digits: hashes are recognised from seven on."""
    return _GAP.join(found[0][at : at + 6] for at in range(0, len(found[0]), 6))


def cell(text: str) -> str:
    """Make a code span for a cell of a table. A bar would end the cell, so it becomes a broken bar."""
    return filters.code(text.replace("|", "\u00a6"))
