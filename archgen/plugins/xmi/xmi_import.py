"""Read UML models as an import: the stages in order.

Nodes, devices, communication paths, artifacts and execution environments: hosts, links and what runs where.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path

from archgen.plugin.importing import ForeignImport, XmlElement, make_unique_id
from archgen.plugins.xmi.component_assembly import ComponentAssembly
from archgen.plugins.xmi.component_facts import ClassFacts, ClassSorting
from archgen.plugins.xmi.import_ledger import (
    NOT_TAKEN,
    OWN_PREFIX,
    ImportLedger,
    choose_id,
    make_hints,
    name_element,
    say_title,
)
from archgen.plugins.xmi.port_facts import InterfaceUses
from archgen.plugins.xmi.uml_catalogue import TOOL_TAGS, UmlCatalogue, make_catalogue, read_description
from archgen.plugins.xmi.uml_component_sections import ComponentSections, PortWiring, assign_port_ids
from archgen.plugins.xmi.uml_data_types import UmlDataTypes
from archgen.plugins.xmi.uml_index import (
    UmlIndex,
    XmiDocument,
    get_id,
    get_kind,
    get_name,
    is_written_here,
    list_child_elements,
    read_documents,
)

_MAX_HINTS = 10_000
"""Where environments that stand in no node would be so many hints, they are nobody's."""


