"""What is wrong with a .docx that Microsoft's validator does not see: dangling references, fields, styles, cells and tables."""

from __future__ import annotations

import io
import posixpath
import zipfile
from collections import Counter
from collections.abc import Iterator

from lxml import etree

_W = "{http://schemas.openxmlformats.org/wordprocessingml/2006/main}"
_R = "{http://schemas.openxmlformats.org/officeDocument/2006/relationships}"
_WP = "{http://schemas.openxmlformats.org/drawingml/2006/wordprocessingDrawing}"
_STYLED = {"pStyle": "paragraph", "rStyle": "character", "tblStyle": "table"}
_BASED = ("basedOn", "next", "link")


def faults(data: bytes) -> list[str]:
    """Give a sentence for each fault; none for a sound document."""
    archive = zipfile.ZipFile(io.BytesIO(data))
    parts = {name: archive.read(name) for name in archive.namelist()}
    trees = {name: etree.fromstring(content) for name, content in parts.items() if name.endswith((".xml", ".rels"))}
    document = trees["word/document.xml"]
    found = [f"part {name} stands twice" for name, count in Counter(archive.namelist()).items() if count > 1]
    found += _references(document)
    found += _relationships(trees, parts)
    found += _tables(document)
    found += _styles(trees)
    found += [f"fields do not balance in {name}: {text}" for name, tree in trees.items() for text in _fields(tree)]
    found += [
        f"picture {item.get('id')} has no alternative text"
        for item in document.iter(f"{_WP}docPr")
        if not item.get("descr")
    ]
    if "word/settings.xml" in trees and trees["word/settings.xml"].find(f"{_W}updateFields") is not None:
        found.append("Word asks whether to update fields")
    return found


def _references(document: etree._Element) -> Iterator[str]:
    names = Counter(item.get(f"{_W}name") for item in document.iter(f"{_W}bookmarkStart"))
    yield from (f"bookmark {name} stands {count} times" for name, count in names.items() if count > 1)
    starts = Counter(item.get(f"{_W}id") for item in document.iter(f"{_W}bookmarkStart"))
    ends = Counter(item.get(f"{_W}id") for item in document.iter(f"{_W}bookmarkEnd"))
    if starts != ends or any(count > 1 for count in starts.values()):
        yield "bookmarks do not begin and end once each"
    for item in document.iter(f"{_W}hyperlink"):
        anchor = item.get(f"{_W}anchor")
        if anchor is not None and anchor not in names:
            yield f"link to the missing bookmark {anchor}"
    for item in document.iter(f"{_W}instrText"):
        words = (item.text or "").split()
        if words and words[0] in {"PAGEREF", "REF"} and words[1] not in names:
            yield f"{words[0]} to the missing bookmark {words[1]}"
    pictures = Counter(item.get("id") for item in document.iter(f"{_WP}docPr"))
    yield from (f"picture id {name} stands {count} times" for name, count in pictures.items() if count > 1)


def _relationships(trees: dict[str, etree._Element], parts: dict[str, bytes]) -> Iterator[str]:
    for name, tree in trees.items():
        if name.endswith(".rels"):
            folder = posixpath.dirname(posixpath.dirname(name))
            for item in tree:
                target = posixpath.normpath(posixpath.join("/", folder, item.get("Target", ""))).lstrip("/")
                if item.get("TargetMode") != "External" and target not in parts:
                    yield f"{name}: {item.get('Id')} leads to the missing part {target}"
            continue
        folder, file = posixpath.split(name)
        relations = trees.get(posixpath.join(folder, "_rels", f"{file}.rels"))
        known = set() if relations is None else {str(item.get("Id")) for item in relations}
        used = {str(value) for item in tree.iter() for key, value in item.attrib.items() if str(key).startswith(_R)}
        yield from (f"{name} uses the missing relationship {value}" for value in sorted(used - known))


def _tables(document: etree._Element) -> Iterator[str]:
    for cell in document.iter(f"{_W}tc"):
        if len(cell) == 0 or cell[-1].tag != f"{_W}p":
            yield "a cell ends without a paragraph"
    for table in document.iter(f"{_W}tbl"):
        following = table.getnext()
        if following is None or following.tag != f"{_W}p":
            yield "no paragraph stands behind a table"
        widths = len(table.findall(f"{_W}tblGrid/{_W}gridCol"))
        yield from (
            "a row has another number of cells than the table has columns"
            for row in table.iterfind(f"{_W}tr")
            if _spans(row) != widths
        )


def _spans(row: etree._Element) -> int:
    spans = (cell.find(f"{_W}tcPr/{_W}gridSpan") for cell in row.iterfind(f"{_W}tc"))
    return sum(1 if span is None else int(span.get(f"{_W}val", "1")) for span in spans)


def _styles(trees: dict[str, etree._Element]) -> Iterator[str]:
    listing = next(
        tree for name, tree in trees.items() if tree.tag == f"{_W}styles" and not name.startswith("word/glossary")
    )
    known = {(item.get(f"{_W}type", "paragraph"), item.get(f"{_W}styleId")) for item in listing.iterfind(f"{_W}style")}
    ids = {style for _, style in known}
    if len(ids) < len(listing.findall(f"{_W}style")):
        yield "two styles have one id"
    for item in listing.iter(*(f"{_W}{name}" for name in _BASED)):
        if item.get(f"{_W}val") not in ids:
            yield f"a style stands on the missing style {item.get(f'{_W}val')}"
    numbers = {
        item.get(f"{_W}numId")
        for tree in trees.values()
        if tree.tag == f"{_W}numbering"
        for item in tree.iterfind(f"{_W}num")
    } | {"0"}
    for name, tree in trees.items():
        for tag, kind in _STYLED.items():
            used = {item.get(f"{_W}val") for item in tree.iter(f"{_W}{tag}")}
            yield from (
                f"{name} uses the missing {kind} style {style}"
                for style in sorted(map(str, used))
                if (kind, style) not in known
            )
        used = {item.get(f"{_W}val") for item in tree.iter(f"{_W}numId")}
        yield from (f"{name} uses the missing list {number}" for number in sorted(map(str, used - numbers)))


def _fields(tree: etree._Element) -> Iterator[str]:
    stack: list[str] = []
    for item in tree.iter(f"{_W}fldChar", f"{_W}instrText"):
        kind = item.get(f"{_W}fldCharType") if item.tag == f"{_W}fldChar" else "code"
        if kind == "begin":
            stack.append("begin")
        elif not stack:
            yield f"{kind} outside of a field"
        elif kind == "separate":
            if stack[-1] == "separate":
                yield "a second separate"
            stack[-1] = "separate"
        elif kind == "end":
            stack.pop()
        elif stack[-1] != "begin":
            yield "an instruction behind the separate"
    yield from ("a field has no end" for _ in stack)
