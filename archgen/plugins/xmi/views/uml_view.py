"""The view `uml`: the model as one tree of elements in Eclipse UML2's form.

Hosts, links and nodes as UML nodes, communication paths and deployed artifacts.

Connections as interfaces that ports realize and use, and as connectors inside of composed components.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterator, Mapping
from typing import Any

from archgen.plugin.generating import GeneratedView, GenerationContext, make_camel_name, title_from_id
from archgen.plugin.model import Architecture, Connection, Input
from archgen.plugins.xmi.views.uml_components import PortPath, UmlComponents, name_output_interface
from archgen.plugins.xmi.views.uml_types import (
    TYPE_PREFIX,
    IdRegistry,
    UmlTree,
    UmlTypes,
    list_names,
    make_comments,
    make_tree,
    read_hints,
    read_mapping,
)


class UmlWiring:
    """Writes interfaces with who realizes and uses them, and the connectors of what stands inside."""

    def __init__(
        self, architecture: Architecture, registry: IdRegistry, types: UmlTypes, components: UmlComponents
    ) -> None:
        self._architecture, self._registry, self._types = architecture, registry, types
        self._components = components
        self._interfaces: dict[PortPath, str] = {}
        self.relations: list[UmlTree] = []
        self.connectors: dict[str, list[UmlTree]] = {}
        """The connectors of composed components and types, by path."""

    def write_outputs(self) -> None:
        """Write an interface for each output of a component. Those of component types need none."""
        for (path, name), hints in self._components.outputs.items():
            if (path, name) in self._components.port_ids and not _is_type(path):
                for number, each in enumerate(list_names(read_hints(hints), "interface") or [""]):
                    self._write_interface((path, name), each, is_first=number == 0)

    def _write_interface(self, port: PortPath, name: str, *, is_first: bool) -> None:
        path = ".".join(port)
        interface_id = self._registry.claim(f"{'interface' if name else 'made_interface'}.{path}")
        interface = make_tree("packagedElement", "Interface", interface_id, name or name_output_interface(*port))
        operation_id = self._registry.claim(f"getter.{path}")
        operation = make_tree("ownedOperation", "Operation", operation_id, f"get{make_camel_name(port[1])}")
        shell = self._architecture.shells.get(port[0])
        output = self._architecture.outputs.get(path) or (shell.outputs.get(port[1]) if shell else None)
        if output is not None and output.type:
            answer_id = self._registry.claim(f"argument.{operation_id}.return")
            answer_type = self._types.refer(output.type)
            answer = make_tree("ownedParameter", "Parameter", answer_id, "return", type=answer_type, direction="return")
            operation["children"].append(answer)
        interface["children"].append(operation)
        realization_id = self._registry.claim(f"realizes.{path}")
        port_id = self._components.port_ids[port]
        realization = make_tree("packagedElement", "Realization", realization_id, client=port_id, supplier=interface_id)
        self.relations += [interface, realization]
        if is_first:
            self._interfaces[port] = interface_id

    def write_inputs(self, bodies: Mapping[str, Any]) -> None:
        """Write what each input reads. `bodies` are the packed component types, for references inside of them."""
        samples = self._components.samples
        for (path, name), hints in self._components.inputs.items():
            if (path, name) not in self._components.port_ids:
                continue
            place = path
            if _is_type(path):
                type_name, inner = _split_type(path, bodies)
                place = f"{samples[type_name]}.{inner}" if inner and type_name in samples else ""
            reader = self._architecture.inputs.get(f"{place}.{name}") or self._find_shell_input(place, name)
            sources = (
                list(dict.fromkeys(s for each in reader.connections for s in _list_sources(each))) if reader else []
            )
            self._connect((path, name), place, sources, hints)

    def _find_shell_input(self, place: str, name: str) -> Input | None:
        shell = self._architecture.shells.get(place)
        return shell.inputs.get(name) if shell else None

    def _connect(self, port: PortPath, place: str, sources: list[str], hints: object) -> None:
        path = port[0]
        owner, owner_place = path.rpartition(".")[0], place.rpartition(".")[0]
        is_joined = False
        for source in sources:
            component, _, output = source.rpartition(".")
            if owner_place and component == owner_place and (owner, output) in self._components.port_ids:
                self._join(owner, (owner, output), port)
                is_joined = True
            elif component.rpartition(".")[0] == owner_place and "." in owner and owner_place:
                sibling = (f"{owner}.{component.rpartition('.')[2]}", output)
                if sibling in self._components.port_ids:
                    self._join(owner, sibling, port)
                    is_joined = True
            elif not _is_type(path) and (interface := self._interfaces.get((component, output))):
                self._use(port, interface)
                is_joined = True
        if _is_type(path) and not is_joined:
            # No instance shows what is read there, or its own input reads nothing.
            for written in _read_references(owner, self._components.written_sources.get(port), around=owner):
                if written in self._components.port_ids:
                    self._join(owner, written, port)
                    is_joined = True
        if not is_joined:
            self._leave_open(port, hints)

    def _join(self, owner: str, first: PortPath, second: PortPath) -> None:
        """Write a connector between two ports inside of a composed component, or one of them its own."""
        connector_id = self._registry.claim(f"connector.{'.'.join(second)}")
        ends = [
            make_tree("end", "ConnectorEnd", f"{connector_id}.end{number}", role=self._components.port_ids[port])
            for number, port in enumerate((first, second), 1)
        ]
        connector = make_tree("ownedConnector", "Connector", connector_id, "", ends)
        self.connectors.setdefault(owner, []).append(connector)
        # A connector says which way the data goes only where one of its ends does.
        if second in self._components.inputs:
            self._leave_open(second, None)

    def _use(self, port: PortPath, interface_id: str) -> None:
        usage_id = self._registry.claim(f"usage.{'.'.join(port)}")
        client = self._components.port_ids[port]
        usage = make_tree("packagedElement", "Usage", usage_id, client=client, supplier=interface_id)
        self.relations.append(usage)

    def _leave_open(self, port: PortPath, hints: object) -> None:
        """Let an input use an interface that nobody realizes: else it would be taken for an output."""
        kept = read_hints(hints).get("interface")
        path = ".".join(port)
        interface_id = self._registry.claim(f"{'interface' if kept else 'made_interface'}.needed.{path}")
        name = kept if isinstance(kept, str) and kept else name_output_interface(*port)
        self.relations.append(make_tree("packagedElement", "Interface", interface_id, name))
        self._use(port, interface_id)

    def write_delegations(self, composed: Iterator[tuple[str, Mapping[str, Any]]]) -> None:
        """Write what outputs of composed components pass on. `composed` are these with their paths."""
        for path, body in composed:
            place = self._components.samples.get(path.removeprefix(TYPE_PREFIX), "") if _is_type(path) else path
            for name, port in read_mapping(body.get("outputs")).items():
                given = self._architecture.shell_ports.get(f"output {place}.{name}", ()) if place else ()
                inner = [(_move_path(each, place, path), each.rpartition(".")[2]) for each in given]
                for each in inner or _read_references(path, read_mapping(port).get("from")):
                    if each in self._components.port_ids and (path, name) in self._components.port_ids:
                        self._join(path, (path, name), each)


def _move_path(output: str, place: str, path: str) -> str:
    """Return the path of an output's component inside of a type, for that inside of an instance."""
    component = output.rpartition(".")[0]
    return f"{path}.{component.rpartition('.')[2]}" if component.rpartition(".")[0] == place else ""


