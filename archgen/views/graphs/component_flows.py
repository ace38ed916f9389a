"""List what runs between components, as pictures count it: each connection, by the components at its ends.

Data runs from the producer to the reader. A service or action is drawn from its client to its server, with an arrow
of its own. A connection to a whole group is one flow for each component of the group that it takes something from.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from typing import Literal

from archgen.frozen import dataclass
from archgen.model.architecture import Architecture
from archgen.model.component import Connection, Input, Output
from archgen.model.port_media import is_physical, label_of_medium, nature_of
from archgen.views.graph_shapes import Arrow

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
    return (
        "\n".join(names)
        if len(names) <= _MAX_TYPE_LINES
        else "\n".join([*names[:2], f"and {len(names) - 2} more types"])
    )
