"""Write what the explorer's page and the search read: classic scripts, so that both work from the disk."""

from __future__ import annotations

import json
from collections.abc import Iterable, Iterator, Sequence

from archgen.emit.site import html_text
from archgen.emit.site.html_text import replace_forbidden
from archgen.emit.site.page_links import SiteLinks
from archgen.grouping import group_pairs
from archgen.views.explorer.map_shapes import LINKED_TABLES, ExplorerMap, Row
from archgen.views.search.entry_ranking import QUESTION_WORDS
from archgen.views.search.search_entry import SearchEntry
from archgen.views.shapes import Page, split_anchor

EXPLORER_ANCHOR = "page:explorer"
"""The anchor of the explorer's page."""
EXPLORER_STYLE = "assets/explorer/explorer.css"
_BEGIN_SCRIPT = "assets/explorer/data.js"
"""Runs before anything is drawn, so that the static page does not show first."""
_SAVE_SCRIPT = "assets/save.js"
"""Saves pictures; other pages load it when somebody asks for one."""
_PAGE_SCRIPTS = (
    "grammar",
    "properties",
    "closest",
    "select",
    "colours",
    "state",
    "choice",
    "visible",
    "words",
    "layout",
    "routes",
    "drawing",
    "light",
    "camera",
    "minimap",
    "durations",
    "panel",
    "tools",
    "legend",
    "list",
    "keys",
    "main",
)
"""The page's own scripts, in the order in which they build on one another."""
_MAX_PART_LETTERS = 200_000
"""The letters of one script: larger ones would hold up the page while they are read."""
_ELEMENT_KINDS = frozenset({"component", "component_type", "group", "node", "host"})
"""Kinds of pages whose element is on the map."""


def build_explorer_files(explorer_map: ExplorerMap, links: SiteLinks) -> dict[str, bytes]:
    """Return the scripts with the tables, by path, in the order in which the page reads them."""
    files: dict[str, bytes] = {}
    calls: list[str] = []
    size = 0
    for call in _write_calls(explorer_map, links):
        if calls and size + len(call) > _MAX_PART_LETTERS:
            files[_part_path(len(files))] = "".join(calls).encode()
            calls, size = [], 0
        calls.append(call)
        size += len(call)
    files[_part_path(len(files))] = "".join(calls).encode()
    return files


def list_explorer_scripts(map_parts: Sequence[str]) -> tuple[str, tuple[str, ...]]:
    """Return the path of the script that begins, and of those that run when the page is read."""
    return _BEGIN_SCRIPT, (*map_parts, _SAVE_SCRIPT, *(f"assets/explorer/{name}.js" for name in _PAGE_SCRIPTS))


def find_explorer_address(page: Page, links: SiteLinks) -> str | None:
    """Return the address that shows a page's element on the map, relative to the site's folder; None if it has none.

    Of a component type all instances are lit.
    """
    kind, element_id = split_anchor(page.anchor)
    if EXPLORER_ANCHOR not in links.pages or kind not in _ELEMENT_KINDS:
        return None
    level = {"node": "nodes", "host": "hosts"}.get(kind, "components")
    # Ids have no letter that an address would have to write in another way, but for those of strangers' files.
    from urllib.parse import quote

    choice = ("sel", f"is:{element_id}") if kind == "component_type" else ("pick", element_id)
    return f"{links.pages[EXPLORER_ANCHOR]}#level={level}&{choice[0]}={quote(choice[1], safe='')}"


def _part_path(number: int) -> str:
    return f"assets/explorer/data-{number + 1}.js"


def _write_calls(explorer_map: ExplorerMap, links: SiteLinks) -> Iterator[str]:
    """Yield a call for each table, several for a long one; and one with the icons of states, which pages have as well."""
    for name, rows in {**explorer_map.tables, "icons": html_text.list_icons()}.items():
        texts = [_write_row(row, name, links) for row in rows]
        while texts:
            size, count = 0, 0
            while count < len(texts) and (not count or size + len(texts[count]) < _MAX_PART_LETTERS - 100):
                size += len(texts[count]) + 1
                count += 1
            yield f"archgenExplorer.addRows({json.dumps(name)},[{','.join(texts[:count])}]);\n"
            texts = texts[count:]


def _write_row(row: Row, table: str, links: SiteLinks) -> str:
    if table in LINKED_TABLES:
        anchor, *values = row
        row = (links.pages.get(str(anchor)) or links.places.get(str(anchor)) or "", *values)
    return replace_forbidden(json.dumps(row, ensure_ascii=False, separators=(",", ":")))


MAX_PART_BYTES = 250_000
"""The bytes of a part before it is written as a script. A larger one would hold up the page while it is read."""
_EMPTY_BOX_FINDINGS = 3
_EXAMPLE_PREFIXES = ("owner:", "tag:", "host:")

_Row = tuple[SearchEntry, str]


def build_search_files(entries: Iterable[SearchEntry], links: SiteLinks) -> Iterator[tuple[str, bytes]]:
    """Yield the files of the index. Entries that lead nowhere in this site are left out."""
    rows = [(entry, address) for entry in entries if (address := _find_address(entry, links)) is not None]
    rows_by_kind = group_pairs((row[0].kind, row) for row in rows)
    scripts = [*_write_names(rows_by_kind), *_write_texts(rows_by_kind)]
    index = {
        "parts": [name for name, _ in scripts],
        "count": len(rows),
        "open": [
            [entry.title, entry.line, entry.kind, address]
            for entry, address in rows_by_kind.get("finding", ())[:_EMPTY_BOX_FINDINGS]
        ],
        "examples": _choose_examples(rows),
        "questionWords": QUESTION_WORDS,
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
