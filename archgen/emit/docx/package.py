"""Open Packaging: the zip file of parts, content types and relationships that a Word file is.

Reading trusts nothing: the file may be broken, a zip bomb, or no zip at all. Writing gives the same bytes for the same parts.
"""

from __future__ import annotations

import io
import posixpath
import zipfile
import zlib
from dataclasses import dataclass, field
from pathlib import Path
from urllib.parse import unquote

from lxml import etree

_TYPES = "http://schemas.openxmlformats.org/package/2006/content-types"
_RELATIONS = "http://schemas.openxmlformats.org/package/2006/relationships"
_MOST_PARTS = 4_000
_MOST_BYTES = 200_000_000
_STAMP = (1980, 1, 1, 0, 0, 0)
_PACKED_ALREADY = (".png", ".jpeg", ".jpg", ".gif")
_OLE = b"\xd0\xcf\x11\xe0\xa1\xb1\x1a\xe1"
_BROKEN = (zipfile.BadZipFile, zlib.error, EOFError, NotImplementedError, RuntimeError, OSError, ValueError)


class TemplateError(ValueError):
    """The file given as a template cannot be used. The message is for the user."""


@dataclass(frozen=True, slots=True)
class Relation:
    """One relationship of a part: what it needs, and where that is."""

    id: str
    type: str
    target: str
    external: bool = False

    @property
    def kind(self) -> str:
        """The last word of the type: `styles`, `image`, `hyperlink`."""
        return self.type.rpartition("/")[2]


@dataclass(slots=True)
class Package:
    """The parts by name (without a slash in front), and the content types by name and by ending."""

    parts: dict[str, bytes] = field(default_factory=dict)
    types: dict[str, str] = field(default_factory=dict)
    endings: dict[str, str] = field(default_factory=dict)

    def type_of(self, name: str) -> str:
        """Give the content type of a part, empty if the package has none for it."""
        return self.types.get(name) or self.endings.get(name.rpartition(".")[2].lower(), "")

    def add(self, name: str, data: bytes, content_type: str) -> None:
        """Put a part in, or in the place of one of that name."""
        self.parts[name] = data
        ending = name.rpartition(".")[2].lower()
        if ending == "xml" or self.endings.setdefault(ending, content_type) != content_type:
            self.types[name] = content_type

    def remove(self, name: str) -> None:
        """Take a part out, with its relationships."""
        for gone in (name, relations_name(name)):
            self.parts.pop(gone, None)
            self.types.pop(gone, None)

    def relations(self, name: str) -> list[Relation]:
        """Give the relationships of a part; of the package itself for an empty name."""
        data = self.parts.get(relations_name(name))
        if data is None:
            return []
        folder = posixpath.dirname(name)
        found = []
        for item in parse(data, relations_name(name)):
            external = item.get("TargetMode") == "External"
            target = item.get("Target", "")
            found.append(
                Relation(
                    item.get("Id", ""), item.get("Type", ""), target if external else _inside(folder, target), external
                )
            )
        return found

    def relate(self, name: str, relations: list[Relation]) -> None:
        """Write the relationships of a part."""
        root = _root(_RELATIONS, "Relationships")
        for relation in relations:
            target = relation.target if relation.external else "/" + relation.target
            item = etree.SubElement(
                root, f"{{{_RELATIONS}}}Relationship", Id=relation.id, Type=relation.type, Target=target
            )
            if relation.external:
                item.set("TargetMode", "External")
        self.parts[relations_name(name)] = xml_bytes(root)


def relations_name(name: str) -> str:
    """Give the name of the part that holds another part's relationships."""
    folder, file = posixpath.split(name)
    return posixpath.join(folder, "_rels", f"{file}.rels")


def parse(data: bytes, name: str) -> etree._Element:
    """Parse a part of a stranger's file: no document type, no entity, nothing fetched."""
    parser = etree.XMLParser(
        resolve_entities=False, no_network=True, load_dtd=False, huge_tree=False, remove_comments=True, remove_pis=True
    )
    try:
        root = etree.fromstring(data, parser)
    except (etree.XMLSyntaxError, ValueError) as error:
        message = f"the template is damaged: its part `{name}` is not well-formed XML ({error})"
        raise TemplateError(message) from None
    if root.getroottree().docinfo.internalDTD is not None:
        message = f"the template is refused: its part `{name}` declares a document type, which Word never writes"
        raise TemplateError(message)
    return root


