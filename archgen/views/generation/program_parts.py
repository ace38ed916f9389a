"""What a program has: the parameters that it declares, and what it publishes, subscribes to, serves and calls."""

from __future__ import annotations

import math
from collections.abc import Collection, Iterable, Mapping, Sequence
from typing import Any

from archgen.analyses.topic_sources import find_endpoint_span
from archgen.bringup.program_names import ProgramPorts, find_common_message, name_program
from archgen.bringup.start_commands import has_substitution
from archgen.diagnostics import Diagnostic
from archgen.model.architecture import Architecture
from archgen.model.code_names import PYTHON_KEYWORDS
from archgen.model.component import ComponentType
from archgen.model.message_types import ConceptualType, full_message_name
from archgen.model.node import Endpoint, Node, Qos
from archgen.model.parameter import Parameter
from archgen.model.parameter_values import EffectiveParameter, find_effective_parameters, is_ros_parameter
from archgen.model.quantity import Quantity
from archgen.model.ros_distro import is_ros_1
from archgen.views.generation.generation_context import tell_left_out, write_place

PORT_SECTIONS: Mapping[tuple[str, str], str] = {
    ("publishes", "topic"): "publishers",
    ("subscribes", "topic"): "subscriptions",
    ("serves", "service"): "services",
    ("calls", "service"): "clients",
    ("serves", "action"): "action_servers",
    ("calls", "action"): "action_clients",
}
"""The lists that a program has, by what it does and with what."""


def record_ports(
    architecture: Architecture, nodes: Sequence[Node], ports: ProgramPorts, refused_messages: Collection[str] = ()
) -> tuple[dict[str, list[dict[str, object]]], list[Diagnostic]]:
    """Return what the nodes of one program use, by section, and what is left out; of a refused message somebody else tells.

    Nodes of one program use the same ports; the program has a name of its own for each, which each node remaps.
    """
    sections: dict[str, list[dict[str, object]]] = {name: [] for name in PORT_SECTIONS.values()}
    findings: list[Diagnostic] = []
    groups, own_names = ports
    shared_name = name_shared_program(architecture, nodes)
    # By their names: a line that moves in the YAML moves nothing in the code.
    for (use, flow, key), port_endpoints in sorted(groups.items()):
        message = find_common_message(port_endpoints)
        if message in refused_messages:
            continue  # its name stays taken: scripts call the other ports as they are called beside it
        if message is None:
            findings.append(
                _tell_unknown_message(architecture, port_endpoints[0], {each.message for each in port_endpoints})
            )
            continue
        if message.rpartition("/")[2] in PYTHON_KEYWORDS:
            findings.append(_tell_bad_message(architecture, port_endpoints[0]))
            continue
        record = _record_port(architecture, key, own_names[use, flow, key], port_endpoints, shared_name)
        record["meaning"] = _write_meaning(architecture, port_endpoints[0], record, is_shared=len(nodes) > 1)
        sections[PORT_SECTIONS[use, flow]].append(record)
    return sections, findings


def _tell_unknown_message(architecture: Architecture, endpoint: Endpoint, messages: set[str | None]) -> Diagnostic:
    named = f"`{endpoint.port or endpoint.label}` of the node `{endpoint.node}`"
    if len(messages) > 1:
        shown = " and ".join(sorted(f"`{each}`" for each in messages if each))
        return tell_left_out(
            f"{named} is left out: nodes of one program use it with several messages, {shown or 'one of them unknown'}",
            find_endpoint_span(architecture, endpoint),
            element=endpoint.node,
            help_line="give one of the nodes an `executable` of its own",
        )
    return tell_left_out(
        f"{named} is left out: nobody says which message it has",
        find_endpoint_span(architecture, endpoint),
        element=endpoint.node,
        help_line="map its type to a message below `types`, or give the type `fields`",
    )


def _tell_bad_message(architecture: Architecture, endpoint: Endpoint) -> Diagnostic:
    return tell_left_out(
        f"`{endpoint.port or endpoint.label}` of the node `{endpoint.node}` is left out: no class can be called as its "
        f"message `{endpoint.message}`",
        find_endpoint_span(architecture, endpoint),
        element=endpoint.node,
        help_line="give its type another name, or another `message`",
    )


