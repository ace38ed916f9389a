"""Outputs as texts that can be reviewed line by line, without what differs between platforms: sizes and page numbers."""

from __future__ import annotations

import io
import re
import zipfile
from collections.abc import Iterator
from pathlib import Path

from lxml import etree

WORD = "{http://schemas.openxmlformats.org/wordprocessingml/2006/main}"
DRAWING = "{http://schemas.openxmlformats.org/drawingml/2006/wordprocessingDrawing}"
SVG = "{http://www.w3.org/2000/svg}"


def document(path: Path | io.BytesIO) -> str:
    """Give a report: a line for each paragraph, with its style, and for each row of a table."""
    with zipfile.ZipFile(path) as package:
        body = etree.fromstring(package.read("word/document.xml"))[0]
    return "".join(f"{line}\n" for line in _blocks(body) if line.strip())


def _blocks(parent: etree._Element) -> Iterator[str]:
    for part in parent:
        if part.tag == f"{WORD}p":
            yield _paragraph(part)
        elif part.tag == f"{WORD}tbl":
            yield from (_row(row) for row in part.iterfind(f"{WORD}tr"))
        elif part.tag == f"{WORD}sdt":
            yield from _blocks(part.find(f"{WORD}sdtContent", None))  # type: ignore[arg-type]
        if part.find(f".//{WORD}sectPr") is not None or part.tag == f"{WORD}sectPr":
            yield _section(part)


def _paragraph(paragraph: etree._Element) -> str:
    style = paragraph.find(f"{WORD}pPr/{WORD}pStyle")
    text = _text(paragraph)
    return f"[{style.get(f'{WORD}val') if style is not None else ''}] {text}" if text else ""


def _row(row: etree._Element) -> str:
    header = "#" if row.find(f"{WORD}trPr/{WORD}tblHeader") is not None else ""
    cells = [" ¶ ".join(filter(None, map(_text, cell.iter(f"{WORD}p")))) for cell in row.iterfind(f"{WORD}tc")]
    return f"|{header} {' | '.join(cells)} |"


def _section(part: etree._Element) -> str:
    size = part.find(f".//{WORD}pgSz")
    turned = size is not None and size.get(f"{WORD}orient") == "landscape"
    return f"--- end of {'landscape' if turned else 'portrait'} pages"


def _text(paragraph: etree._Element) -> str:
    return "".join(_runs(paragraph)).strip()


def _runs(paragraph: etree._Element) -> Iterator[str]:
    """Give a paragraph's text; links as `text -> anchor`, fields by what they compute, page numbers as `#`."""
    paged = False
    for part in paragraph.iter():
        if part.tag == f"{WORD}instrText":
            paged = "PAGEREF" in (part.text or "")
        elif part.tag == f"{WORD}fldChar":
            paged = paged and part.get(f"{WORD}fldCharType") != "end"
        elif part.tag == f"{WORD}t":
            yield "#" if paged else part.text or ""
        elif part.tag in {f"{WORD}tab", f"{WORD}br"} and part.getparent().tag == f"{WORD}r":  # type: ignore[union-attr]
            yield " · "
        elif part.tag == f"{WORD}noBreakHyphen":
            yield "-"
        elif part.tag == f"{DRAWING}docPr":
            yield f"(picture: {part.get('descr')})"


def pictures(folder: Path) -> str:
    """Give what pictures say: for each, its boxes and arrows, whatever their places."""
    names = sorted(folder.rglob("*.svg"))
    parts = (f"## {file.relative_to(folder).as_posix()}\n{picture(file.read_bytes())}\n" for file in names)
    return "\n".join(parts)


def picture(svg: bytes) -> str:
    """Give a picture's boxes by kind and title, its arrows by what flows along them, its frames; sorted."""
    root = etree.fromstring(svg)
    lines = {_drawn(group) for group in root.iter(f"{SVG}g") if group.get("class")}
    return "".join(f"{line}\n" for line in sorted(lines) if line)


def _drawn(group: etree._Element) -> str:
    classes = [name for name in (group.get("class") or "").split() if name not in {"node", "edge", "cluster", "graph"}]
    words = _words(group, "text")
    flows = _words(group, "title")
    if not classes or classes[0] in {"bar", "title"}:
        return ""
    text = flows if classes[0] == "arrow" and flows.strip() else words
    return f"{' '.join(classes)}: {text}" if text else ""


def _words(group: etree._Element, tag: str) -> str:
    """Give the texts of one sort in a group, on one line."""
    found = (part.text or "" for part in group.iter(f"{SVG}{tag}"))
    return " ".join(filter(None, (" / ".join(filter(None, map(str.strip, text.splitlines()))) for text in found)))


def page(html: str) -> str:
    """Give a page of the site with the names of its pictures in their place."""
    return re.sub(r"<svg\b.*?</svg>", _titled, html, flags=re.DOTALL)


def _titled(found: re.Match[str]) -> str:
    title = re.search(r"<title>(.*?)</title>", found[0])
    return f"<svg>{title[1] if title else ''}</svg>"
