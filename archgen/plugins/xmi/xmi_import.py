"""Read UML models as an import: the stages in order."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path

from archgen.plugin.importing import ForeignImport, XmlElement
from archgen.plugins.xmi.component_assembly import ComponentAssembly
from archgen.plugins.xmi.component_facts import ClassSorting
from archgen.plugins.xmi.deployment_sections import DeploymentSections
from archgen.plugins.xmi.import_ledger import NOT_TAKEN, OWN_PREFIX, ImportLedger, name_element
from archgen.plugins.xmi.port_facts import InterfaceUses
from archgen.plugins.xmi.port_wiring import PortWiring
from archgen.plugins.xmi.uml_catalogue import TOOL_TAGS, UmlCatalogue, make_catalogue
from archgen.plugins.xmi.uml_component_sections import ComponentSections, assign_port_ids
from archgen.plugins.xmi.uml_data_types import UmlDataTypes
from archgen.plugins.xmi.uml_index import (
    UmlIndex,
    XmiDocument,
    get_id,
    get_kind,
    get_name,
    is_written_here,
    read_documents,
)

_FILES = {
    "component_types.yaml": ("component_types",),
    "types.yaml": ("types",),
    "components.yaml": ("groups",),
    "deployment.yaml": ("hosts", "links", "nodes"),
}
"""The slices, and the sections that go to each."""


def read_xmi(files: Sequence[Path], known_ids: Mapping[str, str] | None = None) -> ForeignImport:
    """Read UML models that belong together. Raise ForeignFileError for a file that is none.

    `known_ids` are ids that elements have since an earlier import, by their `xmi:id`: a new name is a new title.
    """
    documents = read_documents(files)
    index = UmlIndex(documents, known_ids)
    return convert_documents(documents, index, ImportLedger(index))


def convert_documents(documents: Sequence[XmiDocument], index: UmlIndex, ledger: ImportLedger) -> ForeignImport:
    """Return what documents of UML become. The ledger says of each element what became of it."""
    for element in index.doubled:
        words = f"{name_element(element)} has the id of another element: references mean the first one of the two"
        ledger.note(element, words, "export the model again, or give it an id of its own", "xmi:id")
    catalogue = make_catalogue(documents, ledger)
    uses = InterfaceUses(index, catalogue)
    sorting = ClassSorting(ledger, catalogue, uses)
    assembly = ComponentAssembly(sorting)
    assign_port_ids(assembly, index.known_ids)
    components = ComponentSections(assembly, PortWiring(assembly))
    deployment = DeploymentSections(assembly)
    classes = [facts.element for facts in sorting.facts.values() if facts.sort == "data"]
    sections = {
        "component_types": components.make_types(),
        "types": UmlDataTypes(ledger, (*catalogue.data_types, *classes)).make_types(),
        "groups": components.make_groups(),
        "hosts": deployment.make_hosts(),
        "links": deployment.make_links(),
        "nodes": deployment.make_nodes(),
    }
    titled = _find_titled(documents)
    if titled is not None:
        ledger.take(titled)
    _count_relations(catalogue, uses, ledger, assembly)
    _note_packages(
        catalogue, ledger, frozenset((*assembly.groups.values(), *((titled,) if titled is not None else ())))
    )
    note_leftovers(ledger, documents)
    slices = {
        name: kept for name, keys in _FILES.items() if (kept := {key: sections[key] for key in keys if sections[key]})
    }
    title = get_name(titled) if titled is not None else ""
    return ForeignImport(slices, dict(ledger.taken), ledger.list_notes(), title=title)


def _count_relations(
    catalogue: UmlCatalogue, uses: InterfaceUses, ledger: ImportLedger, assembly: ComponentAssembly
) -> None:
    """Count usages, realizations and interfaces, and note those that say nothing here."""
    for element in (*catalogue.dependencies, *catalogue.realizations):
        if element in uses.used_elements:
            ledger.take(element)
        elif get_kind(element) in {"Usage", "Dependency", "Abstraction", "Substitution"}:
            ledger.refuse(element, "it does not say what flows", "let ports use and realize an interface")
    meant = {key for keys in (*uses.provided.values(), *uses.required.values()) for key in keys}
    meant |= {key for port in assembly.list_ports() for key in (*port.provided, *port.required)}
    for element in catalogue.interfaces:
        if element in meant:
            ledger.take(element)
        else:
            ledger.refuse(element, "nobody realizes or uses it")


def _note_packages(catalogue: UmlCatalogue, ledger: ImportLedger, groups: frozenset[XmlElement]) -> None:
    for package in catalogue.all_packages:
        if package not in groups and not get_id(package).startswith(OWN_PREFIX):
            ledger.note(package, f"{name_element(package)} is no group: no component stands directly in it")


def _find_titled(documents: Sequence[XmiDocument]) -> XmlElement | None:
    """Return the model whose name is the project's title."""
    return next((model for document in documents for model in document.models if get_name(model)), None)