def xml_bytes(root: etree._Element) -> bytes:
    """Give an element as the bytes of a part."""
    return etree.tostring(root, xml_declaration=True, encoding="UTF-8", standalone=True)


def _root(namespace: str, name: str) -> etree._Element:
    """Give an empty element whose namespace needs no prefix."""
    return etree.fromstring(f'<{name} xmlns="{namespace}"/>')


def unpack(data: bytes) -> Package:
    """Read a package from the bytes of a Word file."""
    if data.startswith(_OLE):
        message = "the template is protected with a password or is an old .doc file: save it as a Word document (.docx)"
        raise TemplateError(message)
    try:
        with zipfile.ZipFile(io.BytesIO(data)) as archive:
            parts = _bounded(archive)
    except TemplateError:
        raise
    except _BROKEN as error:
        message = f"the template is no Word file: it cannot be opened as a package ({error})"
        raise TemplateError(message) from None
    return _typed(parts)


def unpacked(folder: Path) -> Package:
    """Read a package that lies unpacked in a folder, as archgen's own template does."""
    files = sorted(path for path in folder.rglob("*") if path.is_file())
    return _typed({path.relative_to(folder).as_posix(): path.read_bytes() for path in files})


def pack(package: Package) -> bytes:
    """Give the package as bytes: parts sorted, stamps fixed, the content types first as readers expect."""
    target = io.BytesIO()
    with zipfile.ZipFile(target, "w") as archive:
        _store(archive, "[Content_Types].xml", _content_types(package))
        for name in sorted(package.parts):
            _store(archive, name, package.parts[name])
    return target.getvalue()


def _bounded(archive: zipfile.ZipFile) -> dict[str, bytes]:
    """Read all parts, but never more than a Word file can sensibly be; sizes written in the file are not believed."""
    names = [item for item in archive.infolist() if not item.is_dir()]
    if len(names) > _MOST_PARTS:
        message = f"the template is refused: it has {len(names)} parts, more than {_MOST_PARTS}"
        raise TemplateError(message)
    parts: dict[str, bytes] = {}
    left = _MOST_BYTES
    for item in names:
        with archive.open(item) as stream:
            parts[item.filename.lstrip("/")] = stream.read(left + 1)
        left -= len(parts[item.filename.lstrip("/")])
        if left < 0:
            message = f"the template is refused: unpacked it is larger than {_MOST_BYTES // 1_000_000} MB"
            raise TemplateError(message)
    return parts


def _typed(parts: dict[str, bytes]) -> Package:
    """Take the content types out of the parts."""
    listing = parts.pop("[Content_Types].xml", None)
    if listing is None:
        message = "the template is no Word file: it is a zip file without `[Content_Types].xml`"
        raise TemplateError(message)
    package = Package(parts)
    for item in parse(listing, "[Content_Types].xml"):
        if item.tag == f"{{{_TYPES}}}Default":
            package.endings[item.get("Extension", "").lower()] = item.get("ContentType", "")
        elif item.tag == f"{{{_TYPES}}}Override":
            package.types[item.get("PartName", "").lstrip("/")] = item.get("ContentType", "")
    return package


def _content_types(package: Package) -> bytes:
    root = _root(_TYPES, "Types")
    endings = {
        **package.endings,
        "rels": "application/vnd.openxmlformats-package.relationships+xml",
        "xml": "application/xml",
    }
    for ending, content_type in sorted(endings.items()):
        etree.SubElement(root, f"{{{_TYPES}}}Default", Extension=ending, ContentType=content_type)
    for name, content_type in sorted(package.types.items()):
        if name in package.parts:
            etree.SubElement(root, f"{{{_TYPES}}}Override", PartName=f"/{name}", ContentType=content_type)
    return xml_bytes(root)


def _store(archive: zipfile.ZipFile, name: str, data: bytes) -> None:
    info = zipfile.ZipInfo(name, _STAMP)
    info.create_system = 0
    method = zipfile.ZIP_STORED if name.lower().endswith(_PACKED_ALREADY) else zipfile.ZIP_DEFLATED
    archive.writestr(info, data, method, compresslevel=2 if name.endswith(".svg") else 6)


def _inside(folder: str, target: str) -> str:
    """Give the name of the part that a relationship's target means."""
    path = unquote(target.partition("#")[0])
    joined = path if path.startswith("/") else posixpath.join("/", folder, path)
    return posixpath.normpath(joined).lstrip("/")
