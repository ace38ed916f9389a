"""The view `structure`: both levels as plain data for the models of other tools: parts, ports, connections, nodes, topics, hosts."""

from __future__ import annotations

from collections.abc import Collection, Iterable
from typing import Any

from archgen.bringup.program_names import name_ports
from archgen.grouping import group_pairs
from archgen.model.architecture import Architecture
from archgen.model.component import Component, Input, Output
from archgen.model.node import Endpoint, Node
from archgen.model.port_media import word_of_medium
from archgen.views.generation.generation_context import GeneratedView, GenerationContext, write_place
from archgen.views.generation.program_parts import record_parameters, record_ports


def make_view(context: GenerationContext) -> GeneratedView:
    """Return what is asked for of both levels; a connection where both of its ends are there.

    Left out of a node is what has no message and parameters that ROS has no type for: an export says what is known.
    """
    architecture, leaves = context.architecture, context.wanted_components
    shells = {outer for leaf in leaves for outer in _list_outer_components(architecture, leaf)}
    wanted = {each for each in (*architecture.shells, *architecture.components) if each in leaves or each in shells}
    connections = _record_connections(architecture, leaves)
    shows_ros = context.level == "implementation"
    nodes_on_hosts = group_pairs((node.host, node.id) for node in context.wanted_nodes.values())
    return GeneratedView(
        {
            "project": {
                "id": architecture.project.id,
                "title": architecture.project.title,
                "version": architecture.project.version or "",
                "description": architecture.project.description or "",
            },
            "groups": _record_groups(context, wanted),
            "components": [_record_component(context, each, wanted) for each in _sort_components(context, wanted)],
            "connections": connections,
            "arrows": _merge_connections(connections),
            "nodes": _record_nodes(context) if shows_ros else [],
            "topics": _record_topics(context) if shows_ros else [],
            "hosts": [
                {
                    "id": host.id,
                    "title": host.title,
                    "nodes": nodes_on_hosts.get(host.id, []),
                    "place": write_place(host.at),
                }
                for host in architecture.hosts.values()
                if shows_ros and (context.is_whole or host.id in nodes_on_hosts)
            ],
        }
    )


def _list_outer_components(architecture: Architecture, component_id: str) -> Iterable[str]:
    parent = _find_component(architecture, component_id).parent
    while parent is not None:
        yield parent
        parent = architecture.shells[parent].parent


def _find_component(architecture: Architecture, component_id: str) -> Component:
    return architecture.components.get(component_id) or architecture.shells[component_id]


def _sort_components(context: GenerationContext, wanted: Collection[str]) -> list[str]:
    """Return the complete ids in the order of the groups, a composed component before what stands inside."""
    architecture = context.architecture
    in_order = dict.fromkeys(
        each
        for component in architecture.components
        if component in wanted
        for each in (*reversed(tuple(_list_outer_components(architecture, component))), component)
    )
    places = {group: place for place, group in enumerate(architecture.groups)}
    return sorted(in_order, key=lambda each: places[each.partition(".")[0]])


def _record_groups(context: GenerationContext, wanted: Collection[str]) -> list[dict[str, Any]]:
    architecture = context.architecture
    outermost: dict[str, list[str]] = {}
    for each in (*architecture.shells.values(), *architecture.components.values()):
        if each.id in wanted and each.parent is None:
            outermost.setdefault(each.group, []).append(each.id)
    records = [
        {
            "id": group.id,
            "title": group.title,
            "description": group.description or "",
            "owner": group.owner or "",
            "place": write_place(group.at),
            "components": [_record_component(context, each, wanted) for each in outermost.get(group.id, ())],
        }
        for group in architecture.groups.values()
    ]
    return [each for each in records if each["components"]]


