"""What is checked in a template's bytes before python-docx sees them: a zip of sensible size, with XML that declares nothing.

python-docx reads every part whole and believes what the zip says of itself; a partner's file is believed in nothing.
"""

from __future__ import annotations

import io
import zipfile
import zlib

from lxml import etree

_MAX_PARTS = 4_000
_MAX_BYTES = 200_000_000
# A compound file: what Word writes for a document with a password, and what every .doc is.
_OLE_SIGNATURE = b"\xd0\xcf\x11\xe0\xa1\xb1\x1a\xe1"
_ZIP_ERRORS = (zipfile.BadZipFile, zlib.error, EOFError, NotImplementedError, RuntimeError, OSError, ValueError)


class TemplateError(ValueError):
    """The file given as a template cannot be used. The message is for the user."""


def unpack_template(data: bytes) -> dict[str, bytes]:
    """Return the parts of a Word file by name, without a slash in front. Raise TemplateError if it is too large or no zip."""
    if data.startswith(_OLE_SIGNATURE):
        message = "the template is protected with a password or is an old .doc file: save it as a Word document (.docx)"
        raise TemplateError(message)
    try:
        with zipfile.ZipFile(io.BytesIO(data)) as archive:
            return _read_bounded_parts(archive)
    except TemplateError:
        raise
    except _ZIP_ERRORS as error:
        message = f"the template is no Word file: it cannot be opened as a package ({error})"
        raise TemplateError(message) from None


def parse_part(data: bytes, name: str) -> etree._Element:
    """Return the root of a part: no document type, no entity, nothing fetched. Raise TemplateError if it is not well-formed."""
    parser = etree.XMLParser(
        resolve_entities=False, no_network=True, load_dtd=False, huge_tree=False, remove_comments=True, remove_pis=True
    )
    try:
        root = etree.fromstring(data, parser)
    except (etree.XMLSyntaxError, ValueError) as error:
        message = f"the template is damaged: its part `{name}` is not well-formed XML ({error})"
        raise TemplateError(message) from None
    # python-docx leaves entities unresolved too, but a part that needs them would lose its text without a word.
    if root.getroottree().docinfo.internalDTD is not None:
        message = f"the template is refused: its part `{name}` declares a document type, which Word never writes"
        raise TemplateError(message)
    return root


def _read_bounded_parts(archive: zipfile.ZipFile) -> dict[str, bytes]:
    """Return all parts, but never more than a Word file can sensibly hold."""
    entries = [entry for entry in archive.infolist() if not entry.is_dir()]
    if len(entries) > _MAX_PARTS:
        message = f"the template is refused: it has {len(entries)} parts, more than {_MAX_PARTS}"
        raise TemplateError(message)
    parts: dict[str, bytes] = {}
    remaining = _MAX_BYTES
    for entry in entries:
        # The bytes are counted as they are unpacked: sizes that stand in the zip may lie, whatever their ratio.
        with archive.open(entry) as stream:
            content = stream.read(remaining + 1)
        remaining -= len(content)
        if remaining < 0:
            message = f"the template is refused: unpacked it is larger than {_MAX_BYTES // 1_000_000} MB"
            raise TemplateError(message)
        parts[entry.filename.lstrip("/")] = content
    return parts
