"""What the site's search finds: one entry for each thing that has a name, or a text, of its own."""

from __future__ import annotations

import re

from archgen.frozen import dataclass

_MARKS = re.compile(r"[*`#>|]+|\]\([^)]*\)|[\[\]]")


@dataclass(frozen=True, slots=True)
class SearchEntry:
    """One thing that a reader may look for.

    `kind` is a singular noun (`component`); `line` says what and whose it is. `refs` are anchors, the best first: the
    entry leads to the first that the site has, and is left out where it has none. `keys` are found as they are but not
    shown: ids, and selectors such as `owner:certh`. `text` is prose, which is searched last.
    """

    kind: str
    title: str
    line: str
    refs: tuple[str, ...]
    keys: tuple[str, ...] = ()
    text: str = ""


def join_entry_parts(*parts: str | None) -> str:
    """Join the parts that are not empty to the second line of an entry."""
    return " · ".join(part for part in parts if part)


def to_plain_text(*texts: str | None) -> str:
    """Return Markdown texts on one line, without the marks that nobody types into a search."""
    return " ".join(_MARKS.sub(" ", " ".join(text for text in texts if text)).split())