_WHOLE_KINDS = frozenset({"Connector", "Operation", "Association", "CommunicationPath", "EnumerationLiteral"})
"""What is taken with all that stands in it: ends, parameters."""
_PARTS = {
    "Property": "nothing here has values or parts for it",
    "Operation": "an interface only says here who is connected with whom",
    "Generalization": "only classes and components are made from one another",
    "Comment": "what it stands in has no description",
    "Port": "only components and classes have ports",
    "Constraint": "archgen cannot check it",
    "EnumerationLiteral": "what it stands in has no values",
    "Parameter": "what it stands in has no parameters",
}
"""Why parts of elements are not taken that nobody asked for."""
_NAMES_SHOWN = 5


def note_leftovers(ledger: ImportLedger, documents: Sequence[XmiDocument]) -> None:
    """Note what nobody spoke of: parts of one kind in one element together."""
    for document in documents:
        for model in document.models:
            for owner, kind, parts in _list_leftovers(ledger, model):
                verb = "is" if len(parts) == 1 else "are"
                words = f"{_name_parts(kind, parts)} of {name_element(owner)} {verb} not taken: {_PARTS[kind]}"
                ledger.leave(parts[0], words, others=parts[1:])


def _name_parts(kind: str, parts: Sequence[XmlElement]) -> str:
    names = [f"`{name[:60]}`" for each in parts if (name := get_name(each))]
    shown = ", ".join(names[:_NAMES_SHOWN]) + (" and others" if 0 < len(names[:_NAMES_SHOWN]) < len(parts) else "")
    plural = "Properties" if kind == "Property" else f"{kind}s"
    if len(parts) == 1:
        return f"the {kind} {shown}" if shown else f"a {kind}"
    return f"the {plural} {shown}" if shown else f"{len(parts)} {plural}"


def _list_leftovers(ledger: ImportLedger, model: XmlElement) -> Iterator[tuple[XmlElement, str, list[XmlElement]]]:
    """Yield owner, kind and parts. What stands in an element that is not taken is left out with it."""
    stack = [model]
    while stack:
        owner = stack.pop()
        parts: dict[str, list[XmlElement]] = defaultdict(list)
        for child in owner.children:
            fate, kind = ledger.get_fate(child), get_kind(child)
            if child.tag in TOOL_TAGS or fate == NOT_TAKEN or not is_written_here(child):
                continue
            if fate is None and kind in _PARTS and not get_id(child).startswith(OWN_PREFIX):
                is_read = get_kind(owner) in _WHOLE_KINDS and kind not in {"Comment", "Constraint"}
                if not is_read and (kind != "EnumerationLiteral" or get_kind(owner) != "Enumeration"):
                    parts[kind].append(child)
                    continue
            stack.append(child)
        for kind, members in parts.items():
            yield owner, kind, members
