"""The view `uml`: the model as one tree of elements in Eclipse UML2's form.

Hosts, links and nodes as UML nodes, communication paths and deployed artifacts.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterator, Mapping
from typing import Any

from archgen.plugin.generating import GeneratedView, GenerationContext, title_from_id
from archgen.plugin.model import Architecture
from archgen.plugins.xmi.views.uml_components import UmlComponents
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
from archgen.plugins.xmi.views.uml_wiring import UmlWiring


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
