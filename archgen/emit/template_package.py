"""A partner's template as the parts of its package: bounded, well-formed, without macros."""

from __future__ import annotations

import io
import zipfile
import zlib
from collections.abc import Mapping

from lxml import etree

_MAX_PARTS = 4_000
_MAX_BYTES = 200_000_000
# A compound file: what offices write for a document with a password, and what every old file is.
_OLE_SIGNATURE = b"\xd0\xcf\x11\xe0\xa1\xb1\x1a\xe1"
_ZIP_ERRORS = (zipfile.BadZipFile, zlib.error, EOFError, NotImplementedError, RuntimeError, OSError, ValueError)
_OLD_FORMATS = {
    "Word": "an old .doc file: save it as a Word document (.docx)",
    "PowerPoint": "an old .ppt file: save it as .pptx",
}
_CONTENT_TYPES = "[Content_Types].xml"
_TYPES = "{http://schemas.openxmlformats.org/package/2006/content-types}"
_MACRO_SIGNS = ("macroEnabled", "vbaProject", "vbaData", "activeX")
_SAFE_FORMATS = {"Word": ".docx or .dotx", "PowerPoint": ".pptx or .potx"}


class TemplateError(ValueError):
    """The file given as a template cannot be used. The message is for the user."""


def unpack_template(data: bytes, program: str = "Word") -> dict[str, bytes]:
    """Return the parts of a file of Word or PowerPoint by name, without a slash in front.

    Raise TemplateError if it is too large or no zip.
    """
    if data.startswith(_OLE_SIGNATURE):
        raise TemplateError(f"the template is protected with a password or is {_OLD_FORMATS[program]}")
    try:
        with zipfile.ZipFile(io.BytesIO(data)) as archive:
            return _read_bounded_parts(archive)
    except TemplateError:
        raise
    except _ZIP_ERRORS as error:
        raise TemplateError(f"the template is no {program} file: it cannot be opened as a package ({error})") from None


def parse_part(data: bytes, name: str) -> etree._Element:
    """Return the root of a part: no document type, no entity, nothing fetched. Raise TemplateError if it is not well-formed."""
    parser = etree.XMLParser(
        resolve_entities=False, no_network=True, load_dtd=False, huge_tree=False, remove_comments=True, remove_pis=True
    )
    try:
        root = etree.fromstring(data, parser)
    except (etree.XMLSyntaxError, ValueError) as error:
        raise TemplateError(f"the template is damaged: its part `{name}` is not well-formed XML ({error})") from None
    # python-docx leaves entities unresolved too, but a part that needs them would lose its text without a word.
    if root.getroottree().docinfo.internalDTD is not None:
        message = f"the template is refused: its part `{name}` declares a document type, which no office writes"
        raise TemplateError(message)
    return root


def _read_bounded_parts(archive: zipfile.ZipFile) -> dict[str, bytes]:
    """Return all parts, but never more than such a file can sensibly hold."""
    entries = [entry for entry in archive.infolist() if not entry.is_dir()]
    if len(entries) > _MAX_PARTS:
        raise TemplateError(f"the template is refused: it has {len(entries)} parts, more than {_MAX_PARTS}")
    parts: dict[str, bytes] = {}
    remaining = _MAX_BYTES
    for entry in entries:
        # The bytes are counted as they are unpacked: sizes that stand in the zip may lie, whatever their ratio.
        with archive.open(entry) as stream:
            content = stream.read(remaining + 1)
        remaining -= len(content)
        if remaining < 0:
            raise TemplateError(f"the template is refused: unpacked it is larger than {_MAX_BYTES // 1_000_000} MB")
        parts[entry.filename.lstrip("/")] = content
    return parts


def read_content_types(parts: dict[str, bytes], program: str = "Word") -> dict[str, str]:
    """Take the content types out of the parts; return the type of each part by its name. Refuse macros."""
    listing = parts.pop(_CONTENT_TYPES, None)
    if listing is None:
        raise TemplateError(f"the template is no {program} file: it is a zip file without `{_CONTENT_TYPES}`")
    root = parse_part(listing, _CONTENT_TYPES)
    if any(sign in item.get("ContentType", "") for item in root for sign in _MACRO_SIGNS):
        raise TemplateError(
            f"the template is refused: it holds macros or controls; save it as {_SAFE_FORMATS[program]} without them"
        )
    endings = {
        item.get("Extension", "").lower(): item.get("ContentType", "") for item in root.iterfind(f"{_TYPES}Default")
    }
    overrides = {
        item.get("PartName", "").lstrip("/"): item.get("ContentType", "") for item in root.iterfind(f"{_TYPES}Override")
    }
    return {
        name: overrides.get(name) or endings.get(name.rpartition(".")[2].lower()) or "application/octet-stream"
        for name in parts
    }


def zip_parts(parts: Mapping[str, bytes], types: Mapping[str, str]) -> bytes:
    """Return parts as a zip without compression, with a content type for each of them."""
    # By name for all: libraries ask for the type of each part, and raise KeyError where an ending has none.
    root = etree.fromstring(f'<Types xmlns="{_TYPES[1:-1]}"/>')
    for name, content_type in types.items():
        etree.SubElement(root, f"{_TYPES}Override", PartName=f"/{name}", ContentType=content_type)
    target = io.BytesIO()
    with zipfile.ZipFile(target, "w") as archive:
        for name, content in {_CONTENT_TYPES: etree.tostring(root), **parts}.items():
            archive.writestr(name, content)
    return target.getvalue()
