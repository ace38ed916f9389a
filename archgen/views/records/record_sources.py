"""What the resolved record takes from elsewhere than from the field that is called like the key.

A key that stands in no table here is read off the element, and written as its type says.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Mapping
from fractions import Fraction
from typing import Any

from archgen.frozen import dataclass
from archgen.model.component import Component, Output
from archgen.model.declared_timing import list_fair_figures
from archgen.model.deployment import Host
from archgen.model.element_annotations import read_figure
from archgen.model.known_interfaces import InterfaceField
from archgen.model.message_types import PART_KEYS, ConceptualType, DataField
from archgen.model.node import Endpoint, Evidence, Node
from archgen.model.parameter_values import EffectiveParameter, find_effective_parameters
from archgen.model.port_media import ROS, is_physical, name_on_medium, word_of_medium
from archgen.model.promise import describe_deprecation, format_range
from archgen.model.quantity import Quantity
from archgen.model.step_connections import ConnectedStep
from archgen.views.lookup import Lookup


def drop_unknown(data: dict[str, object]) -> dict[str, object]:
    """Drop what is not known: None, empty lists and empty mappings."""
    # 0, False and "" stay: they are values that somebody wrote. Flags that are rarely true are given as `flag or None`.
    return {key: value for key, value in data.items() if value is not None and value not in ([], {})}


def record_quantity(quantity: Quantity | None, unit: str) -> dict[str, object] | None:
    """Return a quantity as text, number and unit; `value` is in that unit."""
    return None if quantity is None else {"text": quantity.text, "value": _to_number(quantity.value), "unit": unit}


def _to_number(value: Fraction) -> int | float:
    """Return an int where that is exact, else the nearest float (JSON and YAML have no fractions)."""
    return int(value) if value.denominator == 1 else float(value)


def record_property(text: str) -> dict[str, object]:
    """Return a property as text, number and unit, as far as it is such."""
    figure = read_figure(text)
    number = {"value": _to_number(Fraction(figure.value))} if figure else {}
    return {"text": text, **number, **({"unit": figure.unit} if figure and figure.unit else {})}


def to_plain(value: object) -> object:
    """Copy nested parameters into dicts and lists."""
    if isinstance(value, Mapping):
        return {str(key): to_plain(item) for key, item in value.items()}
    return [to_plain(item) for item in value] if isinstance(value, (list, tuple)) else value


_PART_NAMES = {"request": ("request", "goal"), "response": ("response", "result"), "feedback": ("feedback",)}
"""What definitions of services and actions call the parts."""


@dataclass(frozen=True, slots=True)
class RecordedField:
    """A field with what it holds in the project's words (`type`) and in those of ROS (`ros_type`)."""

    name: str
    type: str | None
    default: str | tuple[str, ...] | None
    unit: str | None
    comment: str | None
    ros_type: str | None


def _list_part_fields(conceptual_type: ConceptualType, lookup: Lookup) -> dict[str, list[RecordedField]]:
    """Return the fields of the parts of a service or an action, by part."""
    ros_fields = _find_ros_fields(conceptual_type, lookup)
    return {part: _list_recorded(fields, part, ros_fields) for part, fields in conceptual_type.part_fields.items()}


def _find_ros_fields(conceptual_type: ConceptualType, lookup: Lookup) -> Mapping[tuple[str, str], InterfaceField]:
    """Return the fields of the type's message by part and name."""
    definitions = lookup.architecture.interfaces.definitions
    definition = definitions.get(conceptual_type.message or "") if conceptual_type.has_content else None
    if definition is None:
        return {}
    return {
        (part, field.name): field
        for part, fields in zip(definition.part_names, definition.parts, strict=True)
        for field in fields
    }


def _list_recorded(
    fields: Iterable[DataField], part: str, ros_fields: Mapping[tuple[str, str], InterfaceField]
) -> list[RecordedField]:
    return [_record_field(field, part, ros_fields) for field in fields]


def _record_field(field: DataField, part: str, ros_fields: Mapping[tuple[str, str], InterfaceField]) -> RecordedField:
    names = _PART_NAMES.get(part, ("",))
    ros_field = next((ros_fields[name, field.name] for name in names if (name, field.name) in ros_fields), None)
    ros_type = f"{ros_field.type}{ros_field.array}" if ros_field else None
    return RecordedField(field.name, field.type, field.default, field.unit, field.comment, ros_type)


Source = Callable[[Any, Lookup], object]
"""Gives what stands at a key of an element, before it is written in the form of its type."""


def _list_ids(elements: Iterable[Any]) -> list[str]:
    return [each.id for each in elements]