def _record_component(context: GenerationContext, component_id: str, wanted: Collection[str]) -> dict[str, Any]:
    """Return a component with its ports and, below `components`, what stands inside, to any depth."""
    architecture = context.architecture
    component = _find_component(architecture, component_id)
    return {
        "id": component.id,
        "name": component.name,
        "title": component.title,
        "group": component.group,
        "parent": component.parent or "",
        "type": component.component_type or "",
        "functionality": component.functionality or "",
        "description": component.description or "",
        "owner": component.owner or "",
        "status": component.status or "",
        "tags": list(component.tags),
        "is_composed": component.id in architecture.shells,
        "nodes": [node.id for node in context.implementing_nodes.get(component.id, ())],
        "inputs": [_record_port(architecture, port) for port in component.inputs.values()],
        "outputs": [_record_port(architecture, port) for port in component.outputs.values()],
        "components": [_record_component(context, each, wanted) for each in component.children if each in wanted],
        "place": write_place(component.at),
    }


def _record_port(architecture: Architecture, port: Input | Output) -> dict[str, Any]:
    return {
        "id": port.id,
        "name": port.name,
        "type": port.type or "",
        "message": architecture.message_of(port) or "",
        "medium": word_of_medium(port),
        "external": port.external or "",
        "place": write_place(port.at),
    }


def _record_connections(architecture: Architecture, leaves: Collection[str]) -> list[dict[str, Any]]:
    records = []
    for edge in architecture.edges:
        output, reader = architecture.outputs[edge.output], architecture.inputs[edge.input]
        if output.component in leaves and reader.component in leaves:
            records.append(
                {
                    "output": output.id,
                    "input": reader.id,
                    "source": output.component,
                    "target": reader.component,
                    "flow": architecture.flow_of(output),
                    "type": output.type or "",
                    "message": architecture.message_of(output) or "",
                    "medium": word_of_medium(output),
                    "place": write_place(edge.at),
                }
            )
    return records


def _merge_connections(connections: Iterable[dict[str, Any]]) -> list[dict[str, Any]]:
    """Return an arrow for each pair of components and way of flowing; a client calls, so that its arrow leads to the server."""
    arrows: dict[tuple[str, str, str], list[str]] = {}
    for connection in connections:
        ends = (connection["source"], connection["target"])
        tail, head = ends if connection["flow"] == "topic" else reversed(ends)
        labels = arrows.setdefault((tail, head, connection["flow"]), [])
        # A message without its package: arrows have little room.
        labels.append(connection["type"].rpartition("/")[2] or connection["output"].rpartition(".")[2])
    return [
        {"tail": tail, "head": head, "flow": flow, "labels": list(dict.fromkeys(labels))}
        for (tail, head, flow), labels in arrows.items()
    ]


def _record_nodes(context: GenerationContext) -> list[dict[str, Any]]:
    architecture = context.architecture
    endpoints: dict[str, list[Endpoint]] = {}
    for endpoint in architecture.endpoints:
        if endpoint.medium == "ros":
            endpoints.setdefault(endpoint.node, []).append(endpoint)
    return [_record_node(architecture, node, endpoints) for node in context.wanted_nodes.values()]


def _record_node(architecture: Architecture, node: Node, endpoints: dict[str, list[Endpoint]]) -> dict[str, Any]:
    sections, _ = record_ports(architecture, (node,), name_ports(architecture, (node,), endpoints))
    parameters, _ = record_parameters(architecture, (node,))
    return {
        "id": node.id,
        "title": node.title,
        "description": node.description or "",
        "name": node.name,
        "full_name": node.full_name,
        "kinds": list(node.kinds),
        "is_program": node.is_program,
        "package": node.package or "",
        "executable": node.executable or "",
        "host": node.host or "",
        "container": node.container or "",
        "status": node.status or "",
        "implements": list(node.implements),
        "parameters": parameters,
        **sections,
        "place": write_place(node.at),
    }


def _record_topics(context: GenerationContext) -> list[dict[str, Any]]:
    records = []
    for topic in (*context.architecture.topics.values(), *context.architecture.channels.values()):
        writers = list(dict.fromkeys(each.node for each in topic.writers if each.node in context.wanted_nodes))
        readers = list(dict.fromkeys(each.node for each in topic.readers if each.node in context.wanted_nodes))
        if writers or readers:
            records.append(
                {
                    "name": topic.name,
                    "flow": topic.flow,
                    "medium": word_of_medium(topic),
                    "messages": list(topic.messages),
                    "types": list(topic.types),
                    "writers": writers,
                    "readers": readers,
                }
            )
    return records
