"""What the writers of all pieces share: the document, its styles and paper, ids that are used, headings and captions so far.

The finished file is python-docx's parts as a zip that is the same bytes each time. `Package.save` stamps each file of the
zip with the time of day, and deflates pictures that are deflated already: 0.76 s for the 13 MB of example_ramcip, where this
takes 0.19 s and the whole report 1.2 s.
"""

from __future__ import annotations

import io
import re
import zipfile
from collections.abc import Callable, Iterable, Mapping, Sequence
from functools import cache
from pathlib import Path
from urllib.parse import quote, urlsplit

from docx.document import Document
from docx.opc.constants import CONTENT_TYPE, RELATIONSHIP_TYPE
from docx.opc.oxml import CT_Types, serialize_part_xml
from docx.opc.packuri import CONTENT_TYPES_URI, PACKAGE_URI, PackURI
from docx.opc.part import Part
from docx.opc.spec import default_content_types
from docx.oxml.ns import nsdecls, qn
from docx.oxml.parser import parse_xml
from docx.package import Package
from docx.parts.image import ImagePart
from lxml import etree

from archgen.emit.docx.list_numbering import ListNumbering
from archgen.emit.docx.page_flow import PaperSet
from archgen.emit.docx.style_table import StyleTable
from archgen.emit.docx.word_xml import name_bookmark, name_label_bookmark
from archgen.emit.office_package import STAMP, replace_forbidden
from archgen.emit.picture import Picture
from archgen.frozen import dataclass, field

_COMPRESSED_ENDINGS = (".png", ".jpeg", ".jpg", ".gif")
SVG_TYPE = "image/svg+xml"
_DEFAULT_TYPES = {*default_content_types, ("svg", SVG_TYPE)}


def save_package(package: Package) -> bytes:
    """Return a package as bytes: files sorted by name and stamped alike, the content types first as readers expect."""
    # A part that is reached under one name twice is written once; the relationships are walked in their order.
    parts: dict[PackURI, Part] = {}
    for part in package.iter_parts():
        parts.setdefault(part.partname, part)
    files: dict[str, bytes | str] = {PACKAGE_URI.rels_uri.membername: package.rels.xml}
    for name, part in parts.items():
        files[name.membername] = part.blob
        if part.rels:
            files[name.rels_uri.membername] = part.rels.xml
    target = io.BytesIO()
    with zipfile.ZipFile(target, "w") as archive:
        _write_file(archive, CONTENT_TYPES_URI.membername, _list_content_types(parts.values()))
        for file in sorted(files):
            _write_file(archive, file, files[file])
    return target.getvalue()


def _list_content_types(parts: Iterable[Part]) -> bytes:
    """Return the part that says what each part is: by its ending where that is usual, else by its name."""
    defaults = {"rels": CONTENT_TYPE.OPC_RELATIONSHIPS, "xml": CONTENT_TYPE.XML}
    overrides: dict[str, str] = {}
    for part in parts:
        ending = part.partname.ext.lower()
        if (ending, part.content_type) in _DEFAULT_TYPES and defaults.get(
            ending, part.content_type
        ) == part.content_type:
            defaults[ending] = part.content_type
        else:
            overrides[part.partname] = part.content_type
    # Made here and not by python-docx's writer, whose list of usual endings lacks SVG: each drawing would be named by itself.
    types = CT_Types.new()  # type: ignore[no-untyped-call] # as all of this module of python-docx
    for ending, content_type in sorted(defaults.items()):
        types.add_default(ending, content_type)
    for name, content_type in sorted(overrides.items()):
        types.add_override(name, content_type)
    return serialize_part_xml(types)


def _write_file(archive: zipfile.ZipFile, name: str, data: bytes | str) -> None:
    info = zipfile.ZipInfo(name, STAMP)
    info.create_system = 0  # the same on every platform
    method = zipfile.ZIP_STORED if name.lower().endswith(_COMPRESSED_ENDINGS) else zipfile.ZIP_DEFLATED
    # Drawings are most of what is deflated: of the 6 MB of example_ramcip level 9 saves 0.1 against level 5.
    archive.writestr(info, data, method, compresslevel=9 if name.endswith(".svg") else 6)


_IMAGE_TYPES = {
    "png": CONTENT_TYPE.PNG,
    "jpeg": CONTENT_TYPE.JPEG,
    "gif": CONTENT_TYPE.GIF,
    "svg": SVG_TYPE,
}


ColumnMeasures = tuple[list[float], list[float], list[float]]
"""Of each column of a table the width of its longest word, of its longest line, and of its longest word where all names are
broken, in points.
"""


@dataclass(frozen=True, slots=True)
class ContentsEntry:
    """A line of one of the tables of contents. `level` is 1 for lists of figures and tables."""

    bookmark: str
    label: str
    title: str
    level: int = 1