def _read_references(path: str, written: object, around: str = "") -> list[PortPath]:
    """Return the ports inside of a component that references name by their last two words; `self.x` is one of `around`."""
    references = [written] if isinstance(written, str) else written if isinstance(written, list) else []
    words = [str(each).split(".") for each in references]
    return [
        (around if each[-2] == "self" and around else f"{path}.{each[-2]}", each[-1]) for each in words if len(each) > 1
    ]


def _is_type(path: str) -> bool:
    return path.startswith(TYPE_PREFIX)


def _split_type(path: str, bodies: Mapping[str, Any]) -> tuple[str, str]:
    """Return the component type of a path in it, and the path inside."""
    words = path.removeprefix(TYPE_PREFIX).split(".")
    for length in (2, 1):
        name = ".".join(words[:length])
        if name in bodies:
            return name, ".".join(words[length:])
    return "", ""


def _list_sources(connection: Connection) -> tuple[str, ...]:
    """Return the ports that a connection reads, by complete ids: those of composed components where they are written."""
    if connection.shell_port is not None and connection.shell_port.count(".") > 1:
        return (connection.shell_port,)
    return (connection.target,) if connection.kind == "output" else connection.outputs


def make_view(context: GenerationContext) -> GeneratedView:
    """Return the model; where only types are asked for, the component types with the types that they name."""
    return GeneratedView(_make_model(context, context.pack_project()))


