"""Open UML models: .xmi, .uml and .xml files, and the zip archives that MagicDraw (.mdzip) and ArgoUML (.zargo) write."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

from archgen.plugin.importing import (
    ZIP_BEGINNING,
    ForeignFileError,
    Span,
    XmlElement,
    parse_xml,
    read_archive_members,
    read_bounded,
)

_MODEL_TAGS = frozenset({"Model", "Package", "Profile"})
_MEMBER_ENDINGS = (".xmi", ".uml", "uml_model.model", "uml_model.shared_model")
"""What a member of an archive is called that holds a model: MagicDraw's names have no ending of XML."""


@dataclass(frozen=True, slots=True)
class XmiDocument:
    """One XML file with UML in it. `file` is its name in messages, `name` that by which others refer to it."""

    file: str
    name: str
    root: XmlElement
    models: tuple[XmlElement, ...]
    """The outermost packages: the root, or what stands in `xmi:XMI`."""

    @property
    def surroundings(self) -> list[XmlElement]:
        """What stands beside the outermost packages: stereotypes, and what a tool keeps for itself."""
        models = frozenset(self.models)
        return [] if self.root in models else [each for each in self.root.children if each not in models]


def read_documents(files: Sequence[Path]) -> list[XmiDocument]:
    """Read files and archives. Raise ForeignFileError for what is no UML in XMI 2."""
    documents: list[XmiDocument] = []
    for path in files:
        data = read_bounded(path)
        if data.startswith(ZIP_BEGINNING):
            documents += _read_archive(path)
        else:
            documents.append(_make_document(str(path), path.name, data))
    return documents


def _read_archive(path: Path) -> Iterator[XmiDocument]:
    is_empty = True
    for name, data in read_archive_members(path, _MEMBER_ENDINGS):
        is_empty = False
        yield _make_document(f"{path} [{name}]", path.name, data)
    if is_empty:
        words = "there is no UML model in this archive"
        help_line = "export the model from your tool as XMI 2.x (.xmi or .uml)"
        raise ForeignFileError(words, Span.of_file(str(path)), help_line)


def _make_document(file: str, name: str, data: bytes) -> XmiDocument:
    root = parse_xml(file, data)
    models = (root,) if _is_model(root) else tuple(each for each in root.children if _is_model(each))
    if root.tag == "XMI" and (version := root.attributes.get("xmi.version")):
        words = f"it is XMI {version[:10]} (UML 1), as ArgoUML writes it; archgen reads XMI 2 (UML 2)"
        help_line = "open it in a tool of UML 2, such as Papyrus or Modelio, and export it from there"
        raise ForeignFileError(words, root.span(file), help_line)
    if not models:
        words = f"there is no UML model in it: its outermost element is `{root.tag[:60]}`"
        help_line = "export the model from your tool as XMI 2.x (UML 2)"
        raise ForeignFileError(words, root.span(file), help_line)
    return XmiDocument(file, name, root, models)


def _is_model(element: XmlElement) -> bool:
    return element.tag in _MODEL_TAGS and "uml" in element.namespace.lower()