def _record_port(
    architecture: Architecture, key: str, own_name: str, endpoints: Sequence[Endpoint], shared_name: str
) -> dict[str, object]:
    first = endpoints[0]
    package, kind, name = (first.message or "//").split("/")
    port = architecture.outputs.get(first.port or "") or architecture.inputs.get(first.port or "")
    if first.use in {"subscribes", "calls"}:
        port = architecture.inputs.get(first.port or "") or port
    data_type = architecture.types.get(first.type or "")
    return {
        "key": key,
        "topic": own_name,
        "topics": {each.node: each.name or "" for each in endpoints},
        "port": first.port or "",
        "internal": first.internal,
        "message": first.message,
        "package": package,
        "kind": kind,
        "name": name,
        "type": first.type or "",
        "description": (port.description if port else None) or (data_type.comment if data_type else None) or "",
        "sources": list(first.sources),
        "size_bytes": None if data_type is None else _round_quantity(data_type.size),
        "envelope": record_envelope(architecture, endpoints),
        "qos": record_qos(first.qos),
        "place": f"{shared_name}.{port.id.rpartition('.')[2]}"
        if shared_name and port
        else write_place(port.at if port else first.at),
    }


def _write_meaning(architecture: Architecture, first: Endpoint, record: Mapping[str, Any], *, is_shared: bool) -> str:
    """Return what a port's name in code stands for: `base.guard.arms<arms.left.state:sensor_msgs/msg/JointState`.

    A program that instances share has what their type says: each of them hears another one.
    """
    envelope = record["envelope"]
    message = envelope["payload"] if envelope else first.message or ""
    component = architecture.components.get(first.component or "")
    element = first.port or first.label
    if is_shared and component and component.component_type and first.port:
        element = f"{component.component_type}.{first.port.rpartition('.')[2]}"
    source = "<" + ",".join(first.sources) if first.sources and not is_shared else ""
    return f"{element}{source}:{message}".replace(" ", "_")


def record_qos(qos: Qos) -> dict[str, object]:
    """Return the settings of a topic as plain data: durations in ns, None where the middleware chooses."""
    return {
        "reliability": qos.reliability,
        "durability": qos.durability,
        "history": qos.history,
        "depth": qos.depth,
        "deadline_ns": _round_quantity(qos.deadline),
        "lifespan_ns": _round_quantity(qos.lifespan),
        "liveliness": qos.liveliness,
        "lease_duration_ns": _round_quantity(qos.lease_duration),
    }


def _round_quantity(quantity: Quantity | None) -> int | None:
    return None if quantity is None else round(quantity.value)


ANYBODY = "*"
"""Who may send where the architecture names nobody."""
_FIELDS = {"sender", "payload"}


def record_envelope(architecture: Architecture, endpoints: Sequence[Endpoint]) -> dict[str, object] | None:
    """Return what a port of a program knows of the envelopes of its messages; None where they are none.

    `payload` says what is in one, `senders` the full names of the nodes to listen to, by the full name of each node of the
    program that reads.
    """
    first = endpoints[0]
    data_type = architecture.types.get(first.type or "")
    if first.flow != "topic" or data_type is None or not is_envelope(data_type):
        return None
    payload_type = next(each.type or "" for each in data_type.fields or () if each.name == "payload")
    payload = architecture.types.get(payload_type)
    message = (payload.message if payload else None) or full_message_name(payload_type)
    senders = {}
    for endpoint in endpoints:
        if endpoint.use == "subscribes":
            senders[architecture.nodes[endpoint.node].full_name] = _list_senders(architecture, endpoint)
    # The longest name last: it counts where a node's name ends with several.
    return {"payload": message or payload_type, "senders": dict(sorted(senders.items(), key=lambda each: len(each[0])))}


def is_envelope(data_type: ConceptualType) -> bool:
    """Whether messages of a type carry their sender: it has the fields `sender`, a text, and `payload`, and no others."""
    fields = {each.name: each.type for each in data_type.fields or ()}
    return fields.keys() == _FIELDS and fields["sender"] == "string"