def _list_behind(shell: Component, lookup: Lookup) -> dict[str, tuple[str, ...]]:
    """Return the leaves' ports behind each port of a composed component."""
    return {
        f"{kind} {port.name}": lookup.architecture.leaf_ports_of(kind, port.id)
        for kind, ports in (("input", shell.inputs), ("output", shell.outputs))
        for port in ports.values()
    }


def _list_port_types(ports: Mapping[str, str | None]) -> dict[str, str]:
    return {name: type_name or "" for name, type_name in ports.items()}


def _list_reasons(endpoint: Endpoint, _lookup: Lookup) -> dict[str, Evidence]:
    """Return where fields come from that are not as the program, or the model of its port, has them."""
    told = {key: each for key, each in endpoint.evidence.items() if each.kind not in {"default", "unknown"}}
    # That a node is planned stands at the node.
    return {
        key: each
        for key, each in told.items()
        if (key != "name" or endpoint.is_moved) and (key != "runs" or endpoint.runs != "planned")
    }


def _list_effective(node: Node, lookup: Lookup) -> dict[str, EffectiveParameter]:
    """Return the values that count at a node, each with where it comes from; nothing where all are the node's own."""
    parameters = find_effective_parameters(lookup.architecture, node)
    return {} if all(each.origin == "node" for each in parameters.values()) else parameters


def _read_host_order(host: Host, _lookup: Lookup) -> object:
    """Return the order; as a mapping where single cores have one of their own, or figures of a fair one are written."""
    orders: dict[object, object] = {}
    orders.update(host.core_scheduling.items())
    if host.fair:
        orders["fair"] = dict(list_fair_figures(host.fair))
    return orders or host.scheduling


def _list_steps(use_case: Any, lookup: Lookup) -> list[ConnectedStep]:  # noqa: ANN401  # as all sources
    """Return the steps of a use case; those with an end that names nothing are left out."""
    return [each for each in lookup.steps.by_use_case.get(use_case.id, ()) if each.step.is_resolved]


def _read_message(port: Output, lookup: Lookup) -> str | None:
    return lookup.architecture.message_of(port)


def _keep_finite(limit: float) -> float | None:
    # JSON has no infinity.
    return limit if math.isfinite(limit) else None


def _list_users(ends: str) -> Source:
    """Return a source of the nodes at the ends of a topic or channel, each once."""
    return lambda carrier, _: list(dict.fromkeys(endpoint.node for endpoint in getattr(carrier, ends)))


def _read_part(part: str) -> Source:
    """Return a source of the fields of a part of a service or an action."""
    return lambda fields, _: fields.get(part)


