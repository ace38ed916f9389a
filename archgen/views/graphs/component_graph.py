"""Draw one component at the functional level: its ports as rows, where each comes from and goes to.

Everything runs from left to right: at the left stand the inputs, and the services and actions that it offers, with
their callers; at the right the outputs, and the services and actions that it calls, with their servers.
Arrows end at the port. A type is written once for all arrows out of an output. A whole group as source is one box that
lists its types, with an asterisk on its arrow. Partners outside of the architecture are dashed.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Literal

from archgen.diagnostics import fit_lines
from archgen.frozen import replace
from archgen.model.component import Component, Connection, Input, Output
from archgen.model.component_nesting import find_component
from archgen.model.port_media import is_physical
from archgen.views.graphs import element_boxes
from archgen.views.graphs.drawn_level import (
    add_notes,
    flow_style,
    join_type_names,
    name_media,
    port_style,
    warn_of_outputs,
)
from archgen.views.graphs.graph_folding import add_legend_keys, merge_arrows
from archgen.views.inline_text import count_noun
from archgen.views.lookup import Lookup
from archgen.views.picture_shapes import Arrow, Box, Graph
from archgen.views.timing_words import format_short_timing

DrawnNeighbour = tuple[Box, Arrow]
_CALLS = {"service", "action"}
_SIGNS = {"left": "<", "right": ">"}
"""What stands before the id of a neighbour's box: one that feeds and reads is two boxes, one at each side."""
_MAX_GROUP_TYPES = 12
"""How many types the box of a whole group lists."""
MAX_NEIGHBOURS = 40
"""With more neighbours they are folded by group."""
_MAX_ARROWS = 80
"""With more flows there is one arrow for each neighbour, and ports are counted."""


def draw_component(lookup: Lookup, component_id: str) -> Graph:
    """Draw one component with its ports and neighbours."""
    component = lookup.architecture.components[component_id]
    drawn = [*_draw_inputs(lookup, component), *_draw_outputs(lookup, component)]
    is_folded = len({box.id for box, _ in drawn}) > MAX_NEIGHBOURS
    if is_folded:
        drawn = _fold_neighbours(lookup, drawn)
    neighbours = {box.id: box for box, _ in drawn}
    arrows = tuple(arrow for _, arrow in drawn)
    subject = _subject_box(lookup, component)
    is_merged = len(arrows) > _MAX_ARROWS
    if is_merged:
        ports = [
            count_noun(len(each), noun)
            for each, noun in ((component.inputs, "input"), (component.outputs, "output"))
            if each
        ]
        subject = replace(subject, ports_in=(), ports_out=(), lines=(*subject.lines, " and ".join(ports)))
        ends = {arrow.tail: arrow.tail for arrow in arrows} | {arrow.head: arrow.head for arrow in arrows}
        arrows = tuple(
            replace(arrow, label=count_noun(arrow.count, "flow"), tail_port=None, head_port=None)
            for arrow in merge_arrows(list(arrows), ends)
        )
    graph = Graph(
        f"components/{component_id}",
        component.title,
        "flow",
        (subject, *neighbours.values()),
        arrows,
        direction=component.layout.direction or lookup.architecture.layout.direction,
        notes=(
            *(("Neighbours are folded: a box for each group.",) if is_folded else ()),
            *(("Ports are counted: the tables have them.",) if is_merged else ()),
        ),
        alt=_describe_component(component, [box.title for box in neighbours.values()]),
        asked=sum(arrow.count for arrow in arrows),
        kind="component",
    )
    return add_legend_keys(graph)


def _subject_box(lookup: Lookup, component: Component) -> Box:
    summary_words = (
        component.role or "",
        element_boxes.join_owner_titles(lookup, component.owners),
        format_short_timing(component.timing),
    )
    box = element_boxes.component_box(
        lookup, component, lines=tuple(x for x in (" · ".join(word for word in summary_words if word),) if x)
    )
    return replace(
        box,
        emphasis="subject",
        cluster=None,
        style="component",
        ports_in=(
            *(_port_row(port) for port in component.inputs.values() if not _is_call(lookup, port)),
            *(_port_row(port) for port in component.outputs.values() if _is_call(lookup, port)),
        ),
        ports_out=(
            *(_port_row(port) for port in component.outputs.values() if not _is_call(lookup, port)),
            *(_port_row(port) for port in component.inputs.values() if _is_call(lookup, port)),
        ),
    )


def _port_row(port: Input | Output) -> tuple[str, str]:
    return port_key(port), port.name


def port_key(port: Input | Output) -> str:
    """Return what tells a port from the others of its component: an input and an output may have one name.

    With a blank, so that it is no component's id.
    """
    return f"{'in' if isinstance(port, Input) else 'out'} {port.name}"


def _is_call(lookup: Lookup, port: Input | Output) -> bool:
    """Return whether a port is a service or an action: an output offers it, an input calls it."""
    sources = [output for each in port.connections for output in each.outputs] if isinstance(port, Input) else []
    styles = {flow_style(lookup.architecture, each) for each in sources} or {port_style(lookup.architecture, port)}
    return styles <= _CALLS


def _port_side(lookup: Lookup, port: Input | Output) -> Literal["left", "right"]:
    """Return the side of a port: what comes in and who calls is at the left, what goes out and who is called at the
    right.
    """
    return "left" if isinstance(port, Input) != _is_call(lookup, port) else "right"


def _draw_inputs(lookup: Lookup, component: Component) -> Iterator[DrawnNeighbour]:
    for port in component.inputs.values():
        if port.external is not None:
            yield _draw_external(lookup, port, component)
        for connection in port.connections:
            yield _draw_connection(lookup, component, port, connection)