def _make_model(context: GenerationContext, packed: Mapping[str, Any]) -> UmlTree:
    architecture, selected, types_only = context.architecture, context.components, context.types_only
    registry = IdRegistry()
    wanted = None if selected is None else _add_outer(selected)
    bodies = _list_type_bodies(packed)
    types = UmlTypes(registry, read_mapping(packed.get("types")))

    def wants(path: str) -> bool:
        return wanted is None or path in wanted

    components = UmlComponents(architecture, registry, types, wants, bodies)
    groups = {} if types_only else read_mapping(packed.get("groups"))
    shown_types = _list_shown_types(architecture, bodies, selected if not types_only else None)
    classes = {name: components.write_type(name) for name in shown_types}
    packages = [components.write_group(name, read_mapping(body)) for name, body in groups.items()]
    wiring = UmlWiring(architecture, registry, types, components)
    wiring.write_outputs()
    wiring.write_inputs(bodies)
    wiring.write_delegations(_list_composed(bodies, shown_types, groups))
    _place_connectors([*classes.values(), *packages], components, wiring.connectors)
    deployment = []
    if not types_only:
        deployment = write_deployment(architecture, registry, packed, components.component_ids, wants)
    written_types = types.write_types(only_used=selected is not None)
    project = read_mapping(packed.get("project"))
    title = str(project.get("title") or title_from_id(str(project.get("id") or "model")))
    model_id = registry.claim("project")
    children = [
        *_make_package(registry, "types", "Types", written_types),
        *_make_package(
            registry, "classes", "Component types", [*classes.values(), *components.templates.bound_classes]
        ),
        *(each for each in packages if any(child["tag"] == "packagedElement" for child in each["children"])),
        *_make_package(registry, "interfaces", "Interfaces", wiring.relations),
        *_make_package(registry, "deployment", "Deployment", deployment),
    ]
    return make_tree("uml:Model", "", model_id, title, children)


def _make_package(registry: IdRegistry, name: str, title: str, contents: list[UmlTree]) -> Iterator[UmlTree]:
    if contents:
        yield make_tree("packagedElement", "Package", registry.claim(f"package.{name}"), title, contents)


def _add_outer(selected: Collection[str]) -> frozenset[str]:
    """Return components with all that they stand in."""
    words = [each.split(".") for each in selected]
    return frozenset(".".join(each[:length]) for each in words for length in range(2, len(each) + 1))


def _list_type_bodies(packed: Mapping[str, Any]) -> dict[str, Any]:
    """Return the component types of the project, and those of its libraries with the library's id before them."""
    bodies = dict(read_mapping(packed.get("component_types")))
    for library, body in read_mapping(packed.get("libraries")).items():
        own = read_mapping(read_mapping(body).get("component_types"))
        for name, each in own.items():
            bodies[f"{library}.{name}"] = _name_fully(read_mapping(each), library, own)
    return bodies


def _name_fully(body: Mapping[str, Any], library: str, own: Collection[str]) -> dict[str, Any]:
    """Return a body in which `is` names types as the project does: those of a library do without its id among themselves."""
    named = dict(body)
    base = str(named.get("is") or "")
    if base.partition("<")[0] in own:
        named["is"] = f"{library}.{base}"
    if inside := read_mapping(named.get("components")):
        named["components"] = {name: _name_fully(read_mapping(each), library, own) for name, each in inside.items()}
    return named


def _list_shown_types(
    architecture: Architecture, bodies: Mapping[str, Any], selected: Collection[str] | None
) -> list[str]:
    """Return the component types to write: all, or those of selected components with what they are made from."""
    if selected is None:
        return list(bodies)
    everyone = {**architecture.components, **architecture.shells}
    waiting = [everyone[each].type_name for each in sorted(_add_outer(selected)) if each in everyone]
    shown: set[str] = set()
    while waiting:
        name = waiting.pop()
        if name in bodies and name not in shown:
            shown.add(name)
            body = read_mapping(bodies[name])
            inner = read_mapping(body.get("components")).values()
            made_from = (str(read_mapping(each).get("is") or "") for each in (body, *inner))
            waiting += [each.partition("<")[0] for each in made_from]
    return [each for each in bodies if each in shown]


def _list_composed(
    bodies: Mapping[str, Any], shown_types: list[str], groups: Mapping[str, Any]
) -> Iterator[tuple[str, Mapping[str, Any]]]:
    """Yield all components and types that hold components, with their paths."""
    stack = [(f"{TYPE_PREFIX}{name}", read_mapping(bodies[name])) for name in shown_types]
    stack += [
        (f"{group}.{name}", read_mapping(each))
        for group, body in groups.items()
        for name, each in read_mapping(read_mapping(body).get("components")).items()
    ]
    while stack:
        path, body = stack.pop(0)
        inside = read_mapping(body.get("components"))
        if inside:
            yield path, body
            stack += [(f"{path}.{name}", read_mapping(each)) for name, each in inside.items()]