class DeploymentSections:
    """Makes the sections `hosts`, `links` and `nodes`."""

    def __init__(self, assembly: ComponentAssembly) -> None:
        self._ledger, self._catalogue, self._index = assembly.ledger, assembly.catalogue, assembly.ledger.index
        self._facts_of = {facts.element: facts for facts in assembly.components}
        self._hosts: dict[XmlElement, str] = {}
        self._libraries: dict[str, list[str]] = defaultdict(list)
        self._library_artifacts: set[XmlElement] = set()
        self._host_of: dict[ClassFacts, str] = {}
        self._package_of: dict[ClassFacts, XmlElement] = {}
        taken: set[str] = set()
        for element in self._catalogue.hardware:
            if get_kind(element) == "Node":
                self._hosts[element] = choose_id(element, "host", taken, known_ids=self._index.known_ids)
                taken.add(self._hosts[element])
                self._ledger.take(element)
        self._middlewares = self._find_middlewares()
        self._own_nodes: dict[str, dict[str, object]] = {}
        """Nodes that archgen exported, by id."""
        self._own_hosts: dict[XmlElement, str] = {}
        # Manifestations first: what is deployed is mostly an artifact, and this says which components are in it.
        self._read_manifestations()
        self._read_deployments()
        self._make_own_nodes()
        for facts, element in assembly.hosted.items():
            if host := self._find_host(element):
                self._host_of.setdefault(facts, host)

    def _find_host(self, element: XmlElement | None) -> str | None:
        """Return the host that a node, or an execution environment in one, stands for."""
        while element is not None:
            if element in self._hosts:
                return self._hosts[element]
            element = self._index.get_parent(element)
        return None

    def _find_middlewares(self) -> dict[str, list[str]]:
        """Return the names of execution environments by host; one that stands in no node is that of all nodes."""
        middlewares: dict[str, list[str]] = defaultdict(list)
        environments = [each for each in self._catalogue.hardware if get_kind(each) == "ExecutionEnvironment"]
        hosts_of_all = list(self._hosts.values())
        # Environments outside of nodes count for each node: a hostile file would make the product of both.
        if len(environments) * len(hosts_of_all) > _MAX_HINTS:
            hosts_of_all = []
        for element in environments:
            host = self._find_host(element)
            hosts = [host] if host else hosts_of_all
            if not hosts:
                self._ledger.refuse(element, "it stands in no node, and there is none, or too many")
                continue
            for each in hosts:
                middlewares[each].append(get_name(element))
            words = f"{name_element(element)} is a hint of {', '.join(f'`{each}`' for each in hosts[:3])}"
            self._ledger.note(element, words + (" and others" if len(hosts) > 3 else ""))  # noqa: PLR2004 - as shown
            self._ledger.take(element)
        return middlewares

    def _read_manifestations(self) -> None:
        for element in self._catalogue.manifestations:
            artifacts = self._index.list_named(element, "client") or _list_parent(self._index, element)
            manifested = self._index.list_named(element, "utilizedElement", "supplier")
            components = [self._facts_of[each] for each in manifested if each in self._facts_of]
            for artifact in artifacts:
                if get_kind(artifact) == "Artifact" and not _is_own_node(artifact):
                    for facts in components:
                        # The first artifact counts: a node names one package.
                        if self._package_of.setdefault(facts, artifact) is not artifact:
                            words = f"{name_element(artifact)} manifests {name_element(facts.element)}, too: a component is in one package"
                            self._ledger.leave(artifact, words)
            if components:
                self._ledger.take(element)
            else:
                self._ledger.refuse(element, "what it manifests is no component")

    def _make_own_nodes(self) -> None:
        """Make the nodes that archgen exported, as they were: one may implement several components."""
        implemented: dict[XmlElement, list[ClassFacts]] = defaultdict(list)
        for element in self._catalogue.manifestations:
            for artifact in self._index.list_named(element, "client"):
                targets = self._index.list_named(element, "utilizedElement")
                implemented[artifact] += [self._facts_of[each] for each in targets if each in self._facts_of]
        for artifact, components in implemented.items():
            if not _is_own_node(artifact) or not components:
                continue
            node_id = choose_id(artifact, "node", self._own_nodes)
            paths = [".".join(each.path) for each in components]
            node: dict[str, object] = {"implements": paths[0] if len(paths) == 1 else paths}
            node |= say_title(get_name(artifact), node_id)
            package, _, executable = artifact.attributes.get("fileName", "").partition("/")
            node |= ({"package": package} if package else {}) | ({"executable": executable} if executable else {})
            host = self._own_hosts.get(artifact)
            self._own_nodes[node_id] = node | ({"host": host} if host else {})
            self._ledger.take(artifact)

    def _read_deployments(self) -> None:
        manifested = defaultdict(list)
        for facts, artifact in self._package_of.items():
            manifested[artifact].append(facts)
        for element in self._catalogue.deployments:
            parent = self._index.get_parent(element)
            targets = self._index.list_named(element, "location", "client")
            host = self._find_host(targets[0] if targets else parent)
            deployed = self._index.list_named(element, "deployedArtifact", "supplier")
            if host is None or not deployed:
                self._ledger.refuse(element, "it does not lead from an artifact to a node")
                continue
            for each in deployed:
                self._deploy(element, each, manifested.get(each, []), host)

    def _deploy(self, deployment: XmlElement, deployed: XmlElement, manifested: list[ClassFacts], host: str) -> None:
        if _is_own_node(deployed):
            self._own_hosts[deployed] = host
            self._ledger.take(deployment)
            return
        if deployed in self._facts_of:
            manifested = [self._facts_of[deployed]]
        elif get_kind(deployed) == "Artifact" and not manifested:
            self._libraries[host].append(get_name(deployed))
            self._library_artifacts.add(deployed)
            self._ledger.note(deployed, f"{name_element(deployed)} is a hint of `{host}`: no component is in it")
            self._ledger.take(deployment)
            return
        for facts in manifested:
            # The first deployment counts: the language has one host for a node, and no way to choose the better one.
            if self._host_of.setdefault(facts, host) != host:
                words = f"`{facts.id}` runs on `{self._host_of[facts]}` already: one component is on one host"
                self._ledger.leave(deployment, words)
        if manifested:
            self._ledger.take(deployment)
        else:
            self._ledger.leave(
                deployment, f"{name_element(deployed)} is not taken to `{host}`: it is no artifact or component"
            )

    def make_hosts(self) -> dict[str, object]:
        """Return the section `hosts`."""
        section: dict[str, object] = {}
        for element, host_id in self._hosts.items():
            middlewares = self._middlewares.get(host_id, [])
            hints = make_hints(
                element,
                middleware=middlewares[0] if len(middlewares) == 1 else middlewares,
                artifacts=list(dict.fromkeys(self._libraries.get(host_id, ()))),
            )
            section[host_id] = say_title(get_name(element), host_id) | read_description(self._ledger, element) | hints
        return section

    def make_nodes(self) -> dict[str, object]:
        """Return the section `nodes`: a node for each component that is deployed or has an artifact."""
        section: dict[str, object] = dict(self._own_nodes)
        for facts in dict.fromkeys((*self._package_of, *self._host_of)):
            if facts.root.sort != "component" or facts.device or facts.inside:
                self._leave_undeployable(facts)
                continue
            node: dict[str, object] = {"implements": ".".join(facts.path)}
            artifact = self._package_of.get(facts)
            if artifact is not None:
                node["package"] = get_name(artifact)
                self._ledger.take(artifact)
            if facts in self._host_of:
                node["host"] = self._host_of[facts]
            section[make_unique_id(facts.id, section.keys())] = node
        used = {*self._package_of.values(), *self._library_artifacts}
        for artifact in self._catalogue.artifacts:
            if not _is_own_node(artifact) and artifact not in used:
                self._ledger.refuse(artifact, "it is on no node, and no component is in it")
        return section

    def _leave_undeployable(self, facts: ClassFacts) -> None:
        why = "it stands in a component type" if facts.root.sort != "component" else "it is made of components"
        why = "it is a device" if facts.device else why
        if host := self._host_of.get(facts):
            words = f"{name_element(facts.element)} is not deployed on `{host}`: {why}"
            self._ledger.note(facts.element, words, "" if facts.device else "deploy the components themselves")
        if artifact := self._package_of.get(facts):
            words = f"{name_element(artifact)} is not taken as a package of {name_element(facts.element)}: {why}"
            self._ledger.leave(artifact, words)

    def make_links(self) -> dict[str, object]:
        """Return the section `links`: communication paths, and associations of nodes and devices."""
        section: dict[str, object] = {}
        for element in self._catalogue.paths:
            ends = self._find_ends(element)
            if not ends or len(ends) == 1:
                why = (
                    "it joins a node with itself"
                    if ends
                    else "what flows between components is said by ports and interfaces"
                )
                self._ledger.refuse(element, why)
                continue
            link_id = choose_id(element, "link", section.keys(), get_name(element) or "link", self._index.known_ids)
            section[link_id] = {"connects": ends} | say_title(get_name(element), link_id) | make_hints(element)
            self._ledger.take(element)
        return section

    def _find_ends(self, element: XmlElement) -> list[str] | None:
        members = self._index.list_named(element, "memberEnd")
        properties = list(dict.fromkeys((*members, *list_child_elements(element, "Property"))))
        ends = [target for each in properties for target in self._index.list_named(each, "type")[:1]]
        ends = ends or self._index.list_named(element, "endType")
        references: list[str] = []
        for end in ends:
            host = self._hosts.get(end) or (self._find_host(end) if get_kind(end) == "ExecutionEnvironment" else None)
            facts = self._facts_of.get(end)
            is_known = facts is not None and (facts.device or get_id(element).startswith(OWN_PREFIX))
            if host is None and not is_known:
                return None
            references.append(host or ".".join(facts.path if facts else ()))
        return list(dict.fromkeys(references)) or None


def _list_parent(index: UmlIndex, element: XmlElement) -> list[XmlElement]:
    parent = index.get_parent(element)
    return [] if parent is None else [parent]


def _is_own_node(artifact: XmlElement) -> bool:
    """Whether an artifact is a node that archgen exported."""
    return get_id(artifact).startswith(f"{OWN_PREFIX}node.")


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
    titled = next((model for document in documents for model in document.models if get_name(model)), None)
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
