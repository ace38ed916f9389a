"""Colours of states on a terminal, the same as on the site: green is met, amber not shown or owed, red missed."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator

_CODES = {
    "met": "32",
    "in time": "32",
    "in time with priorities by rate": "32",
    "open": "33",
    "unknown": "33",
    "not proven": "33",
    "not proven in time": "33",
    "MISSED": "1;31",
    "overload": "1;31",
}
"""What tables call the verdicts on chains, hosts and resources; the words say the same without colour."""
_CELL = re.compile(rf"(?<=  )(?:{'|'.join(sorted(_CODES, key=len, reverse=True))})(?=  |$)")

_SHARE = re.compile(r"(?<=  )(?:\d+ \(|\d+ % → )?(\d+) ?%\)?(?=  |$)")
_TITLES = ("when ", "from ", "of ")
"""How lines of a history begin that are no rows."""


def paint_states(lines: Iterable[str]) -> Iterator[str]:
    """Yield the lines of sections with titles in bold and verdicts in their colours, where they fill a cell."""
    for line in lines:
        if line and not line.startswith(" "):
            yield f"\x1b[1m{line}\x1b[0m"
        else:
            yield _CELL.sub(lambda found: f"\x1b[{_CODES[found[0]]}m{found[0]}\x1b[0m", line)


def paint_progress(lines: Iterable[str]) -> Iterator[str]:
    """Yield the lines of tables with titles in bold, and each share in the colour of its bar on the site: all or not."""
    for number, line in enumerate(lines):
        if number == 0 or line.startswith(_TITLES):
            yield f"\x1b[1m{line}\x1b[0m"
        else:
            yield _SHARE.sub(lambda found: f"\x1b[{'32' if found[1] == '100' else '33'}m{found[0]}\x1b[0m", line)
