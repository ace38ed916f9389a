"""Is everything connected? Isolated components, inputs that nothing feeds or that name a source twice, outputs that nobody reads."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from archgen.diagnostics import Diagnostic, Label, Severity, diagnose_repetition
from archgen.model.architecture import Architecture
from archgen.model.component import Component, Connection, Output
from archgen.model.port_media import is_physical


def is_offered_by_library(architecture: Architecture, output: Output) -> bool:
    """Whether a component type of a library has an output: what the project adds to a type is the project's."""
    component = architecture.components[output.component]
    bases = architecture.list_bases(component.type_name)
    library_type = next((each for each in bases if each.library is not None), None)
    return library_type is not None and output.name in library_type.outputs


def waits_for_calls(architecture: Architecture, component: Component) -> bool:
    """Whether a component of a library's type has services and actions only, which people and tools may call."""
    flows = {"physical" if is_physical(each) else architecture.flow_of(each) for each in component.outputs.values()}
    return not component.inputs and flows <= {"service", "action"} and any(architecture.list_libraries_of(component))


def find_linked_components(architecture: Architecture) -> frozenset[str]:
    """Return the ids of all components that a connection joins to another component.

    A component whose outputs are not known yet counts as connected if a reference names it or its group.
    """
    linked = set[str]()
    for connection in architecture.connections:
        reader = architecture.inputs[connection.input].component
        feeders = {architecture.outputs[output].component for output in connection.outputs}
        feeders.update(
            component.id for component in _target_components(architecture, connection) if not component.outputs_known
        )
        feeders.discard(reader)  # a component that reads its own output is still connected to nobody
        if feeders:
            linked.add(reader)
            linked |= feeders
    return frozenset(linked)


def disconnected_component(architecture: Architecture) -> Iterator[Diagnostic]:
    """A component exchanges nothing with any other component, nor with the world outside."""
    # With an unread file, what looks isolated may be connected there.
    if len(architecture.components) == 1 or architecture.partial:
        return
    linked = find_linked_components(architecture)
    existing = _find_existing(architecture)
    shared_outputs = _list_shared_outputs(architecture)
    for component in architecture.components.values():
        if component.id in linked or _has_open_reference(component) or waits_for_calls(architecture, component):
            continue
        if any(i.external for i in component.inputs.values()) or any(
            o.external or o.id in shared_outputs for o in component.outputs.values()
        ):
            continue
        if not architecture.suspected_ids.isdisjoint(
            (component.group, component.id, *(o.id for o in component.outputs.values()))
        ):
            continue  # an unresolved reference, reported already, probably meant this component
        is_stub = not (component.inputs or component.outputs or (component.inputs_known and component.outputs_known))
        if is_stub and not architecture.connections:
            continue
        yield Diagnostic(
            "disconnected-component",
            f"`{component.id}` is connected to no other component",
            component.at,
            severity=Severity.NOTE if is_stub or component.id in existing else None,
            help="say in its `inputs` what it takes from others, or let another component take one of its outputs",
            element=component.id,
        )


def unfed_input(architecture: Architecture) -> Iterator[Diagnostic]:
    """Nothing feeds an input: it has no source, is not fed from outside, and is not optional."""
    for entry in architecture.inputs.values():
        if entry.from_written or entry.connections or entry.external or entry.optional:
            continue
        yield Diagnostic(
            "unfed-input",
            f"nothing feeds the input `{entry.name}` of `{entry.component}`",
            entry.at,
            help="name its source in `from`, say what feeds it from outside in `external`, or write `optional: true`",
            element=entry.component,
        )


def empty_reference(architecture: Architecture) -> Iterator[Diagnostic]:
    """A reference to a whole component or group brings nothing: no output in it carries messages."""
    for connection in architecture.connections:
        if connection.outputs or connection.kind == "output":
            continue
        reader = architecture.inputs[connection.input].component
        # A reference to one's own group never brings one's own outputs.
        targets = [c for c in _target_components(architecture, connection) if c.id != reader]
        # Stubs may still get outputs: the reference may turn out to bring something.
        if not all(c.outputs_known for c in targets):
            continue
        outputs = [output for c in targets for output in c.outputs.values()]
        yield Diagnostic(
            "empty-reference",
            f"`{connection.written}` brings nothing: no output in it carries messages",
            connection.at,
            labels=tuple(Label(o.at, f"{_kind_of_output(architecture, o)}, named by itself only") for o in outputs[:3]),
            help=f"write `{outputs[0].id}`" if len(outputs) == 1 else None,
            element=reader,
        )


