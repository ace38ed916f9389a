"""What stands in the packages of UML documents, by kind: one walk through all of them, and a note of what is left."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass, field

from archgen.importers.foreign.xml_tree import XmlElement
from archgen.importers.xmi.import_ledger import OWN_PREFIX, ImportLedger, call
from archgen.importers.xmi.uml_index import UmlIndex, get_id, get_kind, get_name
from archgen.importers.xmi.xmi_files import XmiDocument

_PACKAGES = frozenset({"Model", "Package"})
_CLASSES = frozenset({"Class", "Component"})
_DATA = frozenset({"DataType", "PrimitiveType", "Enumeration", "Signal"})
_HARDWARE = frozenset({"Node", "Device", "ExecutionEnvironment"})
_REALIZATIONS = frozenset({"InterfaceRealization", "Realization", "ComponentRealization", "Substitution"})
_PATHS = frozenset({"CommunicationPath", "Association"})
_DEPENDENCIES = frozenset({"Usage", "Dependency", "Abstraction"})
_FEATURES = frozenset({"Property", "Port", "Operation", "Generalization", "EnumerationLiteral"})
_SILENT_TAGS = frozenset(
    {"name", "client", "supplier", "type", "lowerValue", "upperValue", "defaultValue", "provided", "required"}
    | {"memberEnd", "navigableOwnedEnd", "ownedEnd", "clientDependency", "association", "value", "mapping", "body"}
    | {"contract", "implementingClassifier", "realizingClassifier", "abstraction", "deployedArtifact", "location"}
    | {
        "utilizedElement",
        "member",
        "elementImport",
        "interface",
        "qualifiedName",
        "feature",
        "attribute",
        "ownedReception",
        "end",
    }
)
"""Parts of elements that are read with them, or say again what stands elsewhere."""
_TOOL_TAGS = frozenset({"Extension", "eAnnotations", "Documentation"})
_WHY = {
    "UseCase": "use cases of the language have actors and steps in words",
    "Actor": "it has no component of its own",
    "StateMachine": "what goes on inside a component is no part of an architecture",
    "Activity": "what goes on inside a component is no part of an architecture",
    "Interaction": "what goes on between components at one time is no part of an architecture",
    "OpaqueBehavior": "code is no part of an architecture",
    "InstanceSpecification": "objects at run time are no part of an architecture",
    "Profile": "profiles describe UML itself",
    "Constraint": "archgen cannot check it",
    "Collaboration": "only its components could be taken, and they stand elsewhere",
    "PackageImport": "packages see one another here",
    "ProfileApplication": "profiles describe UML itself",
    "Stereotype": "profiles describe UML itself",
}


_TEXT_KEYS = frozenset({"functionality", "description", "comment"})


@dataclass(slots=True)
class UmlCatalogue:
    """The elements of all documents that have a meaning in the language, by kind, in the order of the files."""

    classes: list[XmlElement] = field(default_factory=list)
    interfaces: list[XmlElement] = field(default_factory=list)
    data_types: list[XmlElement] = field(default_factory=list)
    hardware: list[XmlElement] = field(default_factory=list)
    artifacts: list[XmlElement] = field(default_factory=list)
    paths: list[XmlElement] = field(default_factory=list)
    dependencies: list[XmlElement] = field(default_factory=list)
    realizations: list[XmlElement] = field(default_factory=list)
    deployments: list[XmlElement] = field(default_factory=list)
    manifestations: list[XmlElement] = field(default_factory=list)
    connectors: list[XmlElement] = field(default_factory=list)
    packages: dict[XmlElement, XmlElement] = field(default_factory=dict)
    """The package that each element stands in, directly or inside of other elements."""


def make_catalogue(documents: Sequence[XmiDocument], index: UmlIndex, ledger: ImportLedger) -> UmlCatalogue:
    """Return the catalogue of documents, and note what has no place in it."""
    walk = _CatalogueWalk(index, ledger)
    for document in documents:
        for model in document.models:
            if get_kind(model) == "Profile":
                ledger.leave(model, f"{call(model)} is not taken: profiles describe UML itself")
            else:
                walk.visit_contents(model, model)
        walk.note_surroundings(document)
    return walk.catalogue


class _CatalogueWalk:
    def __init__(self, index: UmlIndex, ledger: ImportLedger) -> None:
        self.catalogue = UmlCatalogue()
        self._index, self._ledger = index, ledger
        self._tool_parts: Counter[str] = Counter()
        self._first_tool_part: dict[str, XmlElement] = {}
        catalogue = self.catalogue
        self._lists = {
            **dict.fromkeys(_CLASSES, catalogue.classes),
            **dict.fromkeys(_DATA, catalogue.data_types),
            **dict.fromkeys(_HARDWARE, catalogue.hardware),
            **dict.fromkeys(_REALIZATIONS, catalogue.realizations),
            **dict.fromkeys(_PATHS, catalogue.paths),
            **dict.fromkeys(_DEPENDENCIES, catalogue.dependencies),
            "AssociationClass": catalogue.classes,
            "Interface": catalogue.interfaces,
            "Artifact": catalogue.artifacts,
            "Deployment": catalogue.deployments,
            "Manifestation": catalogue.manifestations,
            "Connector": catalogue.connectors,
        }

    def visit_contents(self, element: XmlElement, package: XmlElement) -> None:
        """Sort what stands in a package, a class or a node, to any depth."""
        for child in element.children:
            kind = get_kind(child)
            if child.tag in _TOOL_TAGS:
                self._tool_parts[child.tag] += 1
                self._first_tool_part.setdefault(child.tag, child)
            elif "xmi:idref" in child.attributes or "href" in child.attributes:
                continue
            elif kind in _PACKAGES:
                self.visit_contents(child, child)
                self.catalogue.packages[child] = package
            elif (elements := self._lists.get(kind)) is not None:
                elements.append(child)
                self.catalogue.packages[child] = package
                self.visit_contents(child, package)
            elif kind in _FEATURES:
                self._visit_feature(child, package)
            elif kind == "Comment":
                self._visit_comment(child, element)
            elif child.tag not in _SILENT_TAGS and kind:
                self._leave(child, kind)

    def _visit_feature(self, feature: XmlElement, package: XmlElement) -> None:
        self.catalogue.packages[feature] = package
        for child in feature.children:
            kind = get_kind(child)
            if child.tag in _TOOL_TAGS:
                self._tool_parts[child.tag] += 1
                self._first_tool_part.setdefault(child.tag, child)
            is_reference = "xmi:idref" in child.attributes or "href" in child.attributes
            if kind in self._lists and child.tag not in _SILENT_TAGS and not is_reference:
                self._lists[kind].append(child)
                self.catalogue.packages[child] = package
                self.visit_contents(child, package)

    def _visit_comment(self, comment: XmlElement, owner: XmlElement) -> None:
        named = self._index.list_named(comment, "annotatedElement")
        if named and owner not in named:
            about = ", ".join(get_name(each) or get_kind(each) for each in named[:3])
            self._ledger.leave(comment, f"a comment about {about[:100]} is not taken: it stands outside of that")

    def _leave(self, element: XmlElement, kind: str) -> None:
        reason = _WHY.get(kind, "the language has nothing like it")
        self._ledger.leave(element, f"{call(element)} is not taken: {reason}")

    def note_surroundings(self, document: XmiDocument) -> None:
        """Note what a tool keeps for itself, and the stereotypes that it wrote outside of the model."""
        for child in document.root.children if document.root not in document.models else ():
            if child.tag in _TOOL_TAGS and child.tag != "Documentation":
                self._tool_parts[child.tag] += 1
                self._first_tool_part.setdefault(child.tag, child)
        for tag, count in self._tool_parts.items():
            if tag != "Documentation":
                words = f"{count} `{tag}` {'is' if count == 1 else 'are'} not taken: what the tool keeps for itself"
                self._ledger.leave(self._first_tool_part[tag], words, kind=f"xmi:{tag}")
        self._tool_parts.clear()
        self._first_tool_part.clear()
        stereotypes = [
            child
            for child in document.root.children
            if document.root not in document.models and child not in document.models and child.tag not in _TOOL_TAGS
        ]
        first_of: dict[str, XmlElement] = {}
        for child in stereotypes:
            first_of.setdefault(f"{child.prefix}:{child.tag}", child)
        counts = Counter(f"{child.prefix}:{child.tag}" for child in stereotypes)
        for name, first in first_of.items():
            words = f"the stereotype `{name[:80]}` of {counts[name]} elements is not taken: it belongs to a profile"
            self._ledger.leave(first, words, kind=name)


def read_description(index: UmlIndex, element: XmlElement) -> dict[str, object]:
    """Return `description` with the comments that stand in an element and are about it."""
    texts: dict[str, list[str]] = {}
    for child in element.children:
        if get_kind(child) == "Comment":
            named = index.list_named(child, "annotatedElement")
            body = child.find("body")
            text = child.attributes.get("body") or (body.text if body is not None else "")
            if text.strip() and (not named or element in named):
                # archgen says in the ids of its comments which text of an element each is.
                key = get_id(child).rpartition(".")[2] if get_id(child).startswith(OWN_PREFIX) else ""
                texts.setdefault(key if key in _TEXT_KEYS else "description", []).append(text.strip())
    return {key: "\n\n".join(each) for key, each in texts.items()}
