"""What runs between the boxes of a picture where composed components are closed, but for those that it opens.

A connection counts once, where it is written: at the port of a closed composed component, however many read it inside.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable, Iterator, Sequence
from typing import Literal

from archgen.diagnostics import fit_lines
from archgen.frozen import dataclass
from archgen.model import component_nesting
from archgen.model.architecture import Architecture
from archgen.model.component import Component, Connection, Input, Output
from archgen.model.port_media import is_physical, label_of_medium, nature_of
from archgen.views.lookup import Lookup
from archgen.views.picture_shapes import Arrow

FlowStyle = Literal["data", "physical", "service", "action", "internal", "link"]
_MAX_TYPE_LINES = 3


@dataclass(frozen=True, slots=True)
class ComponentFlow:
    """One connection between two components. `tail` and `head` are complete ids, in the direction of drawing."""

    connection: Connection
    tail: str
    head: str
    style: FlowStyle
    types: tuple[str, ...]
    optional: bool
    sentence: str
    medium: str = ""
    """How what it travels over is called, if that is data but no ROS."""
    warning: str = ""
    """What a reader should know before counting on it, in a few words."""

    @property
    def label(self) -> str:
        """The label beside the arrow: the types, each on a line."""
        return join_type_names(self.types)

    @property
    def is_made(self) -> bool:
        """Whether nobody wrote it: `autoconnect` joined the two."""
        return self.connection.is_made


def list_flows(architecture: Architecture) -> tuple[ComponentFlow, ...]:
    """Return all flows, in the order of the connections."""
    return tuple(
        flow for connection in architecture.connections for flow in _flows_of_connection(architecture, connection)
    )


def _flows_of_connection(architecture: Architecture, connection: Connection) -> Iterable[ComponentFlow]:
    port = architecture.inputs[connection.input]
    outputs = [architecture.outputs[each] for each in connection.outputs if each in architecture.outputs]
    for producer in dict.fromkeys(output.component for output in outputs):
        producer_outputs = [output for output in outputs if output.component == producer]
        style = flow_style(architecture, producer_outputs[0].id)
        is_call = style in {"service", "action"}
        names = ", ".join(output.name for output in producer_outputs)
        types = tuple(dict.fromkeys(output.type for output in producer_outputs if output.type))
        yield ComponentFlow(
            connection,
            port.component if is_call else producer,
            producer if is_call else port.component,
            style,
            types,
            port.optional,
            f"{architecture.components[producer].title} · {names}"
            f"{' (' + ', '.join(types) + ')' if types else ''}"
            f" → {architecture.components[port.component].title} · {port.name}",
            name_media((port, *producer_outputs)),
        )


def name_media(ports: Iterable[Input | Output]) -> str:
    """Return how what ports travel over is called, as far as that is data but no ROS."""
    return ", ".join(dict.fromkeys(label_of_medium(port) for port in ports if nature_of(port) == "other"))


def add_notes(label: str, *notes: str) -> str:
    """Return the label beside an arrow with notes, such as its medium, on lines of their own."""
    return "\n".join(filter(None, (label, *(f"({note})" for note in notes if note))))


def flow_style(architecture: Architecture, output_id: str) -> FlowStyle:
    """Return the style of arrow for what an output carries."""
    return port_style(architecture, architecture.outputs[output_id])


def port_style(architecture: Architecture, port: Input | Output) -> FlowStyle:
    """Return the style of arrow for what a port carries by its own type."""
    if is_physical(port):
        return "physical"
    flow = architecture.flow_of(port)
    return "data" if flow == "topic" else flow


def merge_flows(
    flows: Iterable[ComponentFlow],
    find_ends: Callable[[ComponentFlow], tuple[str, str]],
    *,
    labels: bool,
    by_style: bool = True,
) -> tuple[Arrow, ...]:
    """Merge flows with the same ends (and of the same style, if asked) into one arrow each."""
    bundles: dict[tuple[str, str, FlowStyle, str], list[ComponentFlow]] = {}
    for flow in flows:
        tail, head = find_ends(flow)
        form: tuple[FlowStyle, str] = (flow.style, flow.medium) if by_style else ("data", "")
        bundles.setdefault((tail, head, *form), []).append(flow)
    return tuple(
        Arrow(
            f"{tail}>{head}" + (f":{style}" if style != "data" else "") + (f":{medium}" if medium else ""),
            tail,
            head,
            label=add_notes(_bundle_label(bundle), medium) if labels else "",
            style=style,
            count=len(bundle),
            optional=by_style and all(flow.optional for flow in bundle),
            flows=tuple(flow.sentence for flow in bundle),
            is_made=all(flow.is_made for flow in bundle),
            medium=medium,
        )
        for (tail, head, style, medium), bundle in bundles.items()
    )


def _bundle_label(bundle: list[ComponentFlow]) -> str:
    """Return the types of a bundle, each on a line with what is to be known of what it comes from."""
    names = list(dict.fromkeys(name for flow in bundle for name in flow.types))
    if len(names) > _MAX_TYPE_LINES or not all(flow.types for flow in bundle):
        return add_notes(join_type_names(names), *dict.fromkeys(flow.warning for flow in bundle))
    warnings = {name: dict.fromkeys(flow.warning for flow in bundle if name in flow.types) for name in names}
    return "\n".join(add_notes(name, *warnings[name]) for name in names)


def join_type_names(names: Sequence[str]) -> str:
    """Return names of types, each on a line; of more than three the rest is counted."""
    return "\n".join(fit_lines(names, _MAX_TYPE_LINES, "and {} more types"))


@dataclass(frozen=True, slots=True)
class _FlowPart:
    """What one connection brings from one component: between which boxes, the names of the outputs, and their types."""

    port: Input
    connection: Connection
    source: str
    reader: str
    style: FlowStyle
    names: tuple[str, ...]
    types: tuple[str, ...]
    warning: str


@dataclass(frozen=True, slots=True)
class DrawnLevel:
    """Which box stands for each component: the outermost composed one around it that is not open, else itself."""

    lookup: Lookup
    open_shells: Collection[str] = frozenset()

    @property
    def architecture(self) -> Architecture:
        """Return the architecture."""
        return self.lookup.architecture

    def find_box(self, component_id: str) -> str:
        """Return the id of the component whose box stands for a component."""
        return component_nesting.find_closed(self.architecture, component_id, self.open_shells)

    def find_component(self, component_id: str) -> Component:
        """Return a component by its complete id."""
        return component_nesting.find_component(self.architecture, component_id)

    def list_boxes(self) -> tuple[Component, ...]:
        """Return what the picture of everything has boxes for, group by group."""
        if not self.architecture.shells:
            return tuple(self.architecture.components.values())
        names = (name for group in self.architecture.groups for name in self.list_group_boxes(group))
        return tuple(map(self.find_component, names))

    def list_group_boxes(self, group_id: str) -> tuple[str, ...]:
        """Return the ids of what a group has boxes for."""
        return component_nesting.list_members(self.architecture, group_id, self.open_shells)

    def list_flows(self) -> tuple[ComponentFlow, ...]:
        """Return all flows, in the order of the connections."""
        return tuple(self._join_parts(self.lookup.written_connections))

    def list_flows_at(self, box_ids: Collection[str]) -> list[ComponentFlow]:
        """Return the flows that begin or end at some boxes, in the order of the connections."""
        # Every group's picture asks: to go through all connections for each is quadratic.
        positions = {at for box in box_ids for at in self.lookup.connection_positions.get(box, ())}
        touching = (self.lookup.written_connections[at] for at in sorted(positions))
        return [flow for flow in self._join_parts(touching) if flow.tail in box_ids or flow.head in box_ids]

    def _join_parts(self, connections: Iterable[tuple[Input, Connection]]) -> Iterator[ComponentFlow]:
        """Yield the flows of connections. What one reference brings through a composed component is one flow."""
        parts_by_flow: dict[tuple[object, ...], list[_FlowPart]] = {}
        for at, (port, connection) in enumerate(connections):
            for part in self._list_parts(port, connection):
                way = connection.shell_port or at
                parts_by_flow.setdefault((port.id, way, part.source, part.reader, part.style), []).append(part)
        return (self._make_flow(parts) for parts in parts_by_flow.values())

    def _make_flow(self, parts: Sequence[_FlowPart]) -> ComponentFlow:
        first = parts[0]
        source, reader = first.source, first.reader
        types = tuple(dict.fromkeys(name for part in parts for name in part.types))
        names = ", ".join(dict.fromkeys(name for part in parts for name in part.names))
        warning = ", ".join(dict.fromkeys(part.warning for part in parts if part.warning))
        return ComponentFlow(
            first.connection,
            *((reader, source) if first.style in {"service", "action"} else (source, reader)),
            first.style,
            types,
            first.port.optional,
            f"{self.find_component(source).title} · {names}"
            f"{' (' + ', '.join(types) + ')' if types else ''}"
            f" → {self.find_component(reader).title} · {self._name_port(first.port.id, reader)}"
            f"{f' ({warning})' if warning else ''}",
            warning=warning,
        )

    def _list_parts(self, port: Input, connection: Connection) -> Iterator[_FlowPart]:
        """Yield what a connection brings, for each component that it comes from."""
        architecture = self.architecture
        if port.component in self.open_shells and port.id not in architecture.inputs:
            return
        passed_shell = component_nesting.find_passed_shell(architecture, port.component, connection)
        if passed_shell is not None and passed_shell not in self.open_shells:
            return
        reader = self.find_box(port.component)
        outputs = [architecture.outputs[each] for each in connection.outputs if each in architecture.outputs]
        for producer in dict.fromkeys(output.component for output in outputs):
            source = self._find_source(connection, producer)
            # What stays inside of a closed component is not drawn; what a leaf sends to itself is.
            if source == reader and reader in architecture.shells:
                continue
            own_outputs = [output for output in outputs if output.component == producer]
            names = tuple(self._name_port(output.id, source, connection) for output in own_outputs)
            types = tuple(dict.fromkeys(output.type for output in own_outputs if output.type))
            style = flow_style(architecture, own_outputs[0].id)
            warning = warn_of_outputs(self.lookup, own_outputs)
            yield _FlowPart(port, connection, source, reader, style, names, types, warning)

    def _find_source(self, connection: Connection, producer: str) -> str:
        """Return the box that a connection comes from: of a closed component that passes on what it reads, itself."""
        port_id = connection.shell_port or ""
        for holder in (port_id, port_id.rpartition(".")[0]):
            if holder in self.architecture.shells and connection.input.startswith(f"{holder}."):
                break
            if holder in self.architecture.shells and holder not in self.open_shells:
                return self.find_box(holder)
        return self.find_box(producer)

    def _name_port(self, port_id: str, box_id: str, connection: Connection | None = None) -> str:
        """Return a port as seen at a box: its name there, else its path inside of the box."""
        shell_port = connection.shell_port if connection else None
        if shell_port and shell_port.rpartition(".")[0] == box_id and shell_port not in self.architecture.shells:
            return shell_port.rpartition(".")[2]
        inner_path = port_id.removeprefix(f"{box_id}.")
        return inner_path if inner_path != port_id else port_id.rpartition(".")[2]


def list_open_shells(architecture: Architecture, component_ids: Collection[str]) -> frozenset[str]:
    """Return the composed components that a picture of some leaves must open: some inside are shown, some are not."""
    return frozenset(
        shell
        for shell in architecture.shells
        if len({leaf in component_ids for leaf in architecture.leaves_of(shell)}) > 1
    )


def warn_of_outputs(lookup: Lookup, outputs: Iterable[Output]) -> str:
    """Return a few words beside what outputs send: `deprecated, promise not kept`; empty where all is well."""
    kept_outputs = tuple(outputs)
    words = []
    if any(output.deprecated for output in kept_outputs):
        words.append("deprecated")
    if any(_breaks_promise(lookup, output) for output in kept_outputs):
        words.append("promise not kept")
    return ", ".join(words)


def _breaks_promise(lookup: Lookup, output: Output) -> bool:
    if output.promise is None:
        return False
    # The finding stands at what is promised: its element is the component, which may promise other things, too.
    places = {output.promise.at, *output.promise.places.values()}
    findings = lookup.findings_of.get(output.component, ())
    return any(finding.rule == "broken-promise" and finding.span in places for finding in findings)
