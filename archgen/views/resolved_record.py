"""The resolved model as plain data, for other programs and code generators (`schemas/resolved.schema.json`).

Elements are keyed by their full ids, and what is not known is left out. A quantity has the text as written (`text`),
the number (`value`) and its unit (`unit`): ns, Hz, B or bit/s.
"""

from __future__ import annotations

from archgen.model.architecture import Architecture, Chain
from archgen.model.component import Component, ComponentType, Group, Input, Output
from archgen.model.coordinate_frames import Frame
from archgen.model.deployment import Container, Host, Link
from archgen.model.node import Node
from archgen.model.port_media import ROS, is_physical, word_of_medium
from archgen.model.requirement import Requirement
from archgen.views.carrier_record import record_carriers, record_endpoints
from archgen.views.lookup import Lookup
from archgen.views.parameter_record import record_effective, record_operation, record_parameter, record_values
from archgen.views.promise_record import record_life, record_words
from archgen.views.record_values import drop_unknown, pick_fields, record_annotations, record_quantity, to_plain
from archgen.views.shapes import Record
from archgen.views.start_record import record_start
from archgen.views.timing_record import record_timing
from archgen.views.type_record import record_type
from archgen.views.use_case_record import record_use_cases

RECORD_VERSION = 1
"""Version of the format, written as `archgen_resolved`."""


def make_record(lookup: Lookup) -> Record:
    """Return the architecture, or the part in scope, as dicts, lists and scalars."""
    architecture, is_shown = lookup.architecture, lookup.scope.shows_component
    return {
        "archgen_resolved": RECORD_VERSION,
        "project": pick_fields(architecture.project, "id", "title", "version", "description")
        | drop_unknown(
            {
                "middleware": None if architecture.project.middleware == ROS else architecture.project.middleware,
                "distro": architecture.distro,
                "parameters": record_values(architecture.ros_parameters),
            }
        ),
        # Groups, components, connections, edges, nodes and topics are cut to the scope; all else is given in full.
        "partners": {
            p.id: pick_fields(p, "title", "description", "contact", "reviewers") | record_annotations(p)
            for p in architecture.partners.values()
        },
        "use_cases": record_use_cases(lookup),
        "requirements": {r.id: _record_requirement(lookup, r) for r in architecture.requirements.values()},
        **_record_vocabulary(architecture),
        "groups": {name: _record_group(lookup, architecture.groups[name]) for name in lookup.shown_groups()},
        "components": {c.id: _record_component(lookup, c) for c in architecture.components.values() if is_shown(c.id)},
        **_record_composition(lookup),
        "connections": [
            pick_fields(c, "input", "kind", "target", "outputs", "shell_port")
            | drop_unknown({"is_made": c.is_made or None})
            for c in architecture.connections
            if is_shown(architecture.inputs[c.input].component)
        ],
        "edges": [
            drop_unknown({"from": e.output, "to": e.input, **_record_flow(lookup, e.output)})
            for e in architecture.edges
            if is_shown(architecture.inputs[e.input].component) or is_shown(architecture.outputs[e.output].component)
        ],
        "nodes": {node.id: _record_node(lookup, node) for node in lookup.shown_nodes()},
        **record_carriers(lookup),
        "types": {
            t.name: record_type(t, architecture.interfaces) | record_annotations(t) for t in architecture.types.values()
        },
        "hosts": {host.id: _record_host(host) for host in architecture.hosts.values()},
        "containers": {container.id: _record_container(container) for container in architecture.containers.values()},
        **_record_resources(architecture),
        "links": {link.id: _record_link(link) for link in architecture.links.values()},
        **_record_frames(architecture),
        "chains": {chain.id: _record_chain(chain) for chain in architecture.chains.values()},
        **_record_variants(architecture),
    }


def _record_variants(architecture: Architecture) -> dict[str, object]:
    """Return the section of variants, empty in a project without any, and in one as it stands in one of them."""
    variants = {
        each.id: pick_fields(each, "title", "description", "of", "without", "drop")
        | drop_unknown({"changes": {change.path: change.value for change in each.changes}})
        for each in architecture.variants.values()
    }
    return drop_unknown({"variants": variants})


def _record_vocabulary(architecture: Architecture) -> dict[str, object]:
    """Return the declared properties and the glossary, nothing in a project without them."""
    properties = {
        each.id: pick_fields(each, "title", "description", "of", "type", "unit", "choices")
        | drop_unknown(
            {
                "range": [str(limit) for limit in each.range] if each.range else None,
                "required": each.required or None,
            }
        )
        for each in architecture.properties.values()
    }
    return drop_unknown(
        {"properties": properties, "glossary": {t.term: t.text for t in architecture.glossary.values()}}
    )


