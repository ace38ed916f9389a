"""Do the types and media that inputs expect agree with what their sources send, and are the words for media known?"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator, Mapping

from archgen.derivation.wire.running_state import FAST_DDS, list_discovery_servers
from archgen.diagnostics import NO_SPAN, Diagnostic, Label, Severity, Span, did_you_mean
from archgen.grouping import group_pairs
from archgen.model.architecture import Architecture
from archgen.model.component import Connection, Input, Output
from archgen.model.message_types import flow_of, full_message_name
from archgen.model.node import Node
from archgen.model.port_media import MEDIUM_NAMES, MEMORY, is_physical, name_medium, uses_ros
from archgen.model.ros_distro import can_name_peers, is_ros_1, knows_super_clients


def is_expected_type(architecture: Architecture, expected_type: str, output: Output) -> bool:
    """Whether an output sends the type that an input expects. An output without a type does.

    Conceptual types are compared by name: two types with the same message still mean different things. If one of them
    is written as a message, the messages are compared. A caller may expect a service's type, or a type inside it.
    """
    sent_type = output.type
    if sent_type is None or sent_type == expected_type:
        return True
    mapped = architecture.types.get(sent_type)
    if full_message_name(expected_type) or full_message_name(sent_type):
        messages = {_message_of_type(architecture, expected_type), _message_of_type(architecture, sent_type)}
        # A type that is not mapped yet may still be mapped to this message.
        return None in messages or len(messages) == 1
    if mapped is None or flow_of(mapped.message) == "topic":
        return False
    return expected_type in {mapped.request, mapped.response, mapped.feedback}


def type_mismatch(architecture: Architecture) -> Iterator[Diagnostic]:
    """An input expects another type than its source sends."""
    for connection in architecture.connections:
        entry = architecture.inputs[connection.input]
        expected_type = entry.type
        if expected_type is None:
            continue
        wrong_outputs = [
            o
            for o in map(architecture.outputs.__getitem__, connection.outputs)
            if not is_expected_type(architecture, expected_type, o)
        ]
        if wrong_outputs:
            names = " and ".join(f"`{o.id}` sends `{o.type}`" for o in wrong_outputs[:2])
            suffix = f" (and {len(wrong_outputs) - 2} more)" if len(wrong_outputs) > 2 else ""  # noqa: PLR2004 - two are named
            yield Diagnostic(
                "type-mismatch",
                f"the input `{entry.name}` of `{entry.component}` expects `{expected_type}`, but {names}{suffix}",
                connection.at,
                labels=(
                    Label(entry.type_at, "expected here"),
                    *(Label(o.type_at, "sent here") for o in wrong_outputs[:2]),
                ),
                help=_suggest_common_type(architecture, expected_type, wrong_outputs[0]),
                element=entry.component,
            )


def medium_mismatch(architecture: Architecture) -> Iterator[Diagnostic]:
    """An input has another medium than its source: it is physical and the source sends messages, or one is MQTT and the
    other CAN.
    """
    readers = [architecture.inputs[connection.input] for connection in architecture.connections]
    pairs = [*zip(architecture.connections, readers, strict=True), *_list_shell_connections(architecture)]
    for connection, entry in pairs:
        if not entry.medium_written:
            continue
        wrong_output = next((o for o in connection.outputs if architecture.outputs[o].medium != entry.medium), None)
        if wrong_output is not None:
            yield _diagnose_other_medium(connection, entry, architecture.outputs[wrong_output])
    yield from _find_shell_outputs(architecture)
    yield from _find_readers_of_physical_outputs(architecture)
    yield from _find_divided_memory(architecture)


def _list_shell_connections(architecture: Architecture) -> Iterator[tuple[Connection, Input]]:
    """Yield what feeds the inputs of composed components: the connections themselves lead on to what is inside."""
    for shell in architecture.shells.values():
        for entry in shell.inputs.values():
            if entry.id not in architecture.inputs:
                yield from ((connection, entry) for connection in entry.connections)


def _diagnose_other_medium(connection: Connection, entry: Input, output: Output) -> Diagnostic:
    if is_physical(entry):
        fault = "sends messages" if uses_ros(output) else f"sends data ({name_medium(output.medium)})"
        message = f"the input `{entry.name}` of `{entry.component}` is physical, but `{output.id}` {fault}"
        help_line = "leave `medium: physical` out at the input, or write it at the output too"
        return _make_mismatch(connection, entry, output, message, "not physical", help_line)
    sent = "is physical" if is_physical(output) else f"sends over {name_medium(output.medium)}"
    message = f"the input `{entry.name}` of `{entry.component}` is read over {name_medium(entry.medium)}, but `{output.id}` {sent}"
    help_line = f"leave `medium` out at the input, which then has that of its source, or write `medium: {entry.medium}` at the output"
    return _make_mismatch(connection, entry, output, message, "sent here", help_line)


def _make_mismatch(  # noqa: PLR0913, PLR0917 - what it says
    connection: Connection, entry: Input, output: Output, message: str, mark: str, help_line: str
) -> Diagnostic:
    place = output.medium_at if output.medium_at != NO_SPAN else output.at
    return Diagnostic(
        "medium-mismatch",
        message,
        connection.at,
        labels=(Label(place, mark),),
        help=help_line,
        element=entry.component,
    )


def _find_shell_outputs(architecture: Architecture) -> Iterator[Diagnostic]:
    """Report outputs of composed components whose medium is another than that of what they pass on."""
    for shell in architecture.shells.values():
        for output in shell.outputs.values():
            if not output.medium_written:
                continue
            given = (architecture.outputs.get(each) for each in architecture.leaf_ports_of("output", output.id))
            other = next((each for each in given if each and each.medium != output.medium), None)
            if other is not None and other.medium_written:
                yield Diagnostic(
                    "medium-mismatch",
                    f"`{output.id}` has the medium `{output.medium}`, but gives on `{other.id}`, which has `{other.medium}`",
                    output.medium_at,
                    labels=(Label(other.medium_at, "given on"),),
                    help="write it in one place: what is left out follows",
                    element=shell.id,
                )


def _find_divided_memory(architecture: Architecture) -> Iterator[Diagnostic]:
    """Report data that is in memory, and read by a process in which it is not."""
    processes: dict[str, set[str]] = defaultdict(set)
    for node in architecture.nodes.values():
        if node.written:
            for component in node.implements:
                processes[component].add(f"container {node.container}" if node.container else node.id)
    for edge in architecture.edges:
        output, entry = architecture.outputs[edge.output], architecture.inputs[edge.input]
        writing, reading = processes.get(output.component), processes.get(entry.component)
        if output.medium == entry.medium == MEMORY and writing and reading and writing.isdisjoint(reading):
            yield Diagnostic(
                "medium-mismatch",
                f"`{entry.id}` reads `{output.id}` from memory, but runs in another process",
                edge.at,
                labels=(Label(output.medium_at if output.medium_at != NO_SPAN else output.at, "in memory"),),
                help="let one node implement both, put their nodes into one container, or name what the data travels over",
                element=entry.component,
            )


def _find_readers_of_physical_outputs(architecture: Architecture) -> Iterator[Diagnostic]:
    """Report what nodes subscribe to, or call, for inputs whose sources are all physical."""
    outputs_by_input = group_pairs((edge.input, architecture.outputs[edge.output]) for edge in architecture.edges)
    for node in architecture.nodes.values():
        for use in node.uses:
            entry = architecture.inputs.get(use.port or "")
            outputs = outputs_by_input.get(use.port or "", [])
            # A physical input is `wrong-section`'s; one that is also fed from outside may get its messages there.
            if entry and not is_physical(entry) and not entry.external and outputs and all(map(is_physical, outputs)):
                yield Diagnostic(
                    "medium-mismatch",
                    f"`{node.id}` {'subscribes to' if use.use == 'subscribes' else use.use} `{entry.name}`, but `{outputs[0].id}` is physical and sends no messages",
                    use.at,
                    labels=(Label(outputs[0].at, "physical"),),
                    help="leave the entry out at the node, or `medium: physical` at the output",
                    element=node.id,
                )


def _suggest_common_type(architecture: Architecture, expected_type: str, output: Output) -> str | None:
    """Suggest to use one name where both types have the same message."""
    message = architecture.message_of(output)
    if message is not None and message == _message_of_type(architecture, expected_type):
        return f"both travel as `{message}`, but are two types: use one name if they mean the same"
    return None


def _message_of_type(architecture: Architecture, type_name: str) -> str | None:
    """Return the message of a conceptual type, or of a type that is itself the name of a message; None if unmapped."""
    mapped = architecture.types.get(type_name)
    return (mapped.message if mapped else None) or full_message_name(type_name)


def unlisted_medium(architecture: Architecture) -> Iterator[Diagnostic]:
    """The word for a medium is none that archgen knows, and stands in one place of the project only."""
    places = _find_places(architecture)
    for word, spans in places.items():
        if word in MEDIUM_NAMES or word == architecture.project.middleware or len(spans) > 1:
            continue
        (span, element), *_ = spans.items()
        others = [other for other in (*MEDIUM_NAMES, *places) if other != word]
        yield Diagnostic(
            "unlisted-medium",
            f"`{word}` is no medium that archgen knows, and is written only here",
            span,
            help=did_you_mean(word, others)
            or "any word counts: written a second time, it is taken for one that is meant",
            element=element,
        )


def _find_places(architecture: Architecture) -> Mapping[str, Mapping[Span, str]]:
    """Return where each word is written, with the element there. What instances have from their type is one place."""
    places: dict[str, dict[Span, str]] = defaultdict(dict)
    for component in architecture.list_described_components():
        for port in component.ports:
            if port.medium_at != NO_SPAN and port.medium_written:
                places[port.medium].setdefault(port.medium_at, component.id)
    for link in architecture.links.values():
        if link.protocol:
            places[link.protocol].setdefault(link.protocol_at, link.id)
    return places


def unused_ros_setting(architecture: Architecture) -> Iterator[Diagnostic]:
    """Something is written that only ROS has, at a port or a program that is no ROS; or that its distribution has not."""
    for message, place, help_line, element in (
        *_list_discovery_settings(architecture),
        *_list_unserved_hosts(architecture),
    ):
        yield Diagnostic("unused-ros-setting", message, place, help=help_line, element=element)
    for node in architecture.nodes.values():
        for key, place, reason in (*_list_port_settings(architecture, node), *_list_program_settings(node)):
            yield Diagnostic(
                "unused-ros-setting",
                f"`{key}` of `{node.id}` has no effect: {reason}",
                place if place != NO_SPAN else node.at,
                help="leave it out",
                element=node.id,
            )


def _list_discovery_settings(architecture: Architecture) -> Iterator[tuple[str, Span, str, str | None]]:
    """Yield what is written of how nodes find one another, and finds nobody: message, place, help, host."""
    way, distro = architecture.ros_discovery, architecture.distro
    written = next((each for each in architecture.ros_environment if each.name == "RMW_IMPLEMENTATION"), None)
    middleware = str(written.value) if written else FAST_DDS
    is_fast_dds = middleware.startswith(FAST_DDS) and not is_ros_1(distro)
    # These are told by a profile that is generated.
    is_told = is_fast_dds or (middleware.startswith("rmw_cyclonedds") and not is_ros_1(distro))
    if way == "peers" and not can_name_peers(distro) and not is_told:
        words = f"{distro} reads no addresses of peers from the environment, ROS 2 does since Iron"
        help_line = "leave it out, and give the nodes a profile of their DDS by `ros: {environment: ...}`; for Fast DDS and Cyclone DDS one is generated"
        yield f"`discovery: peers` has no effect: {words}", architecture.distro_at, help_line, None
    if way == "peers" and written and middleware.startswith("rmw_zenoh"):
        words = "`discovery: peers` has no effect: Zenoh reads no addresses of peers from ROS's variables"
        help_line = "leave it out, and let the hosts' routers connect: `ZENOH_ROUTER_CONFIG_URI` in `environment` names a file that says to whom"
        yield words, written.at, help_line, None
    hosts = list(architecture.hosts.values())
    if way == "server":
        if not is_fast_dds:
            words = f"`{middleware}` has no discovery server" if not is_ros_1(distro) else f"{distro} has a master"
        elif not knows_super_clients(distro):
            words = f"what looks at nodes of {distro} sees none that it joins; it does with Fast DDS 2.13, in ROS 2 since Jazzy"
        else:
            words = "" if any(host.discovery_server for host in hosts) else "no host has a `discovery_server`"
        if words:
            is_nowhere = words.startswith("no host")
            help_line = "write `discovery_server: 11811` at a host that always runs" if is_nowhere else "leave it out"
            help_line = help_line if is_ros_1(distro) else f"{help_line}, or write `discovery: peers`"
            yield f"`discovery: server` has no effect: {words}", architecture.distro_at, help_line, None
    for host in hosts:
        if host.discovery_server and way != "server":
            words = f"`discovery_server` of `{host.id}` has no effect: nothing says that nodes ask it"
            yield words, host.at, "write `ros: {discovery: server}`, or leave it out", host.id
        is_asked = host.discovery_server if way == "server" else way == "peers" and len(hosts) > 1
        if is_asked and is_fast_dds and ":" in host.network_name:
            words = f"`discovery: {way}` finds nothing at `{host.network_name}`: Fast DDS takes no {'peer' if way == 'peers' else 'server'} by a number of IPv6, and nodes that are told of one do not start"
            help_line = "write its IPv4 number, or a name that has one, as `address`; or another DDS (`RMW_IMPLEMENTATION` in `environment` of `ros`)"
            yield words, host.at, help_line, host.id


def _list_unserved_hosts(architecture: Architecture) -> Iterator[tuple[str, Span, str, str | None]]:
    """Yield the same of hosts with a middleware of their own that asks no discovery server."""
    for host in architecture.hosts.values() if list_discovery_servers(architecture) else ():
        middleware = host.environment.get("RMW_IMPLEMENTATION", FAST_DDS)
        if not middleware.startswith(FAST_DDS):
            words = f"`discovery: server` finds nothing on `{host.id}`: `{middleware}` has no discovery server"
            place = host.environment_places.get("RMW_IMPLEMENTATION", host.at)
            yield words, place, "leave its middleware out, or write `discovery: peers`", host.id


def _list_port_settings(architecture: Architecture, node: Node) -> Iterator[tuple[str, Span, str]]:
    """Yield what is written for ROS at ports that travel over something else: key, place, and why it means nothing."""
    for use in node.uses:
        ports = architecture.outputs if use.use in {"publishes", "serves"} else architecture.inputs
        port = ports.get(use.port or "")
        # Of a physical port nothing at all is listed at a node: another rule says so.
        if port is None or uses_ros(port) or is_physical(port):
            continue
        reason = f"`{port.name}` is {name_medium(port.medium)} and no ROS"
        if use.qos is not None and use.qos.written:
            yield f"{use.use}.{use.key}.qos", use.qos.at, reason
        if use.message is not None:
            yield f"{use.use}.{use.key}.message", use.message_at, reason


def _list_program_settings(node: Node) -> Iterator[tuple[str, Span, str]]:
    """Yield what is written for ROS at a program."""
    if not node.is_program:
        return
    reason = "a program is no node of ROS"
    if node.name_at != NO_SPAN:
        yield "name", node.name_at, reason
    if node.namespace != "/":
        yield "namespace", node.at, reason
    if node.container is not None:
        yield "container", node.container_at, "a program is a process of its own"
    for kind in node.kinds:
        if kind != "program":
            yield f"kind: {kind}", node.kind_at, reason
    if node.parameters or node.parameter_commands:
        places = [value.at for value in node.own_values]
        yield "parameters", places[0] if places else node.at, reason
    if node.parameter_files:
        yield "parameter_files", node.at, reason


RULES = (
    (type_mismatch, Severity.ERROR),
    (medium_mismatch, Severity.WARNING),
    (unlisted_medium, Severity.NOTE),
    (unused_ros_setting, Severity.WARNING),
)
