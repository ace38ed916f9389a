"""What is mended in a template so that python-docx opens what Word opens: content types, and relationships (`template_relations`).

python-docx refuses .dotx files, and raises KeyError for a part without a content type.
"""

from __future__ import annotations

import io
import zipfile

from docx.opc.constants import CONTENT_TYPE, NAMESPACE
from docx.oxml.ns import qn
from lxml import etree

from archgen.emit.docx.template_checks import TemplateError, parse_part
from archgen.emit.docx.template_relations import KIND_TYPES, find_main_target, repair_relations

_CONTENT_TYPES = "[Content_Types].xml"
_TYPES = f"{{{NAMESPACE.OPC_CONTENT_TYPES}}}"
_TEMPLATE_MAIN = "application/vnd.openxmlformats-officedocument.wordprocessingml.template.main+xml"
_STRICT_DOCUMENT = "{http://purl.oclc.org/ooxml/wordprocessingml/main}document"
_MACRO_SIGNS = ("macroEnabled", "vbaProject", "vbaData", "activeX")
_PARSED_TYPES = {*KIND_TYPES.values(), CONTENT_TYPE.WML_COMMENTS}
"""Content types that python-docx parses as soon as it opens a file, beside the main part."""


def repair_package(parts: dict[str, bytes]) -> bytes:
    """Return a template as a package that python-docx opens. Raise TemplateError if it is no Word document."""
    types = _read_content_types(parts)
    main = _find_main_part(parts, types)
    _check_document(parts, main)
    # A .dotx differs from a .docx in this alone.
    types[main] = CONTENT_TYPE.WML_DOCUMENT_MAIN
    repair_relations(parts, types, main)
    for name, content_type in types.items():
        if content_type in _PARSED_TYPES:
            parse_part(parts[name], name)
    return _zip_parts(parts, types)


def _read_content_types(parts: dict[str, bytes]) -> dict[str, str]:
    """Take the content types out of the parts; return the type of each part by its name. Refuse macros."""
    listing = parts.pop(_CONTENT_TYPES, None)
    if listing is None:
        message = f"the template is no Word file: it is a zip file without `{_CONTENT_TYPES}`"
        raise TemplateError(message)
    root = parse_part(listing, _CONTENT_TYPES)
    if any(sign in item.get("ContentType", "") for item in root for sign in _MACRO_SIGNS):
        message = "the template is refused: it holds macros or controls; save it as .docx or .dotx without them"
        raise TemplateError(message)
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


def _find_main_part(parts: dict[str, bytes], types: dict[str, str]) -> str:
    """Return the name of the part that holds the document."""
    main = find_main_target(parts)
    if main not in parts or types[main] not in {CONTENT_TYPE.WML_DOCUMENT_MAIN, _TEMPLATE_MAIN}:
        message = "the template is no Word file: its main part is not a Word document (.docx) or template (.dotx)"
        raise TemplateError(message)
    return main


def _check_document(parts: dict[str, bytes], main: str) -> None:
    root = parse_part(parts[main], main)
    if root.tag == _STRICT_DOCUMENT:
        message = 'the template is a "Strict Open XML Document": save it as an ordinary Word document (.docx)'
        raise TemplateError(message)
    if root.tag != qn("w:document") or root.find(qn("w:body")) is None:
        message = f"the template is no Word file: its part `{main}` holds no document"
        raise TemplateError(message)


def _zip_parts(parts: dict[str, bytes], types: dict[str, str]) -> bytes:
    """Return parts as a zip without compression, with a content type for each of them."""
    # By name for all: python-docx asks for the type of each part, and raises KeyError where an ending has none.
    root = etree.fromstring(f'<Types xmlns="{NAMESPACE.OPC_CONTENT_TYPES}"/>')
    for name, content_type in types.items():
        etree.SubElement(root, f"{_TYPES}Override", PartName=f"/{name}", ContentType=content_type)
    target = io.BytesIO()
    with zipfile.ZipFile(target, "w") as archive:
        for name, content in {_CONTENT_TYPES: etree.tostring(root), **parts}.items():
            archive.writestr(name, content)
    return target.getvalue()
