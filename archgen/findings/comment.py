"""A comment of limited size: what does not fit is counted, and the reader is told how to see it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

MOST = 65_536 - 200
"""GitHub's limit for one comment (GitLab's is higher), minus room for the mark by which the comment is found again."""
_RESERVE = 600
"""Room for what closes the comment, and says that something is left out."""


@dataclass(slots=True)
class Comment:
    """Blocks of Markdown separated by blank lines. `command` shows everything; it is a code span of at most 300
    characters.
    """

    most: int
    command: str
    blocks: list[str] = field(default_factory=list)
    used: int = 0
    cut: bool = False

    def fits(self, text: str, reserve: int = _RESERVE) -> bool:
        """Whether there is room for a block."""
        return self.used + size(text) + 2 <= self.most - reserve

    def add(self, text: str) -> None:
        """Add a block if it fits, else mark the comment as cut."""
        if not self.fits(text):
            self.cut = True
            return
        self.blocks.append(text)
        self.used += size(text) + 2

    def items(
        self, title: str, items: Sequence[str], summary: str = "", shown: int | None = None, less: int = 0
    ) -> None:
        """Add a list below a title. `shown` items are open, the others are folded below the summary, in which `{}`
        becomes their number; `less` more are only counted.
        """
        shown = len(items) if shown is None else shown
        head, rest = items[:shown], items[shown:]
        if head:
            self._list(title, head, "", 0 if rest else less)
        elif title:
            self.add(title)
        if rest:
            said = summary.replace("{}", str(len(rest)))
            self._list(f"<details><summary>{said}</summary>", rest, "</details>", less)

    def _list(self, opening: str, items: Sequence[str], closing: str, less: int) -> None:
        # 100 characters are for "- and N more" and the blank lines in between.
        room = self.most - self.used - _RESERVE - size(opening) - size(closing) - size(self.command) - 100
        kept = []
        for item in items:
            room -= size(item) + 1
            if room < 0:
                break
            kept.append(item)
        left = len(items) - len(kept) + less
        more = [f"- and {left} more: {self.command}"] if left > 0 else []
        self.add("\n\n".join(part for part in (opening, "\n".join((*kept, *more)), closing) if part))

    def table(self, heads: Sequence[str], rows: Sequence[Sequence[str]]) -> None:
        """Add a table with as many rows as fit; cells are escaped already."""
        lines = [_row(heads), _row(["---"] * len(heads))]
        room = self.most - self.used - _RESERVE - size("\n".join(lines)) - size(self.command) - 100
        kept = []
        for row in map(_row, rows):
            room -= size(row) + 1
            if room < 0:
                break
            kept.append(row)
        self.add("\n".join((*lines, *kept)))
        if len(kept) < len(rows):
            self.add(f"and {len(rows) - len(kept)} more: {self.command}")

    def text(self) -> str:
        """Return the comment."""
        cut = [f"More does not fit into a comment: {self.command}"] if self.cut else []
        return "\n\n".join((*self.blocks, *cut)) + "\n"


def _row(cells: Sequence[str]) -> str:
    return f"| {' | '.join(cells)} |"


def size(text: str) -> int:
    """Count characters like the strictest host: those outside the basic multilingual plane are two."""
    return len(text) + sum(character > "\uffff" for character in text)
