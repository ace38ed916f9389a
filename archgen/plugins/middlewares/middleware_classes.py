"""The classes of components for a middleware: rule R1. One for all instances of a component type, with what any of them has.

What can be called at a component: rule R3. A `get` that is waited for is a method, a `set` that is not a command.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, field
from typing import Any

from archgen.plugin.findings import Diagnostic, Span, first_written_span
from archgen.plugin.generating import GenerationContext, find_type_words, list_name_words, tell_left_out, write_place
from archgen.plugin.model import DIGITAL, Architecture, Component, Input, Operation, Output, word_of_medium
from archgen.plugins.middlewares.middleware_names import (
    drop_clashes,
    name_component_class,
    name_component_files,
    name_inside,
    name_member,
    name_port_member,
    shorten_wire_name,
)
from archgen.plugins.middlewares.middleware_types import MiddlewareTypes


@dataclass
class ComponentClass:
    """A class, with the components that are its instances and the ports that any of them has, by name."""

    words: str
    components: list[Component] = field(default_factory=list)
    inputs: dict[str, Input] = field(default_factory=dict)
    outputs: dict[str, Output] = field(default_factory=dict)
    record: dict[str, Any] = field(default_factory=dict)

    @property
    def first(self) -> Component:
        """The instance that is written first."""
        return self.components[0]


def collect_component_classes(context: GenerationContext) -> dict[str, ComponentClass]:
    """Return the class of each component that holds no others, by its complete id.

    What has nothing that software has, and no node that somebody wrote, is none: a device.
    """
    architecture = context.architecture
    by_words: dict[str, ComponentClass] = {}
    classes: dict[str, ComponentClass] = {}
    media = {DIGITAL, architecture.project.middleware}
    for component in architecture.components.values():
        node = context.nodes_by_component.get(component.id)
        is_digital = any(word_of_medium(port) in media for port in component.ports)
        if not (
            is_digital or component.operations or component.parameters or component.timing or (node and node.written)
        ):
            continue
        words = find_type_words(architecture, component)
        if words is None:
            words = component.id.replace(".", " ")
        if component.id in architecture.shells:
            # What nothing inside of a composed component carries yet.
            words = f"{words} rest"
        own = classes[component.id] = by_words.setdefault(words, ComponentClass(words))
        own.components.append(component)
        for reader in component.inputs.values():
            if word_of_medium(reader) in media:
                own.inputs.setdefault(reader.name, reader)
        for output in component.outputs.values():
            if word_of_medium(output) in media:
                own.outputs.setdefault(output.name, output)
    return classes


def list_classes(classes: Mapping[str, ComponentClass]) -> list[ComponentClass]:
    """Return the classes, each once."""
    return list({id(each): each for each in classes.values()}.values())


def name_classes(architecture: Architecture, classes: Iterable[ComponentClass]) -> tuple[set[str], list[Diagnostic]]:
    """Begin the records of classes; return the first instances of those whose names fall together, and what is said of them."""
    listed = list(classes)
    for own in listed:
        first = own.first
        component_type = architecture.component_types.get(first.type_name)
        is_shared = len(own.components) > 1 or first.component_type is not None
        own.record.update(
            {
                "name": name_component_class(own.words),
                "module": name_component_files(own.words),
                "title": first.component_type or own.words if is_shared else first.title,
                "description": first.description or first.functionality or "",
                "type": first.component_type or "",
                "place": write_place(first_written_span(component_type.at, first.at) if component_type else first.at),
                "instances": [each.id for each in own.components],
            }
        )
    return drop_clashes([(each.record["name"], each.first.id, each.first.at) for each in listed], "class")


def record_outputs(architecture: Architecture, types: MiddlewareTypes, own: ComponentClass) -> list[Diagnostic]:
    """Add what a class sends (rule R2) and what can be called at it (rule R3) to its record; return what is left out."""
    sent = {name: port for name, port in own.outputs.items() if architecture.flow_of(port) == "topic"}
    served = {name: port for name, port in own.outputs.items() if name not in sent}
    operations = record_operations(types, own.words, own.components)
    operations += [record_served(architecture, types, port) for port in served.values()]
    names = [(name_port_member(port.name), port.id, port.at) for port in sent.values()]
    names += [(each["name"], each["element"], each["span"]) for each in operations]
    clashing, findings = drop_clashes(names, "name")
    own.record["outputs"] = []
    for port in sent.values():
        if port.id not in clashing:
            port_type = types.find_port_type(port.type, port.annotations.hints, port.at)
            findings += _drop_mute_interface(port_type, port, is_sent=True)
            own.record["outputs"].append({**_record_port(port, name_port_member(port.name)), "type": port_type})
    kept = [each for each in operations if each.pop("element") not in clashing]
    for each in operations:
        del each["span"]
    own.record["methods"] = [each for each in kept if not each["is_command"]]
    own.record["commands"] = [each for each in kept if each["is_command"]]
    own.record["operations"] = kept
    return findings


def record_inputs(
    architecture: Architecture, types: MiddlewareTypes, own: ComponentClass, classes: Mapping[str, ComponentClass]
) -> list[Diagnostic]:
    """Add what a class reads (rule R2) and whom it calls to its record; return what is left out."""
    findings: list[Diagnostic] = []
    taken = {each["name"].casefold() for each in own.record["outputs"] + own.record["operations"]}
    names: list[tuple[str, str, Span]] = []
    read: list[tuple[dict[str, Any], str, Input]] = []
    called: dict[str, dict[str, Any]] = {}
    for name, port in own.inputs.items():
        sources = _list_sources(architecture, own, name)
        # An input without a type of its own has that of what it reads.
        ends: tuple[Input | Output, ...] = (port, *sources)
        shown = next((each for each in ends if each.type), port)
        interface = name_port_member(name)
        if interface.casefold() in taken:
            interface = f"{name_member(name)}_input"
        record = _record_port(port, interface)
        if architecture.flow_of(shown) == "topic":
            type_hints = {**(sources[0] if sources else port).annotations.hints, **port.annotations.hints}
            own_type = types.find_port_type(shown.type, type_hints, port.at)
            findings += _drop_mute_interface(own_type, port, is_sent=bool(sources))
            read.append(({**record, "type": own_type, "is_fed": bool(sources)}, port.id, port))
            read += _split_by_type(types, port, interface, own_type, sources)
        else:
            server = _find_server(sources, classes)
            if server is None:
                findings.append(_tell_unanswered(port, sources))
                continue
            called[port.id] = {**record, **server}
            names.append((interface, port.id, port.at))
    names += [(record["name"], key, port.at) for record, key, port in read]
    others = [*own.record["outputs"], *own.record["operations"]]
    used = [(str(each["name"]), f"{own.first.id}.{each['title']}", own.first.at) for each in others]
    clashing, clashes = drop_clashes([*used, *names], "name")
    own.record["inputs"] = [record for record, key, _ in read if key not in clashing]
    own.record["calls"] = [each for port_id, each in called.items() if port_id not in clashing]
    own.record["headers"] = _list_foreign_files(own.record, "header")
    own.record["typekits"] = _list_foreign_files(own.record, "typekit")
    return [*findings, *clashes]


def _list_foreign_files(record: Mapping[str, Any], kind: str) -> list[str]:
    """Return the headers or typekits of all types of others that a class sends, reads, is called with, or calls with."""
    ports = [*record["inputs"], *record["outputs"]]
    operations = [*record["operations"], *(each["operation"] for each in record["calls"])]
    types = [each["type"] for each in (*ports, *(part for each in operations for part in each["arguments"]))]
    types += [each["result"] for each in operations if each["result"]]
    return sorted({str(each[kind]) for each in types if each[kind]})


def _tell_unanswered(port: Input, sources: Iterable[Output]) -> Diagnostic:
    source = next(iter(sources), None)
    why = f"what it calls, `{source.id}`, is left out" if source else "nobody of the architecture answers it"
    help_line = "say which component has an output for it, or write it as an operation"
    return tell_left_out(
        f"`{port.id}` is left out: {why}", port.at, element=port.id, help_line=None if source else help_line
    )


def _list_sources(architecture: Architecture, own: ComponentClass, name: str) -> list[Output]:
    """Return the outputs that the input of any instance reads, each once."""
    ports = [each.inputs[name] for each in own.components if name in each.inputs]
    ids = dict.fromkeys(output for port in ports for each in port.connections for output in each.outputs)
    return [architecture.outputs[each] for each in ids]


def _drop_mute_interface(port_type: dict[str, Any], port: Input | Output, *, is_sent: bool) -> list[Diagnostic]:
    """Take the interface of Player from what it cannot carry: not every one has data, and few have commands."""
    interface = port_type["interface"]
    if not interface or interface["data" if is_sent else "command"]:
        return []
    port_type["interface"] = None
    words = "data" if is_sent else "commands, and nobody of the architecture feeds it"
    message = f"`{interface['name']}` of Player is not used for `{port.id}`: it has no {words}"
    return [tell_left_out(message, port.at, element=port.id, help_line="without the hint it goes through `opaque`")]


def name_port_type(port_type: Mapping[str, Any]) -> tuple[str, str]:
    """Return what a port is joined by: both ends hold the same, through the same interface."""
    return port_type["cpp"], (port_type["interface"] or {}).get("name", "")


def _split_by_type(
    types: MiddlewareTypes, port: Input, name: str, own_type: Mapping[str, Any], sources: Iterable[Output]
) -> Iterator[tuple[dict[str, Any], str, Input]]:
    """Yield a port for each other type that an input reads, since a port holds one; it is called after its first source, too."""
    seen = {name_port_type(own_type)}
    for source in sources:
        source_type = types.find_port_type(source.type, source.annotations.hints, source.at)
        if name_port_type(source_type) not in seen:
            seen.add(name_port_type(source_type))
            record = _record_port(port, name_port_member(f"{name}_{source.name}"))
            yield {**record, "type": source_type, "is_fed": True}, f"{port.id} {source.name}", port


def _find_server(sources: Iterable[Output], classes: Mapping[str, ComponentClass]) -> dict[str, Any] | None:
    """Return the class that answers, and the operation as it stands in its record."""
    for source in sources:
        server = classes.get(source.component)
        for operation in server.record.get("operations", ()) if server else ():
            if server and operation["port"] == source.name:
                return {
                    "server": server.record["name"],
                    "server_module": server.record["module"],
                    "operation": operation,
                }
    return None


def _record_port(port: Input | Output, name: str) -> dict[str, Any]:
    return {
        "id": port.id,
        "name": name,
        "title": port.name,
        "member": name.rstrip("_"),
        "wire": shorten_wire_name(name),
        "type_name": port.type or "",
        "description": port.description or "",
        "place": write_place(port.at),
    }


_MOST_ARGUMENTS = 4
"""What takes more gets a record: not every middleware takes any number."""
_SETTING_WORD = "set"


def is_command(operation: Operation) -> bool:
    """Return whether nobody waits for an operation: as `call` says, else where its name begins with `set`."""
    if operation.call is not None:
        return operation.call == "asynchronous"
    return [each.lower() for each in list_name_words(operation.id)[:1]] == [_SETTING_WORD]


def record_operations(types: MiddlewareTypes, words: str, components: Iterable[Component]) -> list[dict[str, Any]]:
    """Return the operations that instances of a class have and that are not private."""
    found: dict[str, tuple[Operation, Component]] = {}
    for component in components:
        for name, operation in component.operations.items():
            if operation.visibility != "private":
                found.setdefault(name, (operation, component))
    return [_record_operation(types, words, operation, component) for operation, component in found.values()]


def _record_operation(types: MiddlewareTypes, words: str, operation: Operation, component: Component) -> dict[str, Any]:
    request = operation.request
    if isinstance(request, str):
        request = {"request": request}
    given = dict(request or {})
    if len(given) > _MOST_ARGUMENTS or len({name_member(name) for name in given}) < len(given):
        fields = [(name, types.find_written_type(written, operation.at)) for name, written in given.items()]
        arguments = [("request", types.add_answer(f"{words} {operation.id} request", fields, operation.at))]
    else:
        arguments = [(name, types.find_called_type(written, operation.at)) for name, written in given.items()]
    answer = operation.response
    if isinstance(answer, Mapping):
        fields = [(name, types.find_written_type(written, operation.at)) for name, written in answer.items()]
        made = types.add_answer(f"{words} {operation.id} response", fields, operation.at) if fields else None
    else:
        made = types.find_called_type(answer, operation.at) if answer else None
    record = _record_called(operation, operation.id, arguments, made, is_command=is_command(operation))
    return {**record, "element": f"{component.id} {operation.id}", "port": None}


def record_served(architecture: Architecture, types: MiddlewareTypes, port: Output) -> dict[str, Any]:
    """Return an output that is called as an operation: a service is waited for, an action is not."""
    request, answer = types.find_call_parts(port.type, port.at)
    arguments = [("request", request)] if request else []
    is_action = architecture.flow_of(port) == "action"
    record = _record_called(port, port.name, arguments, answer, is_command=is_action)
    return {**record, "element": port.id, "port": port.name}


def _record_called(
    source: Operation | Output,
    name: str,
    arguments: Iterable[tuple[str, object]],
    result: object,
    *,
    is_command: bool,
) -> dict[str, Any]:
    interface = name_port_member(name)
    return {
        "span": source.at,
        "name": interface,
        "member": interface.rstrip("_"),
        "wire": shorten_wire_name(interface),
        "title": name,
        "is_command": is_command,
        "arguments": [
            {"name": name_inside(name_member(each), interface), "title": each, "type": argument_type}
            for each, argument_type in arguments
        ],
        "result": result,
        "description": source.description or "",
        "place": write_place(source.at),
    }