def _record_composition(lookup: Lookup) -> dict[str, object]:
    """Return composed components and component types, empty in a project without any."""
    architecture, is_shown = lookup.architecture, lookup.scope.shows_component
    shells = {
        shell.id: _record_component(lookup, shell)
        | {
            "components": list(shell.children),
            "behind": {
                f"{kind} {port.name}": list(architecture.leaf_ports_of(kind, port.id))
                for kind, ports in (("input", shell.inputs), ("output", shell.outputs))
                for port in ports.values()
            },
        }
        for shell in architecture.shells.values()
        if any(map(is_shown, architecture.leaves_of(shell.id)))
    }
    types = {each.id: _record_component_type(each) for each in architecture.component_types.values()}
    return drop_unknown({"composed": shells, "component_types": types})


def _record_component_type(component_type: ComponentType) -> dict[str, object]:
    fields = {
        "is": component_type.base,
        "generic": list(component_type.generic),
        "abstract": component_type.is_abstract or None,
        **record_life(component_type),
        "inputs": {name: kind or "" for name, kind in component_type.inputs.items()},
        "outputs": {name: kind or "" for name, kind in component_type.outputs.items()},
        "components": list(component_type.components),
        "parameters": {name: record_parameter(each) for name, each in component_type.parameters.items()},
        "open": list(component_type.open),
        "operations": {name: record_operation(each) for name, each in component_type.operations.items()},
        "frames": {frame.id: _record_frame(frame) for frame in component_type.frames},
    }
    own_fields = pick_fields(
        component_type, "title", "owner", "functionality", "description", "status", "contact", "image"
    )
    return own_fields | drop_unknown(dict(fields)) | record_annotations(component_type)


def _record_requirement(lookup: Lookup, requirement: Requirement) -> dict[str, object]:
    servers = {
        "served_by": [component.id for component in lookup.components_for_requirement.get(requirement.id, ())],
        "served_by_chains": [chain.id for chain in lookup.chains_for_requirement.get(requirement.id, ())],
        "urls": dict(requirement.urls),
        **record_annotations(requirement),
        "parent": list(requirement.parents),
        "verified_by": [{"kind": each.kind, "text": each.text} for each in requirement.verified_by],
    }
    known_fields = pick_fields(
        requirement, "title", "description", "kind", "priority", "rationale", "source", "use_cases", "tags"
    )
    return known_fields | drop_unknown(dict(servers))


def _record_group(lookup: Lookup, group: Group) -> dict[str, object]:
    component_ids = [component.id for component in lookup.shown_components(group.id)]
    fields = pick_fields(group, "title", "description", "owner", "co_owners", "tags")
    return fields | drop_unknown({"components": component_ids, "urls": dict(group.urls), **record_annotations(group)})


def _record_host(host: Host) -> dict[str, object]:
    """Return a host; `scheduling` is by core where single cores have an order of their own."""
    fields = pick_fields(host, "title", "description", "cores", "tags", "scheduling")
    by_core = {str(core): order for core, order in host.core_scheduling.items()}
    return fields | ({"scheduling": by_core} if by_core else {}) | record_annotations(host)


def _record_container(container: Container) -> dict[str, object]:
    fields = pick_fields(container, "title", "host", "threads", "scheduling", "name", "package", "executable")
    own_namespace = {"namespace": container.namespace} if container.namespace != "/" else {}
    parameters = drop_unknown({"parameters": to_plain(container.parameters) or None})
    return fields | own_namespace | parameters | record_annotations(container)


def _record_resources(architecture: Architecture) -> dict[str, object]:
    """Return the section of resources, empty in a project without any."""
    resources = architecture.resources.values()
    return drop_unknown(
        {
            "resources": {
                each.id: pick_fields(each, "title", "host", "scheduling") | record_annotations(each)
                for each in resources
            }
        }
    )


def _record_frames(architecture: Architecture) -> dict[str, object]:
    """Return the section of frames, empty in a project without any."""
    return drop_unknown({"frames": {frame.id: _record_frame(frame) for frame in architecture.frames.values()}})


def _record_frame(frame: Frame) -> dict[str, object]:
    values = {"rate": record_quantity(frame.rate, "Hz"), "static": frame.static or None}
    return pick_fields(frame, "title", "parent", "by") | drop_unknown(dict(values)) | record_annotations(frame)


