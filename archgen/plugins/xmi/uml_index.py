"""The elements of UML documents by id, with what all dialects of XMI say alike: kind, name, references.

Open UML models: .xmi, .uml and .xml files, and the zip archives that MagicDraw (.mdzip) and ArgoUML (.zargo) write.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator, Mapping, Sequence
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

_KINDS_BY_TAG = {
    "ownedPort": "Port",
    "ownedAttribute": "Property",
    "ownedEnd": "Property",
    "ownedOperation": "Operation",
    "ownedParameter": "Parameter",
    "generalization": "Generalization",
    "interfaceRealization": "InterfaceRealization",
    "realization": "ComponentRealization",
    "ownedLiteral": "EnumerationLiteral",
    "nestedNode": "Node",
    "deployment": "Deployment",
    "manifestation": "Manifestation",
    "ownedConnector": "Connector",
    "end": "ConnectorEnd",
    "ownedComment": "Comment",
    "nestedPackage": "Package",
    "ownedRule": "Constraint",
    "qualifier": "Property",
    "packageImport": "PackageImport",
    "elementImport": "ElementImport",
    "profileApplication": "ProfileApplication",
    "ownedReception": "Reception",
    "templateBinding": "TemplateBinding",
    "ownedTemplateSignature": "TemplateSignature",
    "parameterSubstitution": "TemplateParameterSubstitution",
}
"""What an element is that does not say it."""
_SAME_ARCHIVE = "local:"
"""What the addresses begin with by which MagicDraw leads from one file of an archive to another."""


@dataclass(frozen=True, slots=True)
class Reference:
    """What an element names: another element of the files, or only a name where that lies elsewhere."""

    element: XmlElement | None
    name: str
    is_outside: bool = False
    """Whether it leads to a file that is not among those that are read."""


class UmlIndex:
    """All elements of the documents. `doubled` are those whose id another one has already."""

    def __init__(self, documents: Sequence[XmiDocument], known_ids: Mapping[str, str] | None = None) -> None:
        self._documents = documents
        self.known_ids = known_ids or {}
        """Ids of the language that elements have since an earlier import, by their `xmi:id`."""
        self._document_of: dict[XmlElement, int] = {}
        self._parents: dict[XmlElement, XmlElement] = {}
        self._by_id: dict[tuple[int, str], XmlElement] = {}
        self._positions_of_file: dict[str, list[int]] = defaultdict(list)
        self.doubled: list[XmlElement] = []
        for position, document in enumerate(documents):
            self._positions_of_file[document.name].append(position)
            for model in document.models:
                self._add_elements(position, model)
        self.flow_stereotypes: set[XmlElement] = set()
        """The stereotypes of SysML that say which way the data of a port goes."""
        self.flow_directions = self._read_flow_directions()
        """`in` or `out` of the ports that a stereotype of SysML gives a direction."""

    def _add_elements(self, position: int, model: XmlElement) -> None:
        stack = [model]
        while stack:
            element = stack.pop()
            self._document_of[element] = position
            element_id = element.attributes.get("xmi:id")
            if element_id and self._by_id.setdefault((position, element_id), element) is not element:
                self.doubled.append(element)
            for child in reversed(element.children):
                # What a tool keeps for itself says again what the model says, with the same ids.
                if child.tag != "Extension":
                    self._parents[child] = element
                    stack.append(child)
        self.doubled.sort(key=lambda each: (self._document_of[each], each.line, each.column))

    def _read_flow_directions(self) -> dict[XmlElement, str]:
        directions: dict[XmlElement, str] = {}
        for position, document in enumerate(self._documents):
            for stereotype in document.surroundings:
                direction = stereotype.attributes.get("direction", "")
                port = self._by_id.get((position, stereotype.attributes.get("base_Port", "")))
                if stereotype.tag == "FlowPort" and direction in {"in", "out"} and port is not None:
                    directions[port] = direction
                    self.flow_stereotypes.add(stereotype)
        return directions

    def get_span(self, element: XmlElement) -> Span:
        """Return where an element is written."""
        return element.span(self._documents[self._document_of.get(element, 0)].file)

    def get_parent(self, element: XmlElement) -> XmlElement | None:
        """Return the element around one, None for an outermost package."""
        return self._parents.get(element)

    def find(self, element: XmlElement, element_id: str) -> XmlElement | None:
        """Return what an id means where an element uses it: its own file counts before the others."""
        position = self._document_of.get(element, 0)
        found = self._by_id.get((position, element_id))
        others = range(len(self._documents)) if found is None else ()
        return found or next(
            (self._by_id[each, element_id] for each in others if (each, element_id) in self._by_id), None
        )

    def list_references(self, element: XmlElement, *roles: str) -> list[Reference]:
        """Return what an element names in one of several roles, as attributes or as children, each element once."""
        references: list[Reference] = []
        for role in roles:
            references += (self._resolve_id(element, each) for each in element.attributes.get(role, "").split())
            for child in element.children:
                if child.tag == role:
                    references += self._read_child(child)
        return list({each.element or each.name: each for each in reversed(references)}.values())[::-1]

    def find_reference(self, element: XmlElement, *roles: str) -> Reference | None:
        """Return the first of what an element names in one of several roles."""
        return next(iter(self.list_references(element, *roles)), None)

    def list_named(self, element: XmlElement, *roles: str) -> list[XmlElement]:
        """Return the elements of the files that an element names in one of several roles."""
        return [each.element for each in self.list_references(element, *roles) if each.element is not None]

    def resolve_child(self, child: XmlElement) -> Reference | None:
        """Return what an element stands for that is only a reference to another one; None where it is none."""
        return next(iter(self._read_child(child)), None)

    def _read_child(self, child: XmlElement) -> list[Reference]:
        if (target := child.attributes.get("xmi:idref")) is not None:
            return [self._resolve_id(child, target)]
        if (address := child.attributes.get("href")) is not None:
            return [self._resolve_address(child, address)]
        # An element in its role: `<type xmi:type="uml:Class" ...>` of older tools, written where it is used.
        return [Reference(child, get_name(child))] if "xmi:id" in child.attributes else []

    def _resolve_id(self, element: XmlElement, target: str) -> Reference:
        found = self.find(element, target)
        if found is None and "#" in target:
            return self._resolve_address(element, target)
        return Reference(found, get_name(found) if found is not None else _name_from_id(target), found is None)

    def _resolve_address(self, child: XmlElement, address: str) -> Reference:
        file, _, fragment = address.rpartition("#")
        if not file or file.startswith(_SAME_ARCHIVE):
            positions = self._positions_of_file[self._documents[self._document_of.get(child, 0)].name]
        else:
            positions = self._positions_of_file.get(file.rpartition("/")[2], [])
        found = next((self._by_id[each, fragment] for each in positions if (each, fragment) in self._by_id), None)
        if found is not None:
            return Reference(found, get_name(found))
        return Reference(None, _find_told_name(child) or _name_from_id(fragment), is_outside=True)


def get_kind(element: XmlElement) -> str:
    """Return what an element is in UML's word without `uml:`; empty where it does not say and its tag does not."""
    written = element.attributes.get("xmi:type") or element.attributes.get("xsi:type")
    if written:
        return written.rpartition(":")[2]
    if "uml" in element.namespace.lower():
        return element.tag
    return _KINDS_BY_TAG.get(element.tag, "")


