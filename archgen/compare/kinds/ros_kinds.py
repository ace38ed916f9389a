"""What is written for ROS: conceptual types and message definitions (in modules of their own), nodes and their ports."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import TypeVar

from archgen.compare.architecture_version import ArchitectureVersion
from archgen.compare.element_likeness import letter_pairs
from archgen.compare.element_relations import ElementRelations, project_messages
from archgen.compare.kinds.key_readers import is_own_type
from archgen.compare.kinds.key_spec import (
    CO_OWNERS,
    Effect,
    KeySpec,
    ReadContext,
    Worsening,
    find_type_owner,
    read_owner,
)
from archgen.compare.kinds.kind_spec import (
    NAME_FEATURES,
    FeatureSpec,
    KindSpec,
    mark_values,
    reference_feature,
    text_feature,
    value_feature,
)
from archgen.compare.normal_values import unordered_values
from archgen.derivation.port_endpoints import flow_of_use
from archgen.derivation.wire.wire_names import NodeNames
from archgen.diagnostics import NO_SPAN, Span
from archgen.frozen import NamedTuple, fields
from archgen.model.known_interfaces import Interface, InterfaceConstant, InterfaceField
from archgen.model.message_types import ConceptualType
from archgen.model.node import Node, PortUse, Qos
from archgen.model.parameter import format_parameter


def _list_types(version: ArchitectureVersion) -> Mapping[str, ConceptualType]:
    return {
        name: conceptual_type
        for name, conceptual_type in version.architecture.types.items()
        if conceptual_type.origin != "message" or conceptual_type.at.file
    }


def _mark_ports(relations: ElementRelations, conceptual_type: ConceptualType) -> frozenset[str]:
    ports = relations.users_by_element[f"type:{conceptual_type.name}"]
    return relations.common_ids("output", ports) | relations.common_ids("input", ports)


_TYPE = KindSpec(
    "type",
    "Types",
    elements=_list_types,
    features=(
        FeatureSpec("name", 2, lambda _, each: letter_pairs(each.name)),
        FeatureSpec("message", 3, lambda _, each: mark_values(each.message)),
        FeatureSpec("users", 5, _mark_ports),
        text_feature(1, "comment"),
        FeatureSpec("size", 1, lambda _, each: mark_values(each.size)),
        FeatureSpec("inside", 2, lambda _, each: mark_values(each.request, each.response, each.feedback)),
        FeatureSpec(
            "fields",
            3,
            lambda _, each: mark_values(*(f"{field.name} {field.type}" for _, field in each.list_fields())),
        ),
    ),
    owner=find_type_owner,
    is_declared=is_own_type,
)


_Named = TypeVar("_Named", InterfaceField, InterfaceConstant)


class ProjectMessage(NamedTuple):
    """An interface of one of the project's packages; its definition is None if only its name is known.

    `at` is the type that defines it by its fields; the place of a file's definition is not known here.
    """

    name: str
    definition: Interface | None
    at: Span = NO_SPAN


def _list_messages(version: ArchitectureVersion) -> Mapping[str, ProjectMessage]:
    definitions = version.architecture.interfaces.definitions
    type_spans = {each.message: each.at for each in version.architecture.types.values() if each.has_content}
    return {
        name: ProjectMessage(name, definitions.get(name), type_spans.get(name, NO_SPAN))
        for name in project_messages(version.architecture)
    }


def _read_fields(message: ProjectMessage, _context: ReadContext) -> tuple[str, ...]:
    """Return the fields of an interface as ROS writes them, with `---` between the parts of a service or action."""
    lines: list[str] = []
    for part in message.definition.parts if message.definition else ():
        lines += (["---"] if part is not message.definition.parts[0] else []) if message.definition else []
        lines += [f"{field.type}{field.array} {field.name}" for field in part]
    return tuple(lines)


def _read_constants(message: ProjectMessage, _context: ReadContext) -> Mapping[str, str]:
    """Return the values of the constants, by name, with the part of a service or action in front."""
    return {
        name: f"{constant.type} {constant.value}"
        for name, constant in _list_by_name(message.definition, lambda definition: definition.constants)
    }


def _read_defaults(message: ProjectMessage, _context: ReadContext) -> Mapping[str, str]:
    """Return the values that fields have if nobody sets them."""
    fields = _list_by_name(message.definition, lambda definition: definition.parts)
    return {name: field.default for name, field in fields if field.default}


def _read_comments(message: ProjectMessage, _context: ReadContext) -> Mapping[str, str]:
    """Return what is said about fields and constants: often the unit, the frame, the direction of an axis."""
    fields = _list_by_name(message.definition, lambda definition: definition.parts)
    constants = _list_by_name(message.definition, lambda definition: definition.constants)
    comments = [(name, field.comment) for name, field in fields]
    comments += [(name, constant.comment) for name, constant in constants]
    return {name: comment for name, comment in comments if comment}


def _list_by_name(
    definition: Interface | None, list_parts: Callable[[Interface], tuple[tuple[_Named, ...], ...]]
) -> Iterator[tuple[str, _Named]]:
    """Yield what is in the parts of a definition, with its name: `width`, `request.width`."""
    if definition is None:
        return
    for part_name, part in zip(definition.part_names, list_parts(definition), strict=False):
        for each in part:
            yield f"{part_name}.{each.name}" if part_name else each.name, each


def _mark_fields(_relations: ElementRelations, message: ProjectMessage) -> frozenset[str]:
    parts = message.definition.parts if message.definition else ()
    return mark_values(*(f"{field.name} {field.type}" for part in parts for field in part))


def _mark_types(relations: ElementRelations, message: ProjectMessage) -> frozenset[str]:
    types = relations.architecture.types.values()
    return relations.common_ids("type", [each.name for each in types if each.message == message.name])


_MESSAGE = KindSpec(
    "message",
    "Message definitions",
    (
        KeySpec("fields", _read_fields, worsening=Worsening.ALWAYS),
        KeySpec("constants.", _read_constants, Effect.SYSTEM),
        KeySpec("defaults.", _read_defaults, Effect.SYSTEM),
        KeySpec("comments.", _read_comments, Effect.SYSTEM),
        KeySpec("comment", lambda each, _: (each.definition and each.definition.comment) or None, is_prose=True),
    ),
    elements=_list_messages,
    features=(
        FeatureSpec("name", 2, lambda _, message: letter_pairs(message.name.rpartition("/")[2])),
        FeatureSpec("package", 1, lambda _, message: mark_values(message.name.rpartition("/")[0])),
        FeatureSpec("fields", 5, _mark_fields),
        FeatureSpec("users", 4, _mark_types),
    ),
    whole_word="message definition",
)


_DEFAULT_QOS = Qos()
_QOS_NAMES = tuple(each.name for each in fields(Qos) if each.name not in {"profile", "written", "at"})
"""What counts of `qos`: a profile is only another way of writing the rest."""


def _read_co_owners(node: Node, context: ReadContext) -> frozenset[str]:
    """Return a node's further owners, unless they are exactly those of its components."""
    components = context.architecture.components
    inherited_owners = {owner for component in node.implements for owner in components[component].owners}
    return context.common_ids("partner", () if set(node.owners) == inherited_owners else node.co_owners)


