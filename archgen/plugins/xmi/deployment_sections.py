"""Nodes, devices, communication paths, artifacts and execution environments: hosts, links and what runs where."""

from __future__ import annotations

from collections import defaultdict

from archgen.plugin.importing import XmlElement, make_unique_id
from archgen.plugins.xmi.component_assembly import ComponentAssembly
from archgen.plugins.xmi.component_facts import ClassFacts
from archgen.plugins.xmi.import_ledger import OWN_PREFIX, choose_id, make_hints, name_element, say_title
from archgen.plugins.xmi.uml_catalogue import read_description
from archgen.plugins.xmi.uml_index import UmlIndex, get_id, get_kind, get_name, list_child_elements

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