def get_name(element: XmlElement) -> str:
    """Return an element's name with single blanks; empty where it has none."""
    name = element.attributes.get("name")
    if name is None:
        # UML2 writes long and empty names as children, too.
        child = element.find("name")
        name = child.text if child is not None else ""
    return " ".join(name.split())


def get_id(element: XmlElement) -> str:
    """Return an element's id in its file; empty where it has none."""
    return element.attributes.get("xmi:id", "")


def is_true(element: XmlElement, attribute: str) -> bool:
    """Whether an attribute says yes."""
    return element.attributes.get(attribute, "").strip().lower() in {"true", "1"}


def list_child_elements(element: XmlElement, *kinds: str) -> list[XmlElement]:
    """Return the children of some kinds, in the order of the file."""
    return [child for child in element.children if get_kind(child) in kinds and is_written_here(child)]


def is_written_here(child: XmlElement) -> bool:
    """Whether an element is defined here, rather than being a reference to another one."""
    return "xmi:idref" not in child.attributes and "href" not in child.attributes


def _find_told_name(child: XmlElement) -> str:
    """Return the name of an element of another file that MagicDraw tells beside its address."""
    for element in child.walk():
        if path := element.attributes.get("referentPath"):
            return path.rpartition("::")[2]
    return ""


def _name_from_id(element_id: str) -> str:
    """Return the name in the ids of primitive types: `EAJava_int`, `string_id`, `Integer`; empty for a mere number."""
    name = element_id.rpartition("/")[2].removesuffix("_id")
    if name.startswith("EA") and "_" in name and not name.startswith(("EAID_", "EAPK_")):
        name = name.partition("_")[2]
    return (
        name if name.isidentifier() and name.isascii() and not name.startswith("_") and len(name) <= _MAX_NAME else ""
    )


_MAX_NAME = 24
"""Longer ones are numbers, not names."""


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
        raise ForeignFileError(words, root.span(file), "export the model from your tool as XMI 2.x (UML 2)")
    return XmiDocument(file, name, root, models)


def _is_model(element: XmlElement) -> bool:
    return element.tag in _MODEL_TAGS and "uml" in element.namespace.lower()
