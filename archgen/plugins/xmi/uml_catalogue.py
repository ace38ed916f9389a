"""What stands in the packages of UML documents, by kind: one walk through all of them, and a note of what is left."""

from __future__ import annotations

import re
from collections import defaultdict
from collections.abc import Sequence
from dataclasses import dataclass, field
from html.parser import HTMLParser

from archgen.plugin.importing import XmlElement
from archgen.plugins.xmi.import_ledger import OWN_PREFIX, ImportLedger
from archgen.plugins.xmi.uml_index import XmiDocument, get_id, get_kind, get_name

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
    | {"utilizedElement", "member", "interface", "qualifiedName", "feature", "attribute", "end"}
)
"""Parts of elements that are read with them, or say again what stands elsewhere."""
_OWNING_TAGS = frozenset({"packagedElement", "ownedMember", "nestedPackage", "nestedClassifier"})
_TEMPLATE_KINDS = frozenset({"TemplateSignature", "RedefinableTemplateSignature", "TemplateBinding"})
TOOL_TAGS = frozenset({"Extension", "eAnnotations", "Documentation"})
"""What a tool keeps for itself."""
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
    "ElementImport": "packages see one another here",
    "Reception": "what flows between components is said by ports and interfaces",
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
    all_packages: list[XmlElement] = field(default_factory=list)


def make_catalogue(documents: Sequence[XmiDocument], ledger: ImportLedger) -> UmlCatalogue:
    """Return the catalogue of documents, and note what has no place in it."""
    walk = _CatalogueWalk(ledger)
    for document in documents:
        for model in document.models:
            if get_kind(model) == "Profile":
                ledger.refuse(model, "profiles describe UML itself")
            else:
                walk.catalogue.all_packages.append(model)
                walk.visit_contents(model, model)
        walk.note_surroundings(document)
    return walk.catalogue


class _CatalogueWalk:
    def __init__(self, ledger: ImportLedger) -> None:
        self.catalogue = UmlCatalogue()
        self._index, self._ledger = ledger.index, ledger
        self._tool_parts: dict[str, list[XmlElement]] = defaultdict(list)
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
            if child.tag in TOOL_TAGS:
                self._tool_parts[child.tag].append(child)
            elif "xmi:idref" in child.attributes or "href" in child.attributes:
                self._visit_reference(child)
            elif kind in _PACKAGES:
                self.visit_contents(child, child)
                self.catalogue.packages[child] = package
                self.catalogue.all_packages.append(child)
            elif (elements := self._lists.get(kind)) is not None:
                elements.append(child)
                self.catalogue.packages[child] = package
                self.visit_contents(child, package)
            elif kind in _FEATURES:
                self._visit_feature(child, package)
            elif kind == "Comment":
                self._visit_comment(child, element)
            elif kind in _TEMPLATE_KINDS and (
                get_kind(element) in _CLASSES or (get_kind(element) in _DATA and kind != "TemplateBinding")
            ):
                # Read with its class, as a template or what is bound to one.
                continue
            elif child.tag not in _SILENT_TAGS and (kind or "xmi:id" in child.attributes):
                self._ledger.refuse(child, _WHY.get(kind, "the language has nothing like it"))

    def _visit_reference(self, child: XmlElement) -> None:
        """Note a part of the model that lies in a file of its own, and was not named."""
        if child.tag in _OWNING_TAGS and "href" in child.attributes:
            reference = self._index.resolve_child(child)
            if reference is not None and reference.element is None:
                name = reference.name or child.attributes["href"].rpartition("#")[2]
                words = f"`{name[:80]}` is not taken: it lies in a file that was not named"
                self._ledger.leave(child, words, "name all files of the model together")

    def _visit_feature(self, feature: XmlElement, package: XmlElement) -> None:
        self.catalogue.packages[feature] = package
        for child in feature.children:
            kind = get_kind(child)
            if child.tag in TOOL_TAGS:
                self._tool_parts[child.tag].append(child)
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

    def note_surroundings(self, document: XmiDocument) -> None:
        """Note what a tool keeps for itself, and the stereotypes that it wrote outside of the model."""
        for child in document.surroundings:
            if child.tag in TOOL_TAGS:
                self._tool_parts[child.tag].append(child)
        for tag, parts in self._tool_parts.items():
            if tag != "Documentation":
                words = f"{len(parts)} `{tag}` {'is' if len(parts) == 1 else 'are'} not taken: what the tool keeps for itself"
                self._ledger.leave(parts[0], words, kind=f"xmi:{tag}", others=parts[1:])
        self._tool_parts.clear()
        stereotypes: dict[str, list[XmlElement]] = defaultdict(list)
        for child in document.surroundings:
            if child in self._index.flow_stereotypes:
                self._ledger.take(child, child.tag)
            elif child.tag not in TOOL_TAGS:
                stereotypes[f"{child.prefix}:{child.tag}"].append(child)
        for name, uses in stereotypes.items():
            owners = f"{len(uses)} elements" if len(uses) > 1 else "one element"
            words = f"the stereotype `{name[:80]}` of {owners} is not taken: it belongs to a profile"
            self._ledger.leave(uses[0], words, kind=name, others=uses[1:])