def _list_senders(architecture: Architecture, endpoint: Endpoint) -> list[str]:
    topic = architecture.topics.get(endpoint.label)
    writers = topic.writers if topic else ()
    nodes = [architecture.nodes[each.node].full_name for each in writers if each.port in endpoint.sources]
    return sorted(set(nodes)) or [ANYBODY]


_ROS_TYPES: Mapping[str, str] = {"boolean": "bool", "integer": "integer", "float": "double", "string": "string"}
_INTEGERS = range(-(2**63), 2**63)
"""What a whole number may be in ROS."""


def record_parameters(
    architecture: Architecture, nodes: Sequence[Node]
) -> tuple[list[dict[str, object]], list[Diagnostic]]:
    """Return the parameters of the nodes of one program, and what is left out.

    `default` is the value where all nodes have the same; None where each node is given its own, one is filled in at its
    start, or nobody gives one.
    `is_given` says whether all nodes are given one, and `first_value` which the first is.
    """
    ros_1 = is_ros_1(architecture.distro)
    component_type = find_program_type(architecture, nodes)
    shared_name = name_shared_program(architecture, nodes)
    values: dict[str, list[EffectiveParameter]] = {}
    for node in nodes:
        for name, parameter in find_effective_parameters(architecture, node).items():
            if not is_ros_parameter(name, ros_1=ros_1):
                values.setdefault(name, []).append(parameter)
    records: list[dict[str, object]] = []
    findings: list[Diagnostic] = []
    for name, parameters in sorted(values.items()):
        ros_type = _find_ros_type(parameters)
        if ros_1 and any(_is_too_big(each.value) for each in parameters):
            ros_type = None
        first = parameters[0]
        if ros_type is None or not all(_fits_type(each.value, ros_type) for each in parameters if each.is_known):
            findings.append(
                tell_left_out(
                    f"the parameter `{name}` of `{nodes[0].id}` is left out: no parameter of ROS can be what it is",
                    first.declaration.at if first.declaration else first.at,
                    element=nodes[0].id,
                    help_line="ROS has booleans, whole numbers, numbers, texts, and lists of one of these",
                )
            )
            continue
        record = _record_parameter(name, ros_type, parameters, is_common=len(parameters) == len(nodes))
        declared = component_type.parameters.get(name) if component_type else None
        if declared:
            # What instances are set to is told to each of them, so that a further one changes no program.
            record["default"] = None if declared.value is None else convert_ros_value(declared.value, ros_type)
            record["place"] = write_place(declared.at)
        elif shared_name:
            record["place"] = f"{shared_name}.{name}"
        if has_substitution(record["default"]):
            # Who starts the node fills it in; a program started by hand would take the words for the value.
            record["default"] = None
        records.append(record)
    return records, findings


def name_shared_program(architecture: Architecture, nodes: Sequence[Node]) -> str:
    """Return what nodes of one program are instead of each of them: their component type, else, of several, the program."""
    if find_program_type(architecture, nodes):
        return architecture.components[nodes[0].implements[0]].component_type or ""
    return name_program(architecture, nodes[0]) if len(nodes) > 1 else ""


def find_program_type(architecture: Architecture, nodes: Sequence[Node]) -> ComponentType | None:
    """Return the component type that a program is: that of the one component of each of its nodes."""
    components = [architecture.components[each] for node in nodes for each in node.implements]
    first = components[0].component_type if components else None
    is_one = len(components) == len(nodes) and all(each.component_type == first for each in components)
    return architecture.component_types.get(components[0].type_name) if first and is_one else None


def list_node_values(architecture: Architecture, node: Node) -> list[dict[str, object]]:
    """Return the values of a node that are known, as a parameter file has them: `name` and `value`."""
    listed: list[dict[str, object]] = []
    ros_1 = is_ros_1(architecture.distro)
    for name, parameter in sorted(find_effective_parameters(architecture, node).items()):
        ros_type = _find_ros_type((parameter,))
        if ros_type is None or not parameter.is_known or (ros_1 and _is_too_big(parameter.value)):
            continue
        if _fits_type(parameter.value, ros_type):
            listed.append({"name": name, "value": convert_ros_value(parameter.value, ros_type)})
    return listed


