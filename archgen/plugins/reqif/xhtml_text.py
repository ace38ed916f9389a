"""Formatted text of ReqIF, XHTML, as CommonMark: paragraphs, lists, emphasis, tables; pictures by their names."""

from __future__ import annotations

import re
from collections.abc import Mapping

_BLOCKS = frozenset({"p", "div", "h1", "h2", "h3", "h4", "h5", "h6", "table", "blockquote", "pre", "dl", "dt", "dd"})
_MARKS = {"b": "**", "strong": "**", "i": "*", "em": "*", "code": "`", "tt": "`"}
_UNSHOWN = frozenset({"script", "style"})
"""What they hold is no text: nobody reads it in the other tool either."""
_BLANKS = re.compile(r"[ \t\r\n]+")
_EMPTY_LINES = re.compile(r"\n(?:[ \t]*\n)+")
NO_BREAK_SPACE = "\u00a0"
"""A blank that counts: XHTML folds the others."""


class XhtmlText:
    """Takes the parts of one text in their order, and gives the whole as CommonMark."""

    def __init__(self) -> None:
        self._parts: list[str] = []
        self._lists: list[int | None] = []
        """The lists around: the number of the last item, None where they have none."""
        self._unshown_depth = 0

    def start(self, name: str, attributes: Mapping[str, str]) -> None:
        """Take the beginning of an element."""
        if name in _UNSHOWN:
            self._unshown_depth += 1
        elif name in _BLOCKS:
            self._parts.append("\n\n")
        elif name == "br":
            self._parts.append("\n")
        elif name in _MARKS:
            self._parts.append(_MARKS[name])
        elif name in {"ul", "ol"}:
            self._parts.append("" if self._lists else "\n\n")
            self._lists.append(0 if name == "ol" else None)
        elif name == "li":
            self._start_item()
        elif name == "tr":
            self._parts.append("\n")
        elif name in {"object", "img"}:
            picture = attributes.get("data") or attributes.get("src") or "without a name"
            self._parts.append(f" (picture {picture.rpartition('/')[2]}) ")

    def end(self, name: str) -> None:
        """Take the end of an element."""
        if name in _UNSHOWN:
            self._unshown_depth -= 1
        elif name in _BLOCKS:
            self._parts.append("\n\n")
        elif name in _MARKS:
            self._parts.append(_MARKS[name])
        elif name in {"ul", "ol"} and self._lists:
            self._lists.pop()
            self._parts.append("" if self._lists else "\n\n")
        elif name in {"td", "th"}:
            self._parts.append(" | ")

    def add(self, text: str) -> None:
        """Take a piece of text."""
        if not self._unshown_depth:
            self._parts.append(_fold_blanks(text))

    def _start_item(self) -> None:
        number = self._lists[-1] if self._lists else None
        if number is not None:
            self._lists[-1] = number + 1
        mark = "-" if number is None else f"{number + 1}."
        self._parts.append(f"\n{NO_BREAK_SPACE * 2 * (min(len(self._lists), 20) - 1)}{mark} ")

    def finish(self) -> str:
        """Return the text, without blanks at its ends."""
        text = "".join(self._parts).strip("\n")
        lines = (_fold_blanks(line).strip(" ").removesuffix(" |") for line in text.split("\n"))
        return _EMPTY_LINES.sub("\n\n", "\n".join(lines)).strip("\n").replace(NO_BREAK_SPACE, " ").strip()


def _fold_blanks(text: str) -> str:
    """Fold runs of blanks to one; most texts have none, and need no search by a pattern."""
    has_runs = "\n" in text or "  " in text or "\t" in text or "\r" in text
    return _BLANKS.sub(" ", text) if has_runs else text
