"""What is mended in a template so that python-docx opens what Word opens: content types, and relationships.

python-docx refuses .dotx files, and raises KeyError for a part without a content type.
"""

from __future__ import annotations

import posixpath
from urllib.parse import unquote

from docx.opc.constants import CONTENT_TYPE, NAMESPACE, RELATIONSHIP_TYPE
from docx.oxml.ns import qn
from lxml import etree

from archgen.emit.template_package import TemplateError, parse_part, read_content_types, zip_parts

_PACKAGE_RELATIONS = "_rels/.rels"
_ROOT_TAG = f"{{{NAMESPACE.OPC_RELATIONSHIPS}}}Relationships"
_SINGLE_KINDS = {
    "styles": CONTENT_TYPE.WML_STYLES,
    "numbering": CONTENT_TYPE.WML_NUMBERING,
    "settings": CONTENT_TYPE.WML_SETTINGS,
}
"""Parts of which a document has one, by the last word of the relationship's type; their root bears the same name."""
_KIND_TYPES = _SINGLE_KINDS | {"header": CONTENT_TYPE.WML_HEADER, "footer": CONTENT_TYPE.WML_FOOTER}


def _find_main_target(parts: dict[str, bytes]) -> str:
    """Return the name of the part that the package calls its document, empty if it calls none so."""
    relations = _parse_relations(parts, _PACKAGE_RELATIONS) if _PACKAGE_RELATIONS in parts else ()
    targets = (
        _resolve_target("", item.get("Target", ""))
        for item in relations
        if _read_relation_kind(item) == "officeDocument" and not _is_external(item)
    )
    return next(targets, "")


def _repair_relations(parts: dict[str, bytes], types: dict[str, str], main: str) -> None:
    """Mend the relationships of the package, of its document and of all other parts; `types` are the parts' content types."""
    for name in [name for name in parts if "_rels/" in name and name.endswith(".rels")]:
        root = _parse_relations(parts, name)
        folder, file = posixpath.split(name)
        source = posixpath.join(posixpath.dirname(folder), file.removesuffix(".rels"))
        if name == _PACKAGE_RELATIONS:
            _repair_package_relations(root, parts, main)
        elif source == main:
            _repair_main_relations(root, parts, types, main)
        else:
            _repair_other_relations(root, parts, source)
        parts[name] = etree.tostring(root)


def _parse_relations(parts: dict[str, bytes], name: str) -> etree._Element:
    """Return the root of a part of relationships, with each id once; an empty one if the part holds something else."""
    root = parse_part(parts[name], name)
    if root.tag != _ROOT_TAG:
        return etree.fromstring(f'<Relationships xmlns="{NAMESPACE.OPC_RELATIONSHIPS}"/>')
    ids = {""}
    for item in list(root):
        if item.get("Id", "") in ids:
            root.remove(item)
        ids.add(item.get("Id", ""))
    return root


def _repair_package_relations(root: etree._Element, parts: dict[str, bytes], main: str) -> None:
    """Keep of the package's relationships the document, and custom properties, which a cover's fields may show.

    The template's title, author, dates and preview are not the report's: python-docx never reads them.
    """
    kinds = {"officeDocument", "custom-properties"}
    for item in list(root):
        kind, target = _read_relation_kind(item), _resolve_target("", item.get("Target", ""))
        if kind not in kinds or target not in parts or _is_external(item):
            root.remove(item)
            continue
        kinds.remove(kind)
        item.set("Target", f"/{target}")
        if target == main:
            item.set("Type", RELATIONSHIP_TYPE.OFFICE_DOCUMENT)


def _repair_main_relations(root: etree._Element, parts: dict[str, bytes], types: dict[str, str], main: str) -> None:
    """Drop what leads nowhere from the document's relationships, and let parts be of the kind that they are used as."""
    single_kinds: set[str] = set()
    for item in [item for item in root if not _is_external(item)]:
        kind, target = _read_relation_kind(item), _resolve_target(posixpath.dirname(main), item.get("Target", ""))
        if target not in parts or kind in single_kinds or not _fits_kind(parts, target, kind):
            root.remove(item)
            continue
        item.set("Target", f"/{target}")
        if kind in _KIND_TYPES:
            item.set("Type", f"{NAMESPACE.OFC_RELATIONSHIPS}/{kind}")
            types[target] = _KIND_TYPES[kind]
        if kind in _SINGLE_KINDS:
            single_kinds.add(kind)


def _repair_other_relations(root: etree._Element, parts: dict[str, bytes], source: str) -> None:
    """Let relationships of headers and the like that lead nowhere point outside of the file.

    They cannot go: a header's drawing still names them, and a name without a relationship is a damaged file to Word.
    """
    for item in [item for item in root if not _is_external(item)]:
        target = _resolve_target(posixpath.dirname(source), item.get("Target", ""))
        if target in parts:
            item.set("Target", f"/{target}")
        else:
            item.set("TargetMode", "External")


def _fits_kind(parts: dict[str, bytes], name: str, kind: str) -> bool:
    """Tell whether a part that should be styles, numbering or settings is that."""
    return kind not in _SINGLE_KINDS or parse_part(parts[name], name).tag == qn(f"w:{kind}")


def _is_external(relation: etree._Element) -> bool:
    return relation.get("TargetMode") == "External"


def _read_relation_kind(relation: etree._Element) -> str:
    """Return the last word of a relationship's type: `styles`, `image`, `hyperlink`."""
    return relation.get("Type", "").rpartition("/")[2]


def _resolve_target(folder: str, target: str) -> str:
    """Return the name of the part that a relationship's target means; python-docx does not know percent signs."""
    path = unquote(target.partition("#")[0])
    joined = path if path.startswith("/") else posixpath.join("/", folder, path)
    return posixpath.normpath(joined).lstrip("/")


_TEMPLATE_MAIN = "application/vnd.openxmlformats-officedocument.wordprocessingml.template.main+xml"
_STRICT_DOCUMENT = "{http://purl.oclc.org/ooxml/wordprocessingml/main}document"
_PARSED_TYPES = {*_KIND_TYPES.values(), CONTENT_TYPE.WML_COMMENTS}
"""Content types that python-docx parses as soon as it opens a file, beside the main part."""


def repair_package(parts: dict[str, bytes]) -> bytes:
    """Return a template as a package that python-docx opens. Raise TemplateError if it is no Word document."""
    types = read_content_types(parts)
    main = _find_main_part(parts, types)
    _check_document(parts, main)
    # A .dotx differs from a .docx in this alone.
    types[main] = CONTENT_TYPE.WML_DOCUMENT_MAIN
    _repair_relations(parts, types, main)
    for name, content_type in types.items():
        if content_type in _PARSED_TYPES:
            parse_part(parts[name], name)
    return zip_parts(parts, types)


def _find_main_part(parts: dict[str, bytes], types: dict[str, str]) -> str:
    """Return the name of the part that holds the document."""
    main = _find_main_target(parts)
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
