"""The filters of templates: they put text safely where it is needed, be it Markdown, code span, Mermaid or identifier.

The names in `TEMPLATE_FILTERS` are part of docs/backends.md.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Mapping
from functools import cache
from typing import TYPE_CHECKING, Any

from archgen.emit.markdown.inert_text import CONTROL_CHARACTER, escape_markdown, make_code_span
from archgen.emit.safe_names import make_identifier, make_slug
from archgen.emit.text.code_filters import CODE_FILTERS

if TYPE_CHECKING:
    from markdown_it import MarkdownIt

_URL_SCHEME = re.compile(r"[A-Za-z][A-Za-z0-9+.-]*:")


def safe_commonmark(text: object) -> str:
    """Return CommonMark as it is if it holds no HTML, and only relative, http, https and mailto addresses; else as
    plain text.
    """
    parser = _commonmark_parser()
    text = CONTROL_CHARACTER.sub("\ufffd", str(text))
    tokens = [token for block in parser.parse(text) for token in (block, *(block.children or ()))]
    addresses = [str(token.attrs.get(name, "")) for token in tokens for name in ("href", "src")]
    if any(token.type.startswith("html_") for token in tokens) or any(_is_strange(address) for address in addresses):
        return "\n".join(escape_markdown(line) for line in text.split("\n"))
    return text


@cache
def _commonmark_parser() -> MarkdownIt:
    """Create a parser that takes every address for a link: `_is_strange` judges them, not the library."""
    from markdown_it import MarkdownIt

    class LenientParser(MarkdownIt):
        def validateLink(self, url: str) -> bool:  # noqa: ARG002, N802 - the library's
            return True

    return LenientParser("commonmark", {"html": True})


def _is_strange(address: str) -> bool:
    return bool(_URL_SCHEME.match(address)) and not address.lower().startswith(("http://", "https://", "mailto:"))


def draw_mermaid(graph: object) -> str:
    """Write a graph, as templates get it, as a Mermaid flowchart without the fence around it; a large one is folded."""
    # Imported here, as below: most backends draw nothing, and generators are run again and again.
    from archgen.emit.markdown.mermaid_chart import fold_for_mermaid, write_flowchart
    from archgen.emit.text.plain_graphs import graph_from_plain

    return "\n".join(write_flowchart(fold_for_mermaid(graph_from_plain(graph)), has_stable_names=True))


def draw_mermaid_sequence(sequence: object) -> str:
    """Write a sequence, as templates get it, as a Mermaid sequence diagram without the fence around it."""
    from archgen.emit.markdown.mermaid_chart import write_sequence_diagram
    from archgen.emit.text.plain_graphs import sequence_from_plain

    return "\n".join(write_sequence_diagram(sequence_from_plain(sequence)))


def _escape_mermaid(text: object) -> str:
    from archgen.emit.markdown.mermaid_chart import escape_mermaid

    return escape_mermaid(str(text))


def make_escape_filter(table: Mapping[str, str]) -> Callable[[object], str]:
    """Make a filter that replaces each character of a text by its entry in the table; all others stay."""
    replacements = str.maketrans(dict(table))
    # One pass: what an entry puts in place is not replaced again, so `{"&": "&amp;"}` is safe in any order.
    return lambda text: str(text).translate(replacements)


def _write_csv_row(cells: Iterable[object]) -> str:
    """Return the cells of a row of CSV, without the end of its line."""
    from archgen.emit.csv_rows import write_csv_rows

    return write_csv_rows([["" if cell is None else str(cell) for cell in cells]]).rstrip("\r\n")


TEMPLATE_FILTERS: dict[str, Any] = {
    **CODE_FILTERS,
    "code": make_code_span,
    "csv_row": _write_csv_row,
    "commonmark": safe_commonmark,
    "identifier": make_identifier,
    "markdown": escape_markdown,
    "mermaid": _escape_mermaid,
    "mermaid_graph": draw_mermaid,
    "mermaid_sequence": draw_mermaid_sequence,
    "slug": lambda text: make_slug(str(text)),
}