def _place_connectors(trees: list[UmlTree], components: UmlComponents, connectors: Mapping[str, list[UmlTree]]) -> None:
    """Put each connector into the class or component whose inside it joins."""
    paths = {element_id: path for path, element_id in components.component_ids.items()}
    paths |= {element_id: f"{TYPE_PREFIX}{name}" for name, element_id in components.class_ids.items()}
    stack = list(trees)
    while stack:
        tree = stack.pop()
        element_id = next((value for key, value in tree["attributes"] if key == "xmi:id"), "")
        tree["children"] += connectors.get(paths.get(element_id, ""), [])
        stack += [each for each in tree["children"] if each["tag"] in {"packagedElement", "nestedClassifier"}]


def write_deployment(
    architecture: Architecture,
    registry: IdRegistry,
    packed: Mapping[str, Any],
    component_ids: Mapping[str, str],
    wants: Callable[[str], bool],
) -> list[UmlTree]:
    """Return the elements of a deployment diagram. Planned nodes that nobody wrote are left out."""
    hosts = read_mapping(packed.get("hosts"))
    host_trees: dict[str, UmlTree] = {}
    host_ids: dict[str, str] = {}
    trees: list[UmlTree] = []
    for host_id, host in architecture.hosts.items():
        body = read_mapping(hosts.get(host_id))
        host_ids[host_id] = registry.claim(f"host.{host_id}", body.get("hints"))
        tree = host_trees[host_id] = make_tree("packagedElement", "Node", host_ids[host_id], host.title)
        tree["children"] += make_comments(host_ids[host_id], body)
        trees += [tree, *_write_hints(registry, host_id, tree, host_ids[host_id], read_hints(body.get("hints")))]
    for node in architecture.nodes.values():
        manifested = [each for each in node.implements if each in component_ids and wants(each)]
        if not node.written or not manifested:
            continue
        artifact_id = registry.claim(f"node.{node.id}")
        file_name = "/".join(filter(None, (node.package, node.executable))) or None
        artifact = make_tree("packagedElement", "Artifact", artifact_id, node.title, fileName=file_name)
        for component in manifested:
            manifestation_id = registry.claim(f"manifestation.{node.id}.{component}")
            target = component_ids[component]
            words = {"client": artifact_id, "supplier": target, "utilizedElement": target}
            artifact["children"].append(make_tree("manifestation", "Manifestation", manifestation_id, **words))
        trees.append(artifact)
        if node.host in host_trees:
            _deploy_artifact(
                registry, host_trees[node.host], host_ids[node.host], artifact_id, f"{node.host}.{node.id}"
            )
    trees += _write_links(architecture, registry, packed, host_ids, component_ids)
    return trees


def _deploy_artifact(registry: IdRegistry, host: UmlTree, host_id: str, artifact_id: str, path: str) -> None:
    words = {"client": host_id, "supplier": artifact_id, "deployedArtifact": artifact_id}
    host["children"].append(make_tree("deployment", "Deployment", registry.claim(f"deployment.{path}"), **words))


def _write_hints(
    registry: IdRegistry, name: str, host: UmlTree, host_id: str, hints: Mapping[str, Any]
) -> list[UmlTree]:
    """Write the execution environments and the libraries that an import found at a node."""
    for number, each in enumerate(list_names(hints, "middleware"), 1):
        environment_id = registry.claim(f"environment.{name}.{number}")
        host["children"].append(make_tree("nestedNode", "ExecutionEnvironment", environment_id, each))
    libraries = []
    for number, each in enumerate(list_names(hints, "artifacts"), 1):
        artifact_id = registry.claim(f"library.{name}.{number}")
        libraries.append(make_tree("packagedElement", "Artifact", artifact_id, each))
        _deploy_artifact(registry, host, host_id, artifact_id, f"library.{name}.{number}")
    return libraries


def _write_links(
    architecture: Architecture,
    registry: IdRegistry,
    packed: Mapping[str, Any],
    host_ids: Mapping[str, str],
    component_ids: Mapping[str, str],
) -> list[UmlTree]:
    written = read_mapping(packed.get("links"))
    trees = []
    for link in architecture.links.values():
        ends = [host_ids[each] for each in link.connects if each in host_ids]
        ends += [component_ids[each] for each in link.devices if each in component_ids]
        if len(ends) < 2:  # noqa: PLR2004 - a path joins two
            continue
        body = read_mapping(written.get(link.id))
        link_id = registry.claim(f"link.{link.id}", body.get("hints"))
        end_ids = [registry.claim(f"end.{link.id}.{number}") for number in range(1, len(ends) + 1)]
        children = [
            make_tree("ownedEnd", "Property", end_id, type=target, association=link_id)
            for end_id, target in zip(end_ids, ends, strict=True)
        ]
        words = {"memberEnd": " ".join(end_ids)}
        trees.append(make_tree("packagedElement", "CommunicationPath", link_id, link.title, children, **words))
    return trees
