"""Draw one component at the functional level: its ports as rows, where each comes from and goes to.

Arrows end at the port. A type is written once for all arrows out of an output. A whole component or group as source is
one box with an asterisk on its arrow. Partners outside of the architecture are dashed.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

from archgen.model.architecture import Architecture
from archgen.model.component import Component, Connection, Input, Output
from archgen.model.mapping import flow_of
from archgen.views.graphs import boxes
from archgen.views.graphs.legend import with_legend
from archgen.views.index import Index
from archgen.views.shapes import Arrow, Box, Graph
from archgen.views.words import plural, short_timing

Drawn = tuple[Box, Arrow]
MANY = 40
"""With more neighbours they are folded by group."""


def component(view: Index, name: str) -> Graph:
    """Draw one component with its ports and neighbours."""
    item = view.architecture.components[name]
    drawn = [*_into(view, item), *_out_of(view, item)]
    folded = len({box.id for box, _ in drawn}) > MANY
    if folded:
        drawn = _folded(view, drawn)
    neighbours = {box.id: box for box, _ in drawn}
    arrows = tuple(arrow for _, arrow in drawn)
    graph = Graph(
        f"components/{name}",
        item.title,
        "flow",
        (_subject(view, item), *neighbours.values()),
        arrows,
        direction="left-right",
        notes=("Neighbours are folded: a box for each group.",) if folded else (),
        alt=_alt(item, [box.title for box in neighbours.values()]),
        asked=sum(arrow.count for arrow in arrows),
    )
    return with_legend(graph)


def _subject(view: Index, item: Component) -> Box:
    said = (item.role or "", boxes.owners(view, item.owners), short_timing(item.timing))
    box = boxes.component(view, item, lines=tuple(x for x in (" · ".join(word for word in said if word),) if x))
    return replace(
        box,
        emphasis="subject",
        cluster=None,
        style="component",
        ports_in=tuple((f"in {port.name}", port.name) for port in item.inputs.values()),
        ports_out=tuple((f"out {port.name}", port.name) for port in item.outputs.values()),
    )


def _into(view: Index, item: Component) -> Iterator[Drawn]:
    for port in item.inputs.values():
        if port.external is not None:
            yield _external(port, item, "left")
        for connection in port.connections:
            yield _fed(view, item, port, connection)


def _fed(view: Index, item: Component, port: Input, connection: Connection) -> Drawn:
    architecture = view.architecture
    outputs = [architecture.outputs[each] for each in connection.outputs]
    types = list(dict.fromkeys(output.type for output in outputs if output.type))
    if connection.kind == "group":
        whole = boxes.whole_group(view, connection.target)
        box = replace(whole, id=f"<{whole.id}", emphasis="neighbour", side="left", lines=("whole group", *types[:6]))
    else:
        producer = architecture.components[_component(connection.target)]
        box = boxes.neighbour(view, producer, "left")
        # `<` and `>` before an id: a neighbour that feeds and reads is two boxes, one at each side, so nothing runs
        # backwards.
        box = replace(box, id=f"<{box.id}")
    star = connection.kind != "output"
    label = (
        f"* {plural(len(types), 'type')}" if star and len(types) != 1 else f"{'* ' * star}{types[0] if types else ''}"
    )
    style = style_of(architecture, outputs[0]) if outputs else "data"
    arrow = Arrow(
        f"{connection.target}>{port.id}",
        box.id,
        item.id,
        label,
        head_port=f"in {port.name}",
        style=style,  # type: ignore[arg-type]
        optional=port.optional,
        flows=tuple(
            f"{architecture.components[output.component].title} · {output.name} → {port.name}" for output in outputs
        ),
        ref=f"type:{types[0]}" if len(types) == 1 else None,
    )
    return box, _directed(arrow)


def _out_of(view: Index, item: Component) -> Iterator[Drawn]:
    for output in item.outputs.values():
        style = style_of(view.architecture, output)
        label = output.type or ""
        if output.external is not None:
            yield _external(output, item, "right")
            label = ""
        for connection in view.readers.get(output.id, ()):
            reader = view.architecture.components[_component(connection.input)]
            box = replace(boxes.neighbour(view, reader, "right"), id=f">{reader.id}")
            arrow = Arrow(
                f"{output.id}>{connection.input}",
                item.id,
                box.id,
                label,
                tail_port=f"out {output.name}",
                style=style,  # type: ignore[arg-type]
                optional=view.architecture.inputs[connection.input].optional,
                flows=(f"{output.name} → {reader.title} · {connection.input.rsplit('.', 1)[1]}",),
                ref=f"type:{output.type}" if output.type else None,
            )
            # The type is written beside the first arrow only; the next ones out of the same output have no label.
            yield box, _directed(arrow)
            label = ""


def _directed(arrow: Arrow) -> Arrow:
    """Reverse a service or action: from the client, which has it as an input, to the server."""
    if arrow.style not in {"service", "action"}:
        return arrow
    ends = {"tail": arrow.head, "head": arrow.tail, "tail_port": arrow.head_port, "head_port": arrow.tail_port}
    return replace(arrow, **ends)  # type: ignore[arg-type]


def _external(port: Input | Output, item: Component, side: str) -> Drawn:
    left = side == "left"
    box = Box(
        f"external {side} {port.id}",
        port.external or "outside",
        style="physical" if port.physical else "external",
        emphasis="normal",
        side="left" if left else "right",
        tooltip=f"{port.external}\noutside the architecture",
    )
    arrow = Arrow(
        f"external {side} {port.id}",
        box.id if left else item.id,
        item.id if left else box.id,
        port.type or "",
        tail_port=None if left else f"out {port.name}",
        head_port=f"in {port.name}" if left else None,
        style="physical" if port.physical else "data",
        flows=(f"{port.external} → {port.name}" if left else f"{port.name} → {port.external}",),
    )
    return box, arrow


def _folded(view: Index, drawn: list[Drawn]) -> list[Drawn]:
    """Fold the neighbours of one group at one side into one box."""
    folded = []
    for box, arrow in drawn:
        group = box.id[1:].split(".", 1)[0]
        # Only neighbours have the sign; boxes outside of the architecture stay single.
        if box.id[0] not in "<>" or group not in view.architecture.groups:
            folded.append((box, arrow))
            continue
        name = f"{box.id[0]}{group}"
        whole = replace(boxes.whole_group(view, group), id=name, emphasis="neighbour", side=box.side, style="fold")
        ends = {"tail": name} if arrow.tail == box.id else {"head": name}
        folded.append((whole, replace(arrow, **ends)))  # type: ignore[arg-type]
    return folded


def style_of(architecture: Architecture, output: Output) -> str:
    """Return the style of arrow for what an output carries."""
    if output.physical:
        return "physical"
    flow = flow_of(architecture.message(output))
    return "data" if flow == "topic" else flow


def _component(port: str) -> str:
    return ".".join(port.split(".")[:2])


def _alt(item: Component, neighbours: list[str]) -> str:
    said = f"{item.title} with {plural(len(item.inputs), 'input')} and {plural(len(item.outputs), 'output')}."
    return said + (f" It exchanges data with {', '.join(dict.fromkeys(neighbours))}." if neighbours else "")