def _draw_connection(lookup: Lookup, component: Component, port: Input, connection: Connection) -> DrawnNeighbour:
    architecture = lookup.architecture
    outputs = [architecture.outputs[each] for each in connection.outputs]
    types = list(dict.fromkeys(output.type for output in outputs if output.type))
    style = flow_style(architecture, outputs[0].id) if outputs else "data"
    medium = name_media((port, *outputs))
    side = _port_side(lookup, port)
    if connection.kind == "group":
        group_box = element_boxes.group_box(lookup, connection.target)
        lines = ("whole group", *fit_lines(types, _MAX_GROUP_TYPES))
        box = replace(group_box, emphasis="neighbour", side=side, lines=lines)
        label = "* all of these" if types else "*"
    else:
        producer = find_component(architecture, _component_of_target(lookup, connection))
        box = element_boxes.neighbour_box(lookup, producer, side)
        label = join_type_names(types)
    box = replace(box, id=f"{_SIGNS[side]}{box.id}")
    arrow = Arrow(
        f"{connection.target}>{port.id}",
        box.id,
        component.id,
        add_notes(label, medium, warn_of_outputs(lookup, outputs)),
        head_port=f"in {port.name}",
        style=style,
        optional=port.optional,
        flows=tuple(
            f"{architecture.components[output.component].title} · {output.name} → {port.name}" for output in outputs
        ),
        ref=f"type:{types[0]}" if len(types) == 1 else None,
        is_made=connection.is_made,
        medium=medium,
    )
    return box, _point_to_server(arrow)


def _draw_outputs(lookup: Lookup, component: Component) -> Iterator[DrawnNeighbour]:
    for output in component.outputs.values():
        style = flow_style(lookup.architecture, output.id)
        label = add_notes(output.type or "", name_media((output,)), warn_of_outputs(lookup, (output,)))
        if output.external is not None:
            yield _draw_external(lookup, output, component)
            label = ""
        for connection in lookup.readers_of.get(output.id, ()):
            reader = lookup.architecture.components[lookup.architecture.inputs[connection.input].component]
            side = _port_side(lookup, output)
            box = replace(element_boxes.neighbour_box(lookup, reader, side), id=f"{_SIGNS[side]}{reader.id}")
            arrow = Arrow(
                f"{output.id}>{connection.input}",
                component.id,
                box.id,
                label,
                tail_port=f"out {output.name}",
                style=style,
                optional=lookup.architecture.inputs[connection.input].optional,
                flows=(f"{output.name} → {reader.title} · {connection.input.rsplit('.', 1)[1]}",),
                ref=f"type:{output.type}" if output.type else None,
                is_made=connection.is_made,
                medium=name_media((output,)),
            )
            # The type is written beside the first arrow only; the next ones out of the same output have no label.
            yield box, _point_to_server(arrow)
            label = ""


def _point_to_server(arrow: Arrow) -> Arrow:
    """Reverse a service or action: from the client, which has it as an input, to the server."""
    if arrow.style not in {"service", "action"}:
        return arrow
    ends = {"tail": arrow.head, "head": arrow.tail, "tail_port": arrow.head_port, "head_port": arrow.tail_port}
    return replace(arrow, **ends)  # type: ignore[arg-type]


def _draw_external(lookup: Lookup, port: Input | Output, component: Component) -> DrawnNeighbour:
    """Draw a partner outside of the architecture, at the side of the port."""
    side = _port_side(lookup, port)
    box = Box(
        f"external {side} {port.id}",
        port.external or "outside",
        style="physical" if is_physical(port) else "external",
        emphasis="normal",
        side=side,
        tooltip=f"{port.external}\noutside the architecture",
    )
    ends = (box.id, component.id) if side == "left" else (component.id, box.id)
    key = port_key(port)
    arrow = Arrow(
        f"external {side} {port.id}",
        *ends,
        port.type or "",
        tail_port=key if side == "right" else None,
        head_port=key if side == "left" else None,
        style=port_style(lookup.architecture, port),
        flows=(f"{port.external} → {port.name}" if side == "left" else f"{port.name} → {port.external}",),
    )
    return box, arrow


def _fold_neighbours(lookup: Lookup, drawn: list[DrawnNeighbour]) -> list[DrawnNeighbour]:
    """Fold the neighbours of one group at one side into one box."""
    folded = []
    for box, arrow in drawn:
        group = box.id[1:].split(".", 1)[0]
        # Only neighbours have the sign; boxes outside of the architecture stay single.
        if box.id[0] not in "<>" or group not in lookup.architecture.groups:
            folded.append((box, arrow))
            continue
        name = f"{box.id[0]}{group}"
        group_box = replace(
            element_boxes.group_box(lookup, group), id=name, emphasis="neighbour", side=box.side, style="fold"
        )
        ends = {"tail": name} if arrow.tail == box.id else {"head": name}
        folded.append((group_box, replace(arrow, **ends)))  # type: ignore[arg-type]
    return folded


def _component_of_target(lookup: Lookup, connection: Connection) -> str:
    output = lookup.architecture.outputs.get(connection.target) if connection.kind == "output" else None
    return output.component if output else connection.target


def _describe_component(component: Component, neighbours: list[str]) -> str:
    sentence = f"{component.title} with {count_noun(len(component.inputs), 'input')} and {count_noun(len(component.outputs), 'output')}."
    return sentence + (f" It exchanges data with {', '.join(dict.fromkeys(neighbours))}." if neighbours else "")
