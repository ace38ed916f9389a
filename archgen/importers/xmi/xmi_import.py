"""Read UML models as an import: the stages in order."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from archgen.importers.foreign.foreign_import import ForeignImport
from archgen.importers.foreign.xml_tree import XmlElement
from archgen.importers.xmi.component_assembly import ComponentAssembly
from archgen.importers.xmi.component_facts import ClassSorting
from archgen.importers.xmi.component_sections import ComponentSections, assign_port_ids
from archgen.importers.xmi.data_types import DataTypes
from archgen.importers.xmi.deployment_sections import DeploymentSections
from archgen.importers.xmi.import_ledger import OWN_PREFIX, ImportLedger, call
from archgen.importers.xmi.port_facts import InterfaceUses
from archgen.importers.xmi.port_wiring import PortWiring
from archgen.importers.xmi.uml_catalogue import UmlCatalogue, make_catalogue
from archgen.importers.xmi.uml_index import UmlIndex, get_id, get_kind, get_name
from archgen.importers.xmi.xmi_files import XmiDocument, read_documents

_FILES = {
    "component_types.yaml": ("component_types",),
    "types.yaml": ("types",),
    "components.yaml": ("groups",),
    "deployment.yaml": ("hosts", "links", "nodes"),
}
"""The slices, and the sections that go to each."""


def read_xmi(files: Sequence[Path]) -> ForeignImport:
    """Read UML models that belong together. Raise ForeignFileError for a file that is none."""
    documents = read_documents(files)
    index = UmlIndex(documents)
    ledger = ImportLedger(index)
    for element in index.doubled:
        words = f"{call(element)} has the id of another element: references mean the first one of the two"
        ledger.note(element, words, "export the model again, or give it an id of its own", "xmi:id")
    catalogue = make_catalogue(documents, index, ledger)
    uses = InterfaceUses(index, catalogue)
    sorting = ClassSorting(index, ledger, catalogue, uses)
    assembly = ComponentAssembly(index, ledger, catalogue, uses, sorting)
    assign_port_ids(assembly)
    wiring = PortWiring(index, ledger, catalogue, sorting, assembly)
    components = ComponentSections(index, ledger, uses, assembly, wiring)
    deployment = DeploymentSections(index, ledger, catalogue, assembly)
    classes = [facts.element for facts in sorting.facts.values() if facts.sort == "data"]
    sections = {
        "component_types": components.make_types(),
        "types": DataTypes(index, ledger, (*catalogue.data_types, *classes)).make_types(),
        "groups": components.make_groups(),
        "hosts": deployment.make_hosts(),
        "links": deployment.make_links(),
        "nodes": deployment.make_nodes(),
    }
    _count_relations(catalogue, uses, ledger, frozenset(assembly.groups.values()))
    slices = {
        name: kept for name, keys in _FILES.items() if (kept := {key: sections[key] for key in keys if sections[key]})
    }
    return ForeignImport(slices, dict(ledger.taken), ledger.list_notes(), title=_find_title(documents))


def _count_relations(
    catalogue: UmlCatalogue, uses: InterfaceUses, ledger: ImportLedger, groups: frozenset[XmlElement]
) -> None:
    """Count usages, realizations and interfaces, and note those that say nothing here."""
    for element in (*catalogue.dependencies, *catalogue.realizations):
        if element in uses.used_elements:
            ledger.take(element)
        elif get_kind(element) in {"Usage", "Dependency", "Abstraction", "Substitution"}:
            words = f"{call(element)} is not taken: it does not say what flows"
            ledger.leave(element, words, "let ports use and realize an interface")
    for package in dict.fromkeys(catalogue.packages.values()):
        if package not in groups and not get_id(package).startswith(OWN_PREFIX):
            ledger.note(package, f"{call(package)} is no group: no component stands directly in it")
    meant = {key for keys in (*uses.provided.values(), *uses.required.values()) for key in keys}
    for element in catalogue.interfaces:
        if element in meant:
            ledger.take(element)
        else:
            ledger.leave(element, f"{call(element)} is not taken: nobody realizes or uses it")


def _find_title(documents: Sequence[XmiDocument]) -> str:
    names = [get_name(model) for document in documents for model in document.models]
    return next((name for name in names if name), "")