@dataclass(slots=True)
class DocxWriter:
    """The state of a report while it is written. `anchors` are all that references may point at.

    `chapter_files` returns the bytes of a picture by its path in the project. `heading_counts` are the numbers of the
    headings that stand open, one for each level. `part_names` are those of all parts of the package.
    `column_measures` has those of the outline's tables, by the id of a table and the style of its text.
    """

    document: Document
    styles: StyleTable
    numbering: ListNumbering
    paper: PaperSet
    pictures: Mapping[str, Picture]
    chapter_files: Callable[[str], bytes | None]
    anchors: frozenset[str]
    part_names: set[str] = field(default_factory=set)
    column_measures: dict[tuple[int, str], ColumnMeasures] = field(default_factory=dict)
    last_id: int = 0
    headings: list[ContentsEntry] = field(default_factory=list)
    figures: list[ContentsEntry] = field(default_factory=list)
    tables: list[ContentsEntry] = field(default_factory=list)
    heading_counts: list[int] = field(default_factory=list)
    warnings: list[str] = field(default_factory=list)
    bookmark_anchors: set[str] = field(default_factory=set)
    relation_count: int = 0
    link_relations: dict[str, str | None] = field(default_factory=dict)
    image_relations: dict[tuple[str, str], str] = field(default_factory=dict)

    def take_id(self) -> int:
        """Return an id that no bookmark and no drawing of the document has."""
        self.last_id += 1
        return self.last_id

    def format_bookmark(self, anchor: str | None) -> str:
        """Return an empty bookmark for an anchor, once; nothing for an anchor that has one."""
        if not anchor or anchor in self.bookmark_anchors:
            return ""
        self.bookmark_anchors.add(anchor)
        number = self.take_id()
        # Without words in it, it may stand before anything, and no edit of the words takes it away.
        return f'<w:bookmarkStart w:id="{number}" w:name="{name_bookmark(anchor)}"/><w:bookmarkEnd w:id="{number}"/>'

    def format_label(self, anchor: str, label: str) -> str:
        """Return the label and number of a caption inside of a bookmark, which sentences refer to."""
        number = self.take_id()
        start = f'<w:bookmarkStart w:id="{number}" w:name="{name_label_bookmark(anchor)}"/>'
        return f'{start}{label}<w:bookmarkEnd w:id="{number}"/>'

    def list_labels(self) -> dict[str, str]:
        """Return the labels of all captions by their bookmarks."""
        return {entry.bookmark: entry.label for entry in (*self.figures, *self.tables)}

    def find_free_anchor(self, anchor: str) -> str:
        """Return an anchor without a bookmark: the one that is wanted, or it with a number."""
        # Sections of one title have one anchor, and of two bookmarks with one name Word drops the second.
        free, count = anchor, 2
        while free in self.bookmark_anchors:
            free, count = f"{anchor}#{count}", count + 1
        return free

    def relate_link(self, url: str) -> str | None:
        """Return the relationship of an address outside; None if Word could not open it, or should not."""
        if url not in self.link_relations:
            address = quote_address(url)
            relation = None if address is None else self._add_relation(RELATIONSHIP_TYPE.HYPERLINK, address)
            self.link_relations[url] = relation
        return self.link_relations[url]

    def relate_image(self, key: str, kind: str, data: bytes) -> str:
        """Return the relationship of a picture's bytes, which are stored once for each key."""
        if (key, kind) not in self.image_relations:
            # Not by `get_or_add_image_part`, which takes no SVG and reads each picture once more for its size.
            part = ImagePart(self._find_image_name(kind), _IMAGE_TYPES[kind], data)
            self.image_relations[key, kind] = self._add_relation(RELATIONSHIP_TYPE.IMAGE, part)
        return self.image_relations[key, kind]

    def warn(self, text: str) -> None:
        """Say something about the report to who writes it, once."""
        text = replace_forbidden(text)
        if text not in self.warnings:
            self.warnings.append(text)

    def find_contents(self, kind: str) -> Sequence[ContentsEntry]:
        """Return the entries of the list of figures or tables."""
        return self.figures if kind == "Figure" else self.tables

    def _add_relation(self, relation_type: str, target: Part | str) -> str:
        """Return the id of a new relationship of the document; a target that is text lies outside.

        Not by python-docx's `relate_to`, which compares with all relationships and then tries all ids from 1: two thousand
        links take 0.9 s.
        """
        relations = self.document.part.rels
        self.relation_count += 1
        while f"ag{self.relation_count}" in relations:
            self.relation_count += 1
        relation_id = f"ag{self.relation_count}"
        relations.add_relationship(relation_type, target, relation_id, isinstance(target, str))
        return relation_id

    def _find_image_name(self, kind: str) -> PackURI:
        """Return a part name that is free: a template may be a report from before, with its own pictures on its cover."""
        folder = self.document.part.partname.baseURI.rstrip("/")
        number = len(self.image_relations) + 1
        while f"{folder}/media/archgen{number}.{kind}" in self.part_names:
            number += 1
        name = f"{folder}/media/archgen{number}.{kind}"
        self.part_names.add(name)
        return PackURI(name)


