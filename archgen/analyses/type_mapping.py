"""Is every conceptual type that is used mapped to a message, and every declared one used?"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from collections.abc import Set as AbstractSet

from archgen.diagnostics import NO_SPAN, Diagnostic, Label, Severity, Span, did_you_mean
from archgen.model.architecture import Architecture
from archgen.model.component import Input, Output
from archgen.model.generic_names import read_generic_name
from archgen.model.message_types import ConceptualType, flow_of
from archgen.model.port_media import uses_ros


def _all_ports(architecture: Architecture) -> tuple[Output | Input, ...]:
    """Return all ports, outputs first: a finding is placed at an output that has the type if there is one."""
    return (*architecture.outputs.values(), *architecture.inputs.values())


def _spans_by_type(architecture: Architecture) -> dict[str, list[Span]]:
    """Return the spans where digital ports name each type, by type name."""
    spans_by_type = dict[str, list[Span]]()
    for port in _all_ports(architecture):
        if port.type is not None and uses_ros(port):
            spans_by_type.setdefault(port.type, []).append(port.type_at if port.type_at != NO_SPAN else port.at)
    # What a field holds is sent, too; of what travels over ROS nowhere, no message is asked.
    other_types = {port.type for port in _all_ports(architecture) if not uses_ros(port)}.difference(spans_by_type)
    for type_ in architecture.types.values():
        if type_.name in other_types:
            continue
        for _, field in type_.list_fields():
            is_parameter = field.element_type in type_.generic
            if type_.at != NO_SPAN and not is_parameter and field.element_type in architecture.types:
                spans_by_type.setdefault(field.element_type, []).append(field.type_at)
    return spans_by_type


def unmapped_type(architecture: Architecture) -> Iterator[Diagnostic]:
    """No message is named for a conceptual type that carries messages."""
    mapped_names = {type_.name for type_ in architecture.types.values() if type_.message and type_.origin != "message"}
    mapped_names |= set(architecture.interfaces.mapper_names)
    for name, spans in _spans_by_type(architecture).items():
        type_ = architecture.types.get(name)
        # Why a type with fields has no message, or one that is not bound, is reported with the type.
        if type_ is None or (type_.message is None and not type_.has_content and not type_.generic):
            meant_message = architecture.interfaces.read_message(name)
            yield Diagnostic(
                "unmapped-type",
                f"no message is named for the type `{name}`",
                spans[0],
                # What is written as a message and is none is no type that waits to be mapped.
                severity=Severity.ERROR if meant_message else None,
                labels=tuple(_label_elsewhere(type_, spans[1:])),
                help=f"did you mean `{meant_message}`?" if meant_message else _suggest_mapping(name, mapped_names),
                element=name,
            )


def _label_elsewhere(type_: ConceptualType | None, spans: list[Span]) -> Iterator[Label]:
    if type_ is not None and type_.at != NO_SPAN and type_.origin == "project":
        yield Label(type_.at, "declared here, without a message")
    yield from (Label(span, "also used here") for span in spans)


def _suggest_mapping(type_name: str, mapped_names: AbstractSet[str]) -> str:
    guess = did_you_mean(type_name, mapped_names)
    return guess or f"name it below `types:`, as in `{type_name}: {{message: package/msg/Name}}`"


def borrowed_call(architecture: Architecture) -> Iterator[Diagnostic]:
    """That a type is a service or an action is said by the mapper that ships with archgen alone."""
    for name, spans in _spans_by_type(architecture).items():
        type_ = architecture.types.get(name)
        if type_ is None or type_.origin != "shipped" or flow_of(type_.message) == "topic":
            continue
        # Who reads a topic is given something; who reads a service or an action calls it, which turns the arrow round.
        yield Diagnostic(
            "borrowed-call",
            f"the type `{name}` is taken to be the {flow_of(type_.message)} `{type_.message}`, and who reads it to call it: "
            "the mapper that ships with archgen says so",
            spans[0],
            labels=tuple(Label(span, "also used here") for span in spans[1:]),
            help=f"say so below `types:`, or what it is: `{name}: {{message: {type_.message}}}`",
            element=name,
        )


def borrowed_message(architecture: Architecture) -> Iterator[Diagnostic]:
    """What message a type is, is said by the mapper that ships with archgen alone: one note for all such types."""
    borrowed_types = {
        name: (type_.message, spans[0])
        for name, spans in _spans_by_type(architecture).items()
        if (type_ := architecture.types.get(name)) is not None
        and (type_.origin == "shipped" and type_.message and flow_of(type_.message) == "topic")
    }
    if not borrowed_types:
        return
    names = sorted(borrowed_types)
    meanings = ", ".join(f"`{name}` is `{borrowed_types[name][0]}`" for name in names)
    yield Diagnostic(
        "borrowed-message",
        f"the mapper that ships with archgen alone says what {'these types are' if names[1:] else 'this type is'}: {meanings}",
        min((span for _, span in borrowed_types.values()), key=lambda span: (span.file, span.line, span.column)),
        help=f"what is not meant so stands below `types:`, as in `{names[0]}: {{message: package/msg/Name}}`",
    )


def unused_type(architecture: Architecture) -> Iterator[Diagnostic]:
    """Nothing has a type that the project declares."""
    if architecture.partial:
        return
    # Physical ports count here: their types need no message, but they use the type.
    used_types = {port.type for port in _all_ports(architecture)}
    for component in architecture.components.values():
        used_types.update(name for operation in component.operations.values() for name in operation.type_names)
    # A library that is checked by itself has no instances.
    for component_type in architecture.component_types.values():
        named_types = {*component_type.inputs.values(), *component_type.outputs.values(), *component_type.inner_types}
        named_types.update(name for operation in component_type.operations.values() for name in operation.type_names)
        used_types |= named_types.difference(component_type.generic)
    for type_ in architecture.types.values():
        # What replaces a type that is going away waits for those who still use that one.
        used_types |= {type_.request, type_.response, type_.feedback}
        used_types |= {type_.deprecated.target} if type_.deprecated else set()
        used_types |= {field.element_type for _, field in type_.list_fields()}.difference(type_.generic)
    used_types |= set(_list_arguments(used_types))
    used_messages = _list_used_messages(architecture)
    # An unused mapping beside a used type without one is most likely a misspelt name.
    unmapped_names = {name for name in used_types if name and not _is_mapped(architecture, name)}
    for type_ in architecture.types.values():
        is_definition = type_.has_content and type_.message in used_messages
        if type_.origin == "project" and type_.at != NO_SPAN and type_.name not in used_types and not is_definition:
            yield Diagnostic(
                "unused-type",
                f"nothing has the type `{type_.name}`",
                type_.at,
                help=did_you_mean(type_.name, unmapped_names),
                element=type_.name,
            )


def _list_arguments(names: Iterable[str | None]) -> Iterator[str]:
    """Yield what names of generic types name: `List`, `Pair<A, B>`, `Pair`, `A` and `B` for `List<Pair<A, B>>`."""
    pending_names = [name for name in names if name]
    while pending_names:
        base, arguments = read_generic_name(pending_names.pop())
        if arguments:
            yield from (base, *arguments)
            pending_names += arguments


def _list_used_messages(architecture: Architecture) -> frozenset[str]:
    """Return the messages that ports, nodes and fields name by themselves: a type with fields may define one of them."""
    interfaces = architecture.interfaces
    packages = interfaces.project_packages
    project_names = [name for name in interfaces.names if name.partition("/")[0] in packages] if packages else []
    definitions = filter(None, map(interfaces.definitions.get, project_names))
    return frozenset(
        {
            *(type_.message for type_ in architecture.types.values() if type_.message and type_.origin == "message"),
            *(use.message for node in architecture.nodes.values() for use in node.uses if use.message),
            *(field.type for definition in definitions for part in definition.parts for field in part),
        }
    )


def _is_mapped(architecture: Architecture, name: str) -> bool:
    type_ = architecture.types.get(name)
    return type_ is not None and type_.message is not None


RULES = (
    (unmapped_type, Severity.WARNING),
    (borrowed_call, Severity.WARNING),
    (borrowed_message, Severity.NOTE),
    (unused_type, Severity.NOTE),
)