def _is_too_big(value: object) -> bool:
    """Whether ROS 1 cannot hold a whole number: its master speaks XML-RPC, which knows 32 bits."""
    if isinstance(value, list | tuple):
        return any(_is_too_big(each) for each in value)
    return isinstance(value, int) and not -(2**31) <= value < 2**31


def _record_parameter(
    name: str, ros_type: str, parameters: Sequence[EffectiveParameter], *, is_common: bool
) -> dict[str, object]:
    declaration = parameters[0].declaration or Parameter(name)
    defaults = [convert_ros_value(each.value, ros_type) if each.is_known else None for each in parameters]
    is_same = is_common and all(each == defaults[0] for each in defaults)
    limits = [convert_ros_value(each, ros_type) for each in declaration.range or ()]
    has_limits = ros_type in {"integer", "double"} and len(limits) == 2  # noqa: PLR2004 - the lowest and the highest
    has_limits = has_limits and all(_fits_type(each, ros_type) for each in limits)
    return {
        "name": name,
        "type": ros_type,
        "default": defaults[0] if is_same else None,
        "first_value": defaults[0],
        "is_given": is_common and None not in defaults,
        "unit": declaration.unit or "",
        "description": declaration.description or "",
        "lowest": limits[0] if has_limits else None,
        "highest": limits[1] if has_limits else None,
        "choices": [convert_ros_value(each, ros_type.removesuffix("_array")) for each in declaration.choices or ()],
        "read_only": declaration.read_only,
        "place": write_place(declaration.at if parameters[0].declaration else parameters[0].at),
    }


def _find_ros_type(parameters: Iterable[EffectiveParameter]) -> str | None:
    """Return the type in ROS: the declared one, else that of the values; None for what no parameter of ROS can be."""
    found_types = set[str]()
    for parameter in parameters:
        written = parameter.declaration.type if parameter.declaration else None
        if written:
            base_type = _ROS_TYPES.get(written.removesuffix("[]"))
            return None if base_type is None else f"{base_type}_array" if written.endswith("[]") else base_type
        choices = (parameter.declaration.choices if parameter.declaration else None) or ()
        values = [parameter.value] if parameter.is_known else []
        # The choices of a list are those of its items.
        is_list = any(isinstance(each, list | tuple) for each in values)
        found_types.update(infer_ros_type([each] if is_list else each) for each in choices)
        found_types.update(infer_ros_type(each) for each in values)
    if found_types == {"integer", "double"}:
        return "double"
    if found_types == {"integer_array", "double_array"}:
        return "double_array"
    # A parameter that nobody ever gave a value is text in most programs that read it; its node says so otherwise.
    if not found_types:
        return "string"
    return (min(found_types) or None) if len(found_types) == 1 else None


def infer_ros_type(value: object) -> str:
    """Return the type of a value in ROS; empty for what is none."""
    if isinstance(value, list | tuple):
        item_types = {infer_ros_type(each) for each in value} or {"string"}
        if item_types == {"integer", "double"}:
            return "double_array"
        item_type = min(item_types)
        return f"{item_type}_array" if len(item_types) == 1 and item_type in _ROS_TYPES.values() else ""
    # A boolean is an integer in Python, but not in ROS.
    python_types = {bool: "bool", int: "integer", float: "double", str: "string"}
    if isinstance(value, int) and value not in _INTEGERS:
        return ""
    return python_types.get(type(value), "")


def _fits_type(value: object, ros_type: str) -> bool:
    """Whether a value can be given to a parameter of a type; an empty list fits all lists."""
    if isinstance(value, list | tuple) and not value:
        return ros_type.endswith("_array")
    return infer_ros_type(convert_ros_value(value, ros_type)) == ros_type


def convert_ros_value(value: object, ros_type: str) -> object:
    """Return a value as ROS wants it: a whole number is a float where the parameter is one."""
    if isinstance(value, list | tuple):
        return [convert_ros_value(each, ros_type.removesuffix("_array")) for each in value]
    if isinstance(value, int | float) and not isinstance(value, bool):
        if ros_type == "double":
            return float(value)
        if ros_type == "integer" and math.isfinite(value):
            return int(value)
    return value
