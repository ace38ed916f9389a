"""What is shared while a report is written: numbers given out, parts and relationships added, headings and captions met."""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from urllib.parse import quote, urlsplit

from archgen.emit.docx.markup import R, bookmark_name, clean
from archgen.emit.docx.numbering import Numbering
from archgen.emit.docx.package import Package, Relation
from archgen.emit.docx.sheets import Sheets
from archgen.emit.docx.styles import Styles
from archgen.emit.picture import Picture

_HOST = re.compile(r"(?:[^@/\s]*@)?(?:[A-Za-z0-9](?:[A-Za-z0-9.-]*[A-Za-z0-9])?)(?::[0-9]{1,5})?\Z")
_MAIL = re.compile(r"mailto:[A-Za-z0-9._%+-]+@[A-Za-z0-9.-]+(?:\?[^\s]*)?\Z")
_MEDIA = {"png": "image/png", "jpeg": "image/jpeg", "gif": "image/gif", "svg": "image/svg+xml"}
_LONGEST_ADDRESS = 2000


@dataclass(frozen=True, slots=True)
class Entry:
    """A line of one of the tables of contents. `level` is 1 for lists of figures and tables."""

    mark: str
    label: str
    title: str
    level: int = 1


@dataclass(slots=True)
class Draft:
    """The state of a report being written. `anchors` are all that references may point at."""

    package: Package
    folder: str
    relations: list[Relation]
    styles: Styles
    numbering: Numbering
    sheets: Sheets
    pictures: Mapping[str, Picture]
    chapter_files: Callable[[str], bytes | None]
    anchors: frozenset[str]
    next_id: int = 1
    headings: list[Entry] = field(default_factory=list)
    figures: list[Entry] = field(default_factory=list)
    tables: list[Entry] = field(default_factory=list)
    counts: list[int] = field(default_factory=list)
    warnings: list[str] = field(default_factory=list)
    marked: set[str] = field(default_factory=set)
    links: dict[str, str] = field(default_factory=dict)
    media: dict[tuple[str, str], str] = field(default_factory=dict)

    def number(self) -> int:
        """Give an id that nothing else in the document has."""
        self.next_id += 1
        return self.next_id

    def mark(self, anchor: str | None) -> str:
        """Give an empty bookmark for an anchor, once; nothing for an anchor that has one."""
        if not anchor or anchor in self.marked:
            return ""
        self.marked.add(anchor)
        number = self.number()
        return f'<w:bookmarkStart w:id="{number}" w:name="{bookmark_name(anchor)}"/><w:bookmarkEnd w:id="{number}"/>'

    def fresh(self, anchor: str) -> str:
        """Give an anchor that no bookmark stands for yet: the one asked for, or it with a number."""
        wanted, count = anchor, 2
        while wanted in self.marked:
            wanted, count = f"{anchor}#{count}", count + 1
        return wanted

    def relate(self, kind: str, target: str, *, external: bool = False) -> str:
        """Give the id of a new relationship of the document."""
        taken = {relation.id for relation in self.relations} if len(self.links) + len(self.media) == 0 else None
        number = len(self.relations) + 1
        while taken and f"ag{number}" in taken:
            number += 1
        self.relations.append(Relation(f"ag{number}", f"{R}/{kind}", target, external))
        return f"ag{number}"

    def link(self, url: str) -> str | None:
        """Give the relationship of an address outside; None if Word could not open it, or should not."""
        if url not in self.links:
            address = address_of(url)
            self.links[url] = "" if address is None else self.relate("hyperlink", address, external=True)
        return self.links[url] or None

    def image(self, key: str, kind: str, data: bytes) -> str:
        """Give the relationship of a picture's bytes, which are stored once for each key."""
        if (key, kind) not in self.media:
            name = f"{self.folder}media/archgen{len(self.media) + 1}.{kind}"
            self.package.add(name, data, _MEDIA[kind])
            self.media[key, kind] = self.relate("image", name)
        return self.media[key, kind]

    def warn(self, text: str) -> None:
        """Say something about the report to who makes it, once."""
        text = clean(text)
        if text not in self.warnings:
            self.warnings.append(text)


def address_of(url: str) -> str | None:
    """Give an address as a relationship may hold it; None if it is none that a reader should follow."""
    try:
        scheme = urlsplit(url).scheme.lower()
        host = urlsplit(url).netloc
    except ValueError:
        return None
    address = quote(url, safe="%/:=&?~#+!$,;'@()*[]-._", errors="replace")
    if len(address) > _LONGEST_ADDRESS or re.search(r"%(?![0-9A-Fa-f]{2})", address):
        return None
    if scheme == "mailto":
        return address if _MAIL.match(address) else None
    return address if scheme in {"http", "https"} and _HOST.match(host) else None
