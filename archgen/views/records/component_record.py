"""Components in the resolved record: with their ports, with what stands in composed ones, and their types."""

from __future__ import annotations

from archgen.model.component import Component, ComponentType, Input, Output
from archgen.model.port_media import word_of_medium
from archgen.views.lookup import Lookup
from archgen.views.records.frame_record import record_frame
from archgen.views.records.parameter_record import record_operation, record_parameter
from archgen.views.records.promise_record import record_life, record_words
from archgen.views.records.record_values import drop_unknown, pick_fields, record_annotations, record_quantity
from archgen.views.records.timing_record import record_timing


def record_composition(lookup: Lookup) -> dict[str, object]:
    """Return composed components and component types, empty in a project without any."""
    architecture, is_shown = lookup.architecture, lookup.scope.shows_component
    shells = {
        shell.id: record_component(lookup, shell)
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
        "frames": {frame.id: record_frame(frame) for frame in component_type.frames},
    }
    own_fields = pick_fields(
        component_type, "title", "owner", "functionality", "description", "status", "contact", "image"
    )
    return own_fields | drop_unknown(dict(fields)) | record_annotations(component_type)


def record_component(lookup: Lookup, component: Component) -> dict[str, object]:
    """Return what is known of a component, with its ports, its nodes and its timing."""
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