def _find_surroundings(node: Node, context: ReadContext) -> object:
    # A node is declared anew where its components or the host of its container are others.
    return context.architecture.distro, [name in context.told_components for name in node.implements]


NODE = KindSpec(
    "node",
    "Nodes",
    (KeySpec("co_owners", _read_co_owners, Effect.SYSTEM, refers_to="partner", noun=CO_OWNERS.noun),),
    # Of a node that is planned since its component says where it will run, that is written: it has a place in the files.
    elements=lambda version: {
        name: node for name, node in version.architecture.nodes.items() if node.written or node.at != NO_SPAN
    },
    features=(
        *NAME_FEATURES,
        reference_feature("implements", 4, "component", "implements"),
        value_feature("package", 2, "package"),
        value_feature("program", 2, "executable", "plugin"),
        FeatureSpec("ports", 2, lambda _, node: mark_values(*(f"{use.use} {use.key}" for use in node.uses))),
        FeatureSpec("topics", 1, lambda _, node: mark_values(*(topic for use in node.uses for topic in use.topics))),
        value_feature("place", 1, "host", "container"),
        FeatureSpec("parameters", 1, lambda _, node: frozenset(node.parameters)),
        text_feature(1, "description"),
    ),
    owner=read_owner,
    components=lambda node, context: tuple(
        context.matched_ids.common_id("component", component) for component in node.implements
    ),
    surroundings=_find_surroundings,
)


class NodePort(NamedTuple):
    """What a node says of a port; `is_stated` if it must say that it has the port, because it is not the only node of
    the component.
    """

    use: PortUse
    node: Node
    is_stated: bool


def _read_qos(port: NodePort, _context: ReadContext) -> Mapping[str, object]:
    qos = port.use.qos or _DEFAULT_QOS
    return {name: getattr(qos, name) for name in _QOS_NAMES if getattr(qos, name) != default_qos(name)}


def default_qos(name: str) -> object:
    """Return the value of a key of `qos` that nobody wrote."""
    return getattr(_DEFAULT_QOS, name)


def _resolve_topics(port: NodePort, context: ReadContext) -> frozenset[str]:
    """Return the names on the wire: a remap is told as it is written, and here as what comes of it."""
    if not port.use.topics:
        return frozenset()
    names = NodeNames(port.node, context.architecture.distro)
    flow = flow_of_use(port.use.message, port.use)
    wires = zip(names.name_use(port.use, flow, None), port.use.topics, strict=True)
    return unordered_values(wire.name or topic for wire, topic in wires)


PORT = KindSpec(
    "port",
    "Nodes",
    (
        KeySpec("carried", lambda port, _: port.is_stated or None),
        KeySpec("topic", _resolve_topics),
        KeySpec("own_name", lambda port, _: port.use.own_name, Effect.SYSTEM, noun="name in the program"),
        KeySpec("named_by", lambda port, _: port.use.named_by, Effect.SYSTEM, noun="parameter with its name"),
        KeySpec(
            "when.",
            lambda port, _: {name: format_parameter(wanted) or "no value" for name, wanted in port.use.when.items()},
            Effect.SYSTEM,
            noun="condition",
        ),
        KeySpec("message", lambda port, _: port.use.message, worsening=Worsening.ALWAYS, verb="is"),
        KeySpec("qos.", _read_qos, worsening=Worsening.ALWAYS, noun="QoS"),
    ),
    has_path_id=True,
)
ROS_KINDS: Sequence[KindSpec] = (_TYPE, _MESSAGE, NODE, PORT)