_COMPONENT: Mapping[str, Source] = {
    "is": lambda component, _: component.component_type,
    "requirements": lambda component, _: [use.text for use in component.requirements],
    "nodes": lambda component, lookup: _list_ids(lookup.nodes_of.get(component.id, ())),
}
_CARRIER: Mapping[str, Source] = {
    "writers": _list_users("writers"),
    "readers": _list_users("readers"),
}
_PORT: Mapping[str, Source] = {"medium": lambda port, _: word_of_medium(port)}
_PARTS: Mapping[str, Mapping[str, Source]] = {
    "project": {
        "middleware": lambda project, _: None if project.middleware == ROS else project.middleware,
        "distro": lambda _, lookup: lookup.architecture.distro,
        # Of one name the last value counts.
        "parameters": lambda _, lookup: {each.name: each.value for each in lookup.architecture.ros_parameters},
        "environment": lambda _, lookup: {each.name: each.value for each in lookup.architecture.ros_environment},
        "discovery": lambda _, lookup: lookup.architecture.ros_discovery,
    },
    "use_case": {
        "actors": lambda use_case, _: {actor.id: actor.title for actor in use_case.actors.values()},
        "steps": _list_steps,
    },
    "step": {
        "from": lambda connected, _: connected.step.source,
        "to": lambda connected, _: connected.step.target,
        "say": lambda connected, _: connected.step.say,
        "outputs": lambda connected, _: list(
            dict.fromkeys(each.output for each in connected.connections if each.output)
        ),
        "inputs": lambda connected, _: list(
            dict.fromkeys(each.input for each in connected.connections if each.input and not each.output)
        ),
    },
    "requirement": {
        "parent": lambda requirement, _: requirement.parents,
        "served_by": lambda each, lookup: _list_ids(lookup.components_for_requirement.get(each.id, ())),
        "served_by_chains": lambda each, lookup: _list_ids(lookup.chains_for_requirement.get(each.id, ())),
    },
    "property_declaration": {"range": lambda each, _: [str(limit) for limit in each.range or ()]},
    "group": {"components": lambda group, lookup: _list_ids(lookup.shown_components(group.id))},
    "component": _COMPONENT,
    "composed": {**_COMPONENT, "components": lambda shell, _: shell.children, "behind": _list_behind},
    "input": {
        **_PORT,
        "sources": lambda port, _: list(
            dict.fromkeys(output for connection in port.connections for output in connection.outputs)
        ),
    },
    "output": {
        **_PORT,
        "message": _read_message,
        "readers": lambda port, lookup: list(
            dict.fromkeys(connection.input for connection in lookup.readers_of.get(port.id, ()))
        ),
    },
    "promise": {"range": lambda promise, _: None if promise.range is None else (promise.range, promise.unit)},
    "value_range": {
        "text": lambda limits_and_unit, _: format_range(*limits_and_unit),
        "least": lambda limits_and_unit, _: _keep_finite(limits_and_unit[0][0]),
        "greatest": lambda limits_and_unit, _: _keep_finite(limits_and_unit[0][1]),
    },
    "deprecation": {
        "text": lambda deprecated, _: describe_deprecation(deprecated),
        "replacement": lambda deprecated, _: deprecated.target,
    },
    "component_type": {
        "is": lambda each, _: each.base,
        "abstract": lambda each, _: each.is_abstract,
        "inputs": lambda each, _: _list_port_types(each.inputs),
        "outputs": lambda each, _: _list_port_types(each.outputs),
    },
    "parameter": {"from": lambda parameter, _: parameter.handed_from},
    "edge": {
        "from": lambda edge, _: edge.output,
        "to": lambda edge, _: edge.input,
        "type": lambda edge, lookup: lookup.architecture.outputs[edge.output].type,
        "message": lambda edge, lookup: _read_message(lookup.architecture.outputs[edge.output], lookup),
        "physical": lambda edge, lookup: is_physical(lookup.architecture.outputs[edge.output]),
    },
    "node": {
        "kind": lambda node, _: node.kinds,
        "derived": lambda node, _: not node.written,
        # Who generates launch files from a node knows nothing but ROS.
        "endpoints": lambda node, lookup: [each for each in lookup.endpoints_of.get(node.id, ()) if each.medium == ROS],
        # The key is "" for a node that implements no component.
        "timing": lambda node, _: {component or "node": timing for component, timing in node.timing.items()},
        "effective_parameters": _list_effective,
    },
    "endpoint": {
        "program_name": lambda endpoint, _: endpoint.program_name if endpoint.is_moved else None,
        "from": _list_reasons,
        "unknown": lambda endpoint, _: [key for key, each in endpoint.evidence.items() if each.kind == "unknown"],
        "qos": lambda endpoint, _: endpoint.qos if endpoint.flow == "topic" else None,
        "clock": lambda endpoint, _: endpoint.clock if endpoint.clock != "system" else None,
        "runs": lambda endpoint, _: endpoint.runs if endpoint.runs != "active" else None,
    },
    "evidence": {
        "by": lambda reason, _: reason.kind,
        "at": lambda reason, _: str(reason.at) if reason.at.line else None,
    },
    "topic": _CARRIER,
    "channel": {**_CARRIER, "name": lambda channel, _: name_on_medium(channel)},
    "start": {
        "after": lambda start, _: _list_ids(start.after),
        "by": lambda start, _: start.by.id if start.by else None,
    },
    "timing": {
        "percentiles": lambda timing, _: timing.measured_times.percentiles if timing.measured_times else None,
        "wcet_measured": lambda timing, _: timing.measured_times and timing.measured_times.is_measured,
        "calls": lambda timing, _: {name: _to_number(count) for name, count in timing.calls.items()},
    },
    "timing_input": {"stored": lambda each, _: "at_once" if each.stored_at_once else None},
    "type": {
        "fields": lambda conceptual_type, lookup: _list_recorded(
            conceptual_type.fields or (), "", _find_ros_fields(conceptual_type, lookup)
        ),
        "part_fields": _list_part_fields,
    },
    "part_fields": {part: _read_part(part) for part in PART_KEYS},
    "host": {"scheduling": _read_host_order},
    "container": {"namespace": lambda container, _: None if container.namespace == "/" else container.namespace},
    "variant": {"changes": lambda variant, _: {change.path: change.value for change in variant.changes}},
}
SOURCES: Mapping[tuple[str, str], Source] = {
    (part, key): source for part, sources in _PARTS.items() for key, source in sources.items()
}
"""By the part of the record and its key."""
