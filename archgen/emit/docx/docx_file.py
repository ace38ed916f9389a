"""The finished file: python-docx's parts as a zip that is the same bytes each time.

`Package.save` stamps each file of the zip with the time of day, and deflates pictures that are deflated already: 0.76 s for the
13 MB of example_ramcip, where this takes 0.19 s and the whole report 1.2 s.
"""

from __future__ import annotations

import io
import zipfile
from collections.abc import Iterable

from docx.opc.constants import CONTENT_TYPE
from docx.opc.oxml import CT_Types, serialize_part_xml
from docx.opc.packuri import CONTENT_TYPES_URI, PACKAGE_URI, PackURI
from docx.opc.part import Part
from docx.opc.spec import default_content_types
from docx.package import Package

from archgen.emit.office_package import STAMP

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