def read_description(ledger: ImportLedger, element: XmlElement) -> dict[str, object]:
    """Return `description` with the comments that stand in an element and are about it."""
    texts: dict[str, list[str]] = {}
    for child in element.children:
        if get_kind(child) == "Comment":
            named = ledger.index.list_named(child, "annotatedElement")
            body = child.find("body")
            text = child.attributes.get("body") or (body.text if body is not None else "")
            if not text.strip():
                ledger.take(child)
            elif not named or element in named:
                ledger.take(child)
                # archgen says in the ids of its comments which text of an element each is.
                key = get_id(child).rpartition(".")[2] if get_id(child).startswith(OWN_PREFIX) else ""
                texts.setdefault(key if key in _TEXT_KEYS else "description", []).append(make_plain(text))
    return {key: "\n\n".join(each) for key, each in texts.items()}


_HTML_BEGINNING = re.compile(
    r"\s*<(?:!doctype|html|body|head|p|div|span|ul|ol|b|i|u|strong|em|font|h[1-6]|table|br)\b[^<>]*>", re.IGNORECASE
)
_PARAGRAPHS = frozenset({"p", "div", "ul", "ol", "table", *(f"h{level}" for level in range(1, 7))})
_UNSEEN = frozenset({"style", "script", "head", "title"})


def make_plain(text: str) -> str:
    """Return the text of a comment without HTML: paragraphs, lines and items of lists stay apart."""
    text = text.replace("\r\n", "\n").replace("\r", "\n")
    if not _HTML_BEGINNING.match(text):
        return text.strip()
    reader = _TextReader()
    reader.feed(text)
    reader.close()
    lines = [" ".join(line.split()) for line in "".join(reader.words).split("\n")]
    return re.sub(r"\n{3,}", "\n\n", "\n".join(lines)).strip()


class _TextReader(HTMLParser):
    """Collects what a reader of the page would see."""

    def __init__(self) -> None:
        super().__init__(convert_charrefs=True)
        self.words: list[str] = []
        self._unseen = 0

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:  # noqa: ARG002 - HTMLParser's
        if tag in _UNSEEN:
            self._unseen += 1
        elif tag in _PARAGRAPHS:
            self.words.append("\n\n")
        elif tag in {"br", "tr"}:
            self.words.append("\n")
        elif tag == "li":
            self.words.append("\n- ")

    def handle_endtag(self, tag: str) -> None:
        if tag in _UNSEEN:
            self._unseen = max(0, self._unseen - 1)
        elif tag in _PARAGRAPHS:
            self.words.append("\n\n")

    def handle_data(self, data: str) -> None:
        if not self._unseen:
            # Line breaks of the file mean nothing in HTML.
            self.words.append(" ".join(data.split("\n")))
