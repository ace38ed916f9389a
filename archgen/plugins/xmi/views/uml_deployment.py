"""Hosts, links and nodes as UML nodes, communication paths and deployed artifacts."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

from archgen.plugin.model import Architecture
from archgen.plugins.xmi.views.uml_tree import (
    IdRegistry,
    UmlTree,
    list_names,
    make_comments,
    make_tree,
    read_hints,
    read_mapping,
)


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
        tree = make_tree("packagedElement", "CommunicationPath", link_id, link.title, memberEnd=" ".join(end_ids))
        for end_id, target in zip(end_ids, ends, strict=True):
            tree["children"].append(make_tree("ownedEnd", "Property", end_id, type=target, association=link_id))
        trees.append(tree)
    return trees