_HOST = re.compile(r"(?:[^@/\s]*@)?(?:[A-Za-z0-9](?:[A-Za-z0-9.-]*[A-Za-z0-9])?)(?::[0-9]{1,5})?\Z")
_MAIL = re.compile(r"mailto:[A-Za-z0-9._%+-]+@[A-Za-z0-9.-]+(?:\?[^\s]*)?\Z")
_MAX_LENGTH = 2000
"""Word takes 2,083 characters at most."""


def quote_address(url: str) -> str | None:
    """Return an address as a relationship may hold it; None if it is none that a reader should follow."""
    try:
        scheme = urlsplit(url).scheme.lower()
        host = urlsplit(url).netloc
    except ValueError:
        return None
    address = quote(url, safe="%/:=&?~#+!$,;'@()*[]-._", errors="replace")
    # A relationship's target must be a URI (ECMA-376 part 2): with half of an escape in it the file is damaged.
    if len(address) > _MAX_LENGTH or re.search(r"%(?![0-9A-Fa-f]{2})", address):
        return None
    if scheme == "mailto":
        return address if _MAIL.match(address) else None
    return address if scheme in {"http", "https"} and _HOST.match(host) else None


CODE_FONT = "DejaVu Sans Mono"
_FONT_TABLE_TYPE = "application/vnd.openxmlformats-officedocument.wordprocessingml.fontTable+xml"
_FONT_TYPE = "application/vnd.openxmlformats-officedocument.obfuscatedFont"
_FONT_RELATION = "http://schemas.openxmlformats.org/officeDocument/2006/relationships/font"
_KEY = "5A1D8C0E-3B7F-4E52-9C61-A7D20F4B8E13"
_HIDDEN_BYTES = 32
_BEFORE_EMBEDDING = ("writeProtection", "view", "zoom", "removePersonalInformation", "removeDateAndTime",
    "doNotDisplayPageBoundaries", "displayBackgroundShape", "printPostScriptOverText", "printFractionalCharacterWidth",
    "printFormsData")  # fmt: skip
"""What stands before the word that fonts are embedded (ECMA-376 17.15.1.78)."""


def embed_code_font(document: Document, styles: StyleTable) -> None:
    """Put the face of code into the package, if its style is set in that face: a template may have another."""
    if styles.find_font("Inline Code") != CODE_FONT:
        return
    part = document.part
    old = next((each for each in part.rels.values() if each.reltype == RELATIONSHIP_TYPE.FONT_TABLE), None)
    root = _read_fonts(old.target_part.blob if old else b"")
    if any(each.get(qn("w:name")) == CODE_FONT for each in root.iterfind(qn("w:font"))):
        return
    # The id is one that no other font of a template's table has.
    relation_id = "archgenFont"
    root.append(
        parse_xml(
            f'<w:font {nsdecls("w", "r")} w:name="{CODE_FONT}"><w:altName w:val="Consolas"/><w:charset w:val="00"/>'
            '<w:family w:val="modern"/><w:pitch w:val="fixed"/>'
            f'<w:embedRegular r:id="{relation_id}" w:fontKey="{{{_KEY}}}"/></w:font>'
        )
    )
    data = etree.tostring(root, xml_declaration=True, encoding="UTF-8", standalone=True)
    name = old.target_part.partname if old else PackURI("/word/fontTable.xml")
    filled = Part(name, _FONT_TABLE_TYPE, data, part.package)
    for relation in old.target_part.rels.values() if old else ():
        target = relation.target_ref if relation.is_external else relation.target_part
        filled.load_rel(relation.reltype, target, relation.rId, relation.is_external)
    font = Part(PackURI("/word/fonts/archgen.odttf"), _FONT_TYPE, _hide_font(), part.package)
    filled.load_rel(_FONT_RELATION, font, relation_id)
    if old:
        part.load_rel(RELATIONSHIP_TYPE.FONT_TABLE, filled, old.rId)
    else:
        part.relate_to(filled, RELATIONSHIP_TYPE.FONT_TABLE)
    settings = document.settings.element
    if settings.find(qn("w:embedTrueTypeFonts")) is None:
        before = {qn(f"w:{each}") for each in _BEFORE_EMBEDDING}
        place = sum(item.tag in before for item in settings)
        settings.insert(place, parse_xml(f"<w:embedTrueTypeFonts {nsdecls('w')}/>"))


def _read_fonts(data: bytes) -> etree._Element:
    """Return the table of a template's fonts, an empty one where it has none that can be read."""
    empty = parse_xml(f"<w:fonts {nsdecls('w', 'r')}/>")
    try:
        root = parse_xml(data) if data else empty
    except etree.XMLSyntaxError:
        return empty
    return root if root.tag == qn("w:fonts") else empty


@cache
def _hide_font() -> bytes:
    """Return the font as Word wants it: its first bytes mixed with the key (ECMA-376 17.8.1)."""
    data = bytearray((Path(__file__).resolve().parent / "fonts" / "DejaVuSansMono.ttf").read_bytes())
    key = bytes.fromhex(_KEY.replace("-", ""))[::-1]
    for at in range(_HIDDEN_BYTES):
        data[at] ^= key[at % len(key)]
    return bytes(data)