def _record_link(link: Link) -> dict[str, object]:
    bandwidth = {"bandwidth": record_quantity(link.bandwidth, "bit/s")}
    latency = {"best": record_quantity(link.best, "ns"), "worst": record_quantity(link.worst, "ns")}
    return (
        pick_fields(link, "title", "connects", "devices", "protocol")
        | drop_unknown({**bandwidth, **latency})
        | record_annotations(link)
    )


def _record_chain(chain: Chain) -> dict[str, object]:
    through = [{"kind": point.kind, "id": point.id} for point in chain.through]
    fields = {"through": through, "deadline": record_quantity(chain.deadline, "ns")}
    return pick_fields(chain, "title", "requirements") | drop_unknown(dict(fields)) | record_annotations(chain)


def _record_component(lookup: Lookup, component: Component) -> dict[str, object]:
    return drop_unknown(
        {
            "title": component.title,
            "group": component.group,
            "parent": component.parent,
            "is": component.component_type,
            "is_reference": component.is_reference or None,
            "owner": component.owner,
            "co_owners": list(component.co_owners),
            "role": component.role,
            "functionality": component.functionality,
            "description": component.description,
            "requirements": [use.text for use in component.requirements],
            "performance": {
                i.id: drop_unknown(
                    {
                        "title": i.title,
                        "accuracy": i.accuracy,
                        "execution_time": record_quantity(i.execution_time, "ns"),
                    }
                )
                for i in component.performance
            },
            "inputs": {port.name: _record_input(port) for port in component.inputs.values()},
            "outputs": {port.name: _record_output(lookup, port) for port in component.outputs.values()},
            "parameters": {name: record_parameter(each) for name, each in component.parameters.items()},
            "open": list(component.open),
            "operations": {name: record_operation(each) for name, each in component.operations.items()},
            "nodes": [node.id for node in lookup.nodes_of.get(component.id, ())],
            "timing": record_timing(component.timing),
            "tags": list(component.tags),
            "urls": dict(component.urls),
            "status": component.status,
            "contact": component.contact,
            "image": component.image,
            **record_annotations(component),
        }
    )


def _record_port(port: Input | Output) -> dict[str, object]:
    return {
        "id": port.id,
        "type": port.type,
        "medium": word_of_medium(port),
        "external": port.external,
        "frame": port.frame,
        "description": port.description,
        "urls": dict(port.urls),
        **record_annotations(port),
    }


def _record_input(port: Input) -> dict[str, object]:
    sources = dict.fromkeys(output for connection in port.connections for output in connection.outputs)
    return drop_unknown(
        _record_port(port)
        | {
            "optional": port.optional or None,
            "freshness": record_quantity(port.freshness, "ns"),
            "sources": list(sources),
        }
    )


def _record_output(lookup: Lookup, port: Output) -> dict[str, object]:
    readers = dict.fromkeys(connection.input for connection in lookup.readers_of.get(port.id, ()))
    return drop_unknown(
        _record_port(port)
        | record_words(port)
        | {"message": lookup.architecture.message_of(port), "readers": list(readers)}
    )


def _record_flow(lookup: Lookup, output_id: str) -> dict[str, object]:
    """Return what flows along an edge: type and message of the output, and whether it is physical."""
    port = lookup.architecture.outputs[output_id]
    return {"type": port.type, "message": lookup.architecture.message_of(port), "physical": is_physical(port) or None}


def _record_node(lookup: Lookup, node: Node) -> dict[str, object]:
    field_names = (
        "title",
        "description",
        "owner",
        "name",
        "namespace",
        "package",
        "executable",
        "plugin",
        "language",
        "container",
        "host",
        "threads",
        "scheduling",
        "status",
    )
    return drop_unknown(
        {
            **{key: getattr(node, key) for key in field_names},
            "full_name": node.full_name,
            "kind": list(node.kinds),
            "command": list(node.command),
            "arguments": list(node.arguments),
            "remaps": dict(node.remaps),
            "start": record_start(node.start),
            "co_owners": list(node.co_owners),
            "implements": list(node.implements),
            "callback_groups": {name: list(members) for name, members in node.callback_groups.items()},
            "reentrant": node.reentrant or None,
            "derived": None if node.written else True,
            "endpoints": record_endpoints(lookup, node.id),
            # The key is "" for a node that implements no component; the record calls it "node".
            "timing": drop_unknown(
                {component or "node": record_timing(timing) for component, timing in node.timing.items()}
            ),
            "parameters": to_plain(node.parameters),
            "parameter_files": list(node.parameter_files),
            "parameter_commands": {name: list(words) for name, words in node.parameter_commands.items()},
            "effective_parameters": record_effective(lookup.architecture, node),
            "tags": list(node.tags),
            "urls": dict(node.urls),
            **record_annotations(node),
        }
    )
