"""Write the index of the site's search: classic scripts that a page loads when somebody starts to search, so that it works
from the disk too.

`assets/search/index.js` names the parts in the order in which they are loaded: names by kind, and then texts. Each part is
a few long strings with a line for each entry, which browsers read many times faster than a list of records.
"""

from __future__ import annotations

import json
from collections.abc import Iterable, Iterator, Sequence

from archgen.emit.site.html_text import replace_forbidden
from archgen.emit.site.page_links import SiteLinks
from archgen.views.search.search_entry import SearchEntry

MAX_PART_BYTES = 250_000
"""The bytes of a part before it is written as a script. A larger one would hold up the page while it is read."""
_EMPTY_BOX_FINDINGS = 3
_EXAMPLE_PREFIXES = ("owner:", "tag:", "host:")

_Row = tuple[SearchEntry, str]


def build_search_files(entries: Iterable[SearchEntry], links: SiteLinks) -> Iterator[tuple[str, bytes]]:
    """Yield the files of the index. Entries that lead nowhere in this site are left out."""
    rows = [(entry, address) for entry in entries if (address := _find_address(entry, links)) is not None]
    rows_by_kind: dict[str, list[_Row]] = {}
    for row in rows:
        rows_by_kind.setdefault(row[0].kind, []).append(row)
    scripts = [*_write_names(rows_by_kind), *_write_texts(rows_by_kind)]
    index = {
        "parts": [name for name, _ in scripts],
        "count": len(rows),
        "open": [
            [entry.title, entry.line, entry.kind, address]
            for entry, address in rows_by_kind.get("finding", ())[:_EMPTY_BOX_FINDINGS]
        ],
        "examples": _choose_examples(rows),
    }
    yield _make_script("index", ("index", index))
    yield from (_make_script(name, call) for name, call in scripts)


def _find_address(entry: SearchEntry, links: SiteLinks) -> str | None:
    """Return where an entry leads to, relative to the site's folder."""
    addresses = (links.pages.get(ref) or links.places.get(ref) for ref in entry.refs)
    return next((address for address in addresses if address), None)


def _write_names(rows_by_kind: dict[str, list[_Row]]) -> Iterator[tuple[str, tuple[object, ...]]]:
    """Yield the name and the arguments of each part: `title, line, keys` with tabs between, and the addresses."""
    for kind, rows in rows_by_kind.items():
        lines = [
            ("\t".join(map(_join_lines, (entry.title, entry.line, " ".join(entry.keys)))), address)
            for entry, address in rows
        ]
        for number, part in enumerate(_split_by_size(lines), 1):
            texts, addresses = zip(*part, strict=True)
            yield (
                f"{_file_stem(kind)}-{number}",
                ("names", kind, "\n".join(texts), "\n".join(_blank_repeated(addresses))),
            )


def _write_texts(rows_by_kind: dict[str, list[_Row]]) -> Iterator[tuple[str, tuple[object, ...]]]:
    """Yield the name and the arguments of each part with texts: `row text`, by the place of the row in its kind."""
    for kind, rows in rows_by_kind.items():
        lines = [
            (f"{place}\t{piece}",)
            for place, (entry, _) in enumerate(rows)
            for piece in _split_text(_join_lines(entry.text))
        ]
        for number, part in enumerate(_split_by_size(lines), 1):
            yield f"{_file_stem(kind)}-text-{number}", ("texts", kind, "\n".join(line for (line,) in part))


def _split_by_size(lines: Sequence[tuple[str, ...]]) -> Iterator[list[tuple[str, ...]]]:
    """Split lines into parts that are small enough; a line is never broken."""
    part: list[tuple[str, ...]] = []
    part_size = 0
    for line in lines:
        size = sum(len(field.encode()) + 2 for field in line)
        if part and part_size + size > MAX_PART_BYTES:
            yield part
            part, part_size = [], 0
        part.append(line)
        part_size += size
    if part:
        yield part


def _split_text(text: str) -> Iterator[str]:
    """Yield a text in pieces that fit into a part, broken at blanks. The page joins them."""
    limit = MAX_PART_BYTES // 8
    while len(text) > limit:
        end = text.rfind(" ", 0, limit) + 1 or limit
        yield text[:end]
        text = text[end:]
    if text:
        yield text


def _blank_repeated(addresses: Sequence[str]) -> Iterator[str]:
    """Yield addresses, empty where one is as the one before: the ports of a component lead to the same table."""
    previous = ""
    for address in addresses:
        yield "" if address == previous else address
        previous = address


def _choose_examples(rows: Iterable[_Row]) -> list[str]:
    """Return the first selector of each sort that finds something here."""
    keys = [key for entry, _ in rows for key in entry.keys if key.startswith(_EXAMPLE_PREFIXES)]
    firsts = (next((key for key in keys if key.startswith(prefix)), None) for prefix in _EXAMPLE_PREFIXES)
    return [_join_lines(key) for key in firsts if key]


def _file_stem(kind: str) -> str:
    return kind.replace(" ", "-")


def _join_lines(text: str) -> str:
    """Return a text on one line: lines and tabs separate entries and their fields."""
    return " ".join(replace_forbidden(text).split())


def _make_script(name: str, call: tuple[object, ...]) -> tuple[str, bytes]:
    """Make a script that hands plain data to the page's search: `call` is a function's name and its arguments."""
    function, *arguments = call
    data = ",".join(json.dumps(argument, ensure_ascii=False, separators=(",", ":")) for argument in arguments)
    return f"assets/search/{name}.js", f"archgenSearch.{function}({data});\n".encode()
