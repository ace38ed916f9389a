"""List what runs between components, as pictures count it: each connection, by the components at its ends.

Data runs from the producer to the reader. A service or action is drawn from its client to its server, with an arrow
of its own. A connection to a whole group is one flow for each component of the group that it takes something from.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable
from dataclasses import dataclass
from typing import Literal

from archgen.model.architecture import Architecture
from archgen.model.component import Connection
from archgen.model.mapping import flow_of
from archgen.views.shapes import Arrow

Style = Literal["data", "physical", "service", "action", "internal", "link"]


@dataclass(frozen=True, slots=True)
class Flow:
    """One connection between two components. `tail` and `head` are complete ids, in the direction of drawing."""

    connection: Connection
    tail: str
    head: str
    style: Style
    types: tuple[str, ...]
    optional: bool
    sentence: str

    @property
    def label(self) -> str:
        """The label beside the arrow: the type, or the number of types."""
        if len(self.types) == 1:
            return self.types[0]
        return f"* {len(self.types)} types" if self.types else ""


def flows(architecture: Architecture) -> tuple[Flow, ...]:
    """Return all flows, in the order of the connections."""
    return tuple(flow for connection in architecture.connections for flow in _of(architecture, connection))


def flows_at(architecture: Architecture, components: Collection[str]) -> list[Flow]:
    """Return the flows that begin or end at some components, in the order of the connections."""
    inputs, outputs = architecture.inputs, architecture.outputs
    # Connections are filtered before flows are made of them: every group's picture asks, so all of it stays linear.
    near = (
        connection
        for connection in architecture.connections
        if inputs[connection.input].component in components
        or any(outputs[each].component in components for each in connection.outputs if each in outputs)
    )
    found = (flow for connection in near for flow in _of(architecture, connection))
    return [flow for flow in found if flow.tail in components or flow.head in components]


def _of(architecture: Architecture, connection: Connection) -> Iterable[Flow]:
    port = architecture.inputs[connection.input]
    outputs = [architecture.outputs[each] for each in connection.outputs if each in architecture.outputs]
    for producer in dict.fromkeys(output.component for output in outputs):
        mine = [output for output in outputs if output.component == producer]
        style = style_of(architecture, mine[0].id)
        calls = style in {"service", "action"}
        names = ", ".join(output.name for output in mine)
        types = tuple(dict.fromkeys(output.type for output in mine if output.type))
        yield Flow(
            connection,
            port.component if calls else producer,
            producer if calls else port.component,
            style,
            types,
            port.optional,
            f"{architecture.components[producer].title} · {names}"
            f"{' (' + ', '.join(types) + ')' if types else ''}"
            f" → {architecture.components[port.component].title} · {port.name}",
        )


def style_of(architecture: Architecture, output: str) -> Style:
    """Return the style of arrow for what an output carries."""
    found = architecture.outputs[output]
    if found.physical:
        return "physical"
    flow = flow_of(architecture.message(found))
    return "data" if flow == "topic" else flow


def merged(
    items: Iterable[Flow], ends: Callable[[Flow], tuple[str, str]], *, labels: bool, by_style: bool = True
) -> tuple[Arrow, ...]:
    """Merge flows with the same ends (and of the same style, if asked) into one arrow each."""
    bundles: dict[tuple[str, str, Style], list[Flow]] = {}
    for flow in items:
        tail, head = ends(flow)
        bundles.setdefault((tail, head, flow.style if by_style else "data"), []).append(flow)
    return tuple(
        Arrow(
            f"{tail}>{head}" + (f":{style}" if style != "data" else ""),
            tail,
            head,
            label=_label(bundle) if labels else "",
            style=style,
            count=len(bundle),
            optional=by_style and all(flow.optional for flow in bundle),
            flows=tuple(flow.sentence for flow in bundle),
        )
        for (tail, head, style), bundle in bundles.items()
    )


def _label(bundle: list[Flow]) -> str:
    """Return the types of a bundle, each on a line; of more than three the rest is counted."""
    names = list(dict.fromkeys(flow.label for flow in bundle if flow.label))
    return "\n".join(names) if len(names) <= 3 else "\n".join([*names[:2], f"and {len(names) - 2} more types"])  # noqa: PLR2004
