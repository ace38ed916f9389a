"""A comment of limited size: what does not fit is counted, and the reader is told how to see it."""

from __future__ import annotations

from collections.abc import Sequence

from archgen.frozen import dataclass, field

MAX_COMMENT_SIZE = 65_536 - 200
"""GitHub's limit for one comment (GitLab's is higher), minus room for the mark by which the comment is found again."""
_CLOSING_RESERVE = 600
"""Room for what closes the comment, and says that something is left out."""


@dataclass(slots=True)
class LimitedComment:
    """Blocks of Markdown separated by blank lines. `command` shows everything; it is a code span of at most 300
    characters.
    """

    limit: int
    command: str
    blocks: list[str] = field(default_factory=list)
    used_size: int = 0
    is_cut: bool = False

    def has_room_for(self, text: str) -> bool:
        """Whether there is room for a block."""
        return self.used_size + count_characters(text) + 2 <= self.limit - _CLOSING_RESERVE

    def add_block(self, text: str) -> None:
        """Add a block if it fits, else mark the comment as cut."""
        if not self.has_room_for(text):
            self.is_cut = True
            return
        self.blocks.append(text)
        self.used_size += count_characters(text) + 2

    def add_items(
        self,
        title: str,
        items: Sequence[str],
        summary: str = "",
        open_count: int | None = None,
        uncounted_items: int = 0,
    ) -> None:
        """Add a list below a title. `shown` items are open, the others are folded below the summary, in which `{}`
        becomes their number; `less` more are only counted.
        """
        open_count = len(items) if open_count is None else open_count
        open_items, folded_items = items[:open_count], items[open_count:]
        if open_items:
            self._add_list(title, open_items, "", 0 if folded_items else uncounted_items)
        elif title:
            self.add_block(title)
        if folded_items:
            folded_summary = summary.replace("{}", str(len(folded_items)))
            self._add_list(f"<details><summary>{folded_summary}</summary>", folded_items, "</details>", uncounted_items)

    def _add_list(self, opening: str, items: Sequence[str], closing: str, uncounted_items: int) -> None:
        # 100 characters are for "- and N more" and the blank lines in between.
        room = (
            self.limit
            - self.used_size
            - _CLOSING_RESERVE
            - count_characters(opening)
            - count_characters(closing)
            - count_characters(self.command)
            - 100
        )
        fitting_items = []
        for item in items:
            room -= count_characters(item) + 1
            if room < 0:
                break
            fitting_items.append(item)
        left_count = len(items) - len(fitting_items) + uncounted_items
        more_note = [f"- and {left_count} more: {self.command}"] if left_count > 0 else []
        self.add_block(
            "\n\n".join(part for part in (opening, "\n".join((*fitting_items, *more_note)), closing) if part)
        )

    def add_table(self, heads: Sequence[str], rows: Sequence[Sequence[str]]) -> None:
        """Add a table with as many rows as fit; cells are escaped already."""
        lines = [_table_row(heads), _table_row(["---"] * len(heads))]
        room = (
            self.limit
            - self.used_size
            - _CLOSING_RESERVE
            - count_characters("\n".join(lines))
            - count_characters(self.command)
            - 100
        )
        fitting_rows = []
        for row in map(_table_row, rows):
            room -= count_characters(row) + 1
            if room < 0:
                break
            fitting_rows.append(row)
        self.add_block("\n".join((*lines, *fitting_rows)))
        if len(fitting_rows) < len(rows):
            self.add_block(f"and {len(rows) - len(fitting_rows)} more: {self.command}")

    def write_text(self) -> str:
        """Return the comment."""
        cut_note = [f"More does not fit into a comment: {self.command}"] if self.is_cut else []
        return "\n\n".join((*self.blocks, *cut_note)) + "\n"


def _table_row(cells: Sequence[str]) -> str:
    return f"| {' | '.join(cells)} |"


def count_characters(text: str) -> int:
    """Count characters like the strictest host: those outside the basic multilingual plane are two."""
    return len(text) + sum(character > "\uffff" for character in text)
