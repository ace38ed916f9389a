"""Texts of comments: Modelio and Enterprise Architect write HTML into them, the language holds plain text."""

from __future__ import annotations

import re
from html.parser import HTMLParser

_HTML_BEGINNING = re.compile(
    r"\s*<(?:!doctype|html|body|head|p|div|span|ul|ol|b|i|u|strong|em|font|h[1-6]|table|br)\b[^<>]*>", re.IGNORECASE
)
_PARAGRAPHS = frozenset({"p", "div", "ul", "ol", "table", *(f"h{level}" for level in range(1, 7))})
_UNSEEN = frozenset({"style", "script", "head", "title"})


def make_plain(text: str) -> str:
    """Return the text of a comment without HTML: paragraphs, lines and items of lists stay apart."""
    text = text.replace("\r\n", "\n").replace("\r", "\n")
    if not _HTML_BEGINNING.match(text):
        return text.strip()
    reader = _TextReader()
    reader.feed(text)
    reader.close()
    lines = [" ".join(line.split()) for line in "".join(reader.words).split("\n")]
    return re.sub(r"\n{3,}", "\n\n", "\n".join(lines)).strip()


class _TextReader(HTMLParser):
    """Collects what a reader of the page would see."""

    def __init__(self) -> None:
        super().__init__(convert_charrefs=True)
        self.words: list[str] = []
        self._unseen = 0

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:  # noqa: ARG002 - HTMLParser's
        if tag in _UNSEEN:
            self._unseen += 1
        elif tag in _PARAGRAPHS:
            self.words.append("\n\n")
        elif tag in {"br", "tr"}:
            self.words.append("\n")
        elif tag == "li":
            self.words.append("\n- ")

    def handle_endtag(self, tag: str) -> None:
        if tag in _UNSEEN:
            self._unseen = max(0, self._unseen - 1)
        elif tag in _PARAGRAPHS:
            self.words.append("\n\n")

    def handle_data(self, data: str) -> None:
        if not self._unseen:
            # Line breaks of the file mean nothing in HTML.
            self.words.append(" ".join(data.split("\n")))