def unread_output(architecture: Architecture) -> Iterator[Diagnostic]:
    """Nobody reads an output, inside the architecture or outside."""
    if architecture.partial:
        return
    read_outputs = {edge.output for edge in architecture.edges}
    existing = _find_existing(architecture)
    shared_outputs = _list_shared_outputs(architecture)
    # Groups and components that some input takes as a whole: that brings messages, but no services and actions.
    whole_targets = {c.target for c in architecture.connections if c.kind != "output"}
    taken_outputs = read_outputs | shared_outputs | {each.id for each in architecture.outputs.values() if each.external}
    for output in architecture.outputs.values():
        # That nobody reads what is going away is as it should be.
        if output.id in taken_outputs or output.deprecated is not None:
            continue
        component = architecture.components[output.component]
        group = component.group
        if not architecture.suspected_ids.isdisjoint((group, output.component, output.id)):
            continue
        # What a library offers for calls waits for whoever needs it; of what it sends, something should be read.
        if is_offered_by_library(architecture, output) and (
            _kind_of_output(architecture, output) in _CALLED_KINDS
            or any(each.id in taken_outputs for each in component.outputs.values())
        ):
            continue
        yield Diagnostic(
            "unread-output",
            f"nobody {'calls' if _kind_of_output(architecture, output) in _CALLED_KINDS else 'reads'} `{output.name}` of `{output.component}`",
            output.at,
            # A program that exists says more than this robot needs.
            severity=Severity.NOTE if output.component in existing else None,
            help=_suggest_reader(architecture, output, is_taken_whole=bool({output.component, group} & whole_targets)),
            element=output.component,
        )


def _find_existing(architecture: Architecture) -> frozenset[str]:
    """Return the components of which all nodes exist already."""
    by_status: dict[bool, set[str]] = {True: set(), False: set()}
    for node in architecture.nodes.values():
        by_status[node.status == "existing"].update(node.implements)
    return frozenset(by_status[True] - by_status[False])


def _suggest_reader(architecture: Architecture, output: Output, *, is_taken_whole: bool) -> str:
    kind = _kind_of_output(architecture, output)
    if is_taken_whole and kind != "topic":
        return f"a reference to the whole component does not take it, being {_KIND_PHRASES[kind]}: name `{output.id}`"
    return "let an input name it in `from`, or say who reads it outside in `external`"


_CALLED_KINDS = frozenset({"service", "action"})
_KIND_PHRASES = {"service": "a service", "action": "an action", "physical": "physical"}


def _kind_of_output(architecture: Architecture, output: Output) -> str:
    return "physical" if is_physical(output) else architecture.flow_of(output)


def _target_components(architecture: Architecture, connection: Connection) -> Iterable[Component]:
    """Return the components whose outputs a reference stands for; none for a reference to a single output."""
    if connection.kind == "group":
        return architecture.groups[connection.target].components.values()
    if connection.kind == "component":
        return (architecture.components[connection.target],)
    return ()


def _list_shared_outputs(architecture: Architecture) -> set[str]:
    """Return the outputs on topics that all nodes share."""
    return {e.port for topic in architecture.topics.values() if topic.shared for e in topic.writers if e.port}


def _has_open_reference(component: Component) -> bool:
    """Whether some reference could not be resolved or brings nothing. Both are reported by other rules."""
    return any(
        entry.from_written and not any(c.outputs for c in entry.connections) for entry in component.inputs.values()
    )


def repeated_source(architecture: Architecture) -> Iterator[Diagnostic]:
    """An input names the same source twice."""
    for port in architecture.inputs.values():
        first_connections: dict[str, Connection] = {}
        for connection in port.connections:
            first_connection = first_connections.setdefault(connection.target, connection)
            if first_connection is not connection:
                yield diagnose_repetition(
                    "repeated-source",
                    f"`{port.name}` of `{port.component}` names `{connection.target}` twice",
                    connection.at,
                    first_connection.at,
                    help_line="take one of them out, or name what was meant",
                    element=port.component,
                )


def mixed_source(architecture: Architecture) -> Iterator[Diagnostic]:
    """An input comes from a component and from outside of the system at once."""
    for port in architecture.inputs.values():
        if port.connections and port.external is not None:
            yield Diagnostic(
                "mixed-source",
                f"`{port.name}` of `{port.component}` comes from `{port.connections[0].target}` and from outside",
                port.at,
                help="keep `from` or `external`, or write two inputs",
                element=port.component,
            )


def own_source(architecture: Architecture) -> Iterator[Diagnostic]:
    """A component reads its own output."""
    for connection in architecture.connections:
        port = architecture.inputs[connection.input]
        # Who takes all of a group, himself among it, means the others; what a type hands out is written by nobody.
        if connection.kind == "group" or connection.is_made:
            continue
        feeders = {architecture.outputs[output].component for output in connection.outputs} or {connection.target}
        if feeders == {port.component}:
            yield Diagnostic(
                "own-source",
                f"`{port.name}` of `{port.component}` comes from `{connection.target}`, which is its own",
                connection.at,
                help="name the component whose output is meant; where the node does hear itself, allow it with the reason",
                element=port.component,
            )


RULES = (
    (disconnected_component, Severity.WARNING),
    (unfed_input, Severity.WARNING),
    (empty_reference, Severity.WARNING),
    (unread_output, Severity.WARNING),
    (repeated_source, Severity.WARNING),
    (mixed_source, Severity.WARNING),
    (own_source, Severity.WARNING),
)
