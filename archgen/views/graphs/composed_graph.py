"""Draw a composed component open: its own ports at the rim of a frame, its components inside, inner composed ones closed.

What is outside is said at the ports. Only who is joined past them has a box outside of the frame.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable, Iterator
from typing import Literal

from archgen.diagnostics import fit_lines
from archgen.frozen import dataclass, replace
from archgen.model.architecture import Architecture
from archgen.model.component import Component, Connection, Input, Output
from archgen.model.component_nesting import find_component, find_passed_shell, list_surrounding
from archgen.views.graphs import element_boxes
from archgen.views.graphs.component_graph import port_key
from archgen.views.graphs.drawn_level import ComponentFlow, DrawnLevel, FlowStyle, flow_style, merge_flows, port_style
from archgen.views.graphs.graph_folding import MAX_ARROWS, MAX_BOXES, add_legend_keys, fold_graph
from archgen.views.inline_text import count_noun
from archgen.views.lookup import Lookup
from archgen.views.picture_shapes import Arrow, Box, Cluster, Graph


def draw_to_depth(architecture: Architecture, draw: Callable[[int], Graph], depth: int) -> Graph:
    """Draw with composed components open to a depth, or less deep where the picture would be too large."""
    deepest = max((len(list_surrounding(architecture, shell)) + 1 for shell in architecture.shells), default=0)
    wanted_depth = min(depth, deepest)
    for each in range(wanted_depth, 0, -1):
        graph = draw(each)
        if len(graph.boxes) <= MAX_BOXES and len(graph.arrows) <= MAX_ARROWS:
            return graph if each == wanted_depth else _note_depth(graph, f"only {count_noun(each, 'level')} deep")
    graph = draw(0)
    return _note_depth(graph, "closed") if wanted_depth else graph


def _note_depth(graph: Graph, words: str) -> Graph:
    note = (
        f"Components of components are {words} here: with more of them open the picture would be larger than "
        f"{MAX_BOXES} boxes and {MAX_ARROWS} arrows."
    )
    return replace(graph, notes=(*graph.notes, note))


def list_opened(architecture: Architecture, box_ids: Iterable[str], depth: int) -> frozenset[str]:
    """Return the composed components that are open where those among some boxes are opened so many levels deep."""
    opened: set[str] = set()
    closed_ids = [box_id for box_id in box_ids if box_id in architecture.shells]
    for _ in range(depth):
        opened.update(closed_ids)
        children = (child for shell in closed_ids for child in architecture.shells[shell].children)
        closed_ids = [child for child in children if child in architecture.shells]
    return frozenset(opened)


def find_drawn(architecture: Architecture, component_id: str, opened: Collection[str]) -> Component:
    """Return what a box in a picture shows: of an open component, what of it is not designed yet."""
    if component_id in opened:
        return replace(architecture.components[component_id], title="Not designed yet")
    return find_component(architecture, component_id)


def place_in_frames(
    lookup: Lookup, boxes: Iterable[Box], opened: Collection[str], outer: str | None
) -> tuple[tuple[Box, ...], tuple[Cluster, ...]]:
    """Set boxes of components into the frames of the open components around them, and these into `outer`."""
    placed_boxes, clusters = [], dict[str, Cluster]()
    for box in boxes:
        parent = outer
        own_frame = (box.id,) if box.id in opened else ()
        for shell_id in (*list_surrounding(lookup.architecture, box.id), *own_frame):
            if shell_id in opened:
                frame_id = f"open {shell_id}"
                clusters.setdefault(frame_id, _make_frame(lookup, shell_id, frame_id, parent))
                parent = frame_id
        placed_boxes.append(replace(box, cluster=parent))
    return tuple(placed_boxes), tuple(clusters.values())


def _make_frame(lookup: Lookup, shell_id: str, frame_id: str, parent: str | None) -> Cluster:
    shell = lookup.architecture.shells[shell_id]
    return Cluster(
        frame_id,
        shell.title,
        element_boxes.type_lines(lookup, shell),
        colour=element_boxes.group_hue(lookup, shell.group),
        parent=parent,
        ref=f"component:{shell_id}",
        tooltip=f"{shell.title} ({shell_id})",
    )


_CALLS = {"service", "action"}
_MAX_NAMES = 4
"""How many lines a port at the rim has for the components outside; where there are more, the last one counts them."""


def draw_composed(lookup: Lookup, shell_id: str, depth: int = 0) -> Graph:
    """Draw a composed component open, and those inside of it to a depth."""
    shell = lookup.architecture.shells[shell_id]

    def draw_opened(each: int) -> Graph:
        return _ComposedDrawing(lookup, shell, list_opened(lookup.architecture, shell.children, each)).draw()

    return draw_to_depth(lookup.architecture, draw_opened, depth)


@dataclass(frozen=True, slots=True)
class _ComposedDrawing:
    lookup: Lookup
    shell: Component
    opened: frozenset[str] = frozenset()
    """What is open inside of it."""

    @property
    def level(self) -> DrawnLevel:
        """What is drawn inside: this component and all around it are open."""
        around = list_surrounding(self.lookup.architecture, self.shell.id)
        return DrawnLevel(self.lookup, self.opened.union((*around, self.shell.id)))

    @property
    def own_ids(self) -> tuple[str, ...]:
        """What has a box inside, by complete ids."""
        if not self.opened:
            return self.shell.children
        leaves = self.lookup.architecture.leaves_of(self.shell.id)
        return tuple(dict.fromkeys(self.level.find_box(leaf) for leaf in leaves if leaf != self.shell.id))

    def draw(self) -> Graph:
        shell, lookup = self.shell, self.lookup
        own_ids = set(self.own_ids)
        children, frames = place_in_frames(lookup, self._draw_children(), self.opened, shell.id)
        flows = [flow for flow in self.level.list_flows_at(own_ids) if not self._passes_rim(flow)]
        inner_flows = [flow for flow in flows if flow.tail in own_ids and flow.head in own_ids]
        outer_flows = [flow for flow in flows if flow.tail not in own_ids or flow.head not in own_ids]
        hue = element_boxes.group_hue(lookup, shell.group)
        arrows = (
            *(
                replace(arrow, colour=hue)
                for arrow in merge_flows(inner_flows, lambda flow: (flow.tail, flow.head), labels=True)
            ),
            *self._draw_rim_arrows(),
            *merge_flows(outer_flows, self._place_ends, labels=True),
        )
        graph = Graph(
            f"composed/{shell.id}",
            shell.title,
            "group",
            (*children, *self._draw_ports(), *self._draw_neighbours(outer_flows)),
            arrows,
            (
                Cluster(
                    shell.id,
                    shell.title,
                    element_boxes.type_lines(lookup, shell),
                    colour=hue,
                    emphasis="subject",
                    ref=f"component:{shell.id}",
                    tooltip=f"{shell.title} ({shell.id})",
                ),
                *frames,
            ),
            direction=shell.layout.direction or lookup.architecture.layout.direction,
            alt=self._describe(len(inner_flows)),
            asked=sum(arrow.count for arrow in arrows),
            kind="composed",
        )
        return fold_graph(add_legend_keys(graph))

    def _passes_rim(self, flow: ComponentFlow) -> bool:
        """Whether a flow comes in or goes out through a port of this component: the ports have arrows of their own."""
        connection, own_ids = flow.connection, self.own_ids
        if flow.tail in own_ids and flow.head in own_ids:
            return False
        reader = connection.input.rpartition(".")[0]
        if self.level.find_box(reader) in own_ids:
            return self._comes_through_rim(reader, connection)
        port_id = connection.shell_port
        return port_id is not None and not f"{port_id}.".startswith(tuple(f"{each}." for each in self.shell.children))

    def _comes_through_rim(self, reader: str, connection: Connection) -> bool:
        """Whether a connection comes through an input of this component, through those of open ones on the way to it."""
        passed_id = find_passed_shell(self.lookup.architecture, reader, connection)
        if passed_id is None or passed_id == self.shell.id:
            return passed_id is not None
        name = (connection.shell_port or "").rpartition(".")[2]
        port = self.lookup.architecture.shells[passed_id].inputs[name]
        return any(self._comes_through_rim(passed_id, outer) for outer in port.connections)

    def _place_ends(self, flow: ComponentFlow) -> tuple[str, str]:
        own_ids = self.own_ids
        return (
            flow.tail if flow.tail in own_ids else f"<{flow.tail}",
            flow.head if flow.head in own_ids else f">{flow.head}",
        )

    def _draw_children(self) -> Iterator[Box]:
        for name in self.own_ids:
            component = find_drawn(self.lookup.architecture, name, self.opened)
            lines = element_boxes.type_lines(self.lookup, component)
            box = element_boxes.component_box(self.lookup, component, lines=lines)
            # Without a hue: the frame has it.
            yield replace(box, colour=None)

    def _draw_neighbours(self, flows: Iterable[ComponentFlow]) -> Iterator[Box]:
        ends = (end for flow in flows for end in self._place_ends(flow))
        for box_id in dict.fromkeys(end for end in ends if end not in self.own_ids):
            side: Literal["left", "right"] = "left" if box_id[0] == "<" else "right"
            component = self.level.find_component(box_id[1:])
            yield replace(element_boxes.neighbour_box(self.lookup, component, side), id=box_id)

    def _list_ports(self) -> tuple[Input | Output, ...]:
        return (*self.shell.inputs.values(), *self.shell.outputs.values())

    def _draw_ports(self) -> Iterator[Box]:
        """Yield the ports at the rim: what comes in and who calls at the left, what goes out and who is called at the right."""
        for port in self._list_ports():
            is_left = isinstance(port, Input) != (self._find_style(port) in _CALLS)
            names = self._list_outside(port)
            use, word = ("input", "from") if isinstance(port, Input) else ("output", "to")
            yield Box(
                port_key(port),
                port.name,
                (*self._list_types(port), *(f"{word} {name}" for name in fit_lines(names, _MAX_NAMES, "{} more"))),
                style="port",
                side="left" if is_left else "right",
                ref=f"component:{self.shell.id}",
                tooltip="\n".join((f"{use} {port.name} of {self.shell.title}", *names)),
            )

    def _list_outside(self, port: Input | Output) -> list[str]:
        """Return the titles of who is at the other end of a port, outside of this component."""
        outside = DrawnLevel(self.lookup, frozenset(list_surrounding(self.lookup.architecture, self.shell.id)))
        names: list[str] = []
        for flow in outside.list_flows_at({self.shell.id}):
            given = (flow.connection.shell_port, *flow.connection.outputs)
            is_here = port.id in ((flow.connection.input,) if isinstance(port, Input) else given)
            is_reader = flow.connection.input.startswith(f"{self.shell.id}.")
            if is_here and is_reader == isinstance(port, Input):
                names.append(outside.find_component(flow.head if flow.tail == self.shell.id else flow.tail).title)
        return list(dict.fromkeys([*names, *([port.external] if port.external else [])]))

    def _draw_rim_arrows(self) -> Iterator[Arrow]:
        """Yield the arrows between the ports at the rim and what stands behind them; two of the same ends are one."""
        arrows: dict[str, Arrow] = {}
        for port in self._list_ports():
            kind = "input" if isinstance(port, Input) else "output"
            for inner_id in self._list_behind(kind, port.id):
                arrow = self._draw_rim_arrow(port, inner_id)
                if arrow is None:
                    continue
                known = arrows.get(arrow.id)
                arrows[arrow.id] = (
                    replace(
                        known,
                        flows=(*known.flows, *arrow.flows),
                        count=known.count + 1,
                        is_made=known.is_made and arrow.is_made,
                        optional=known.optional and arrow.optional,
                    )
                    if known
                    else arrow
                )
        yield from arrows.values()

    def _list_behind(self, kind: str, port_id: str) -> Iterator[str]:
        """Yield the ports that stand behind one, of what has a box here."""
        for inner_id in self.lookup.architecture.shell_ports.get(f"{kind} {port_id}", ()):
            behind = self._list_behind(kind, inner_id) if inner_id.rpartition(".")[0] in self.opened else ()
            yield from tuple(behind) or (inner_id,)

    def _draw_rim_arrow(self, port: Input | Output, inner_id: str) -> Arrow | None:
        """Return the arrow between a port and one that stands behind it; None where the input's port has it already."""
        holder, _, name = inner_id.rpartition(".")
        inner = find_drawn(self.lookup.architecture, holder, self.opened)
        style, box_id = self._find_style(port), port_key(port)
        if holder == self.shell.id:
            if isinstance(port, Output):
                return None
            # What comes in goes out again.
            other, is_made, optional = port_key(inner.outputs[name]), inner.outputs[name].is_made, False
        elif isinstance(port, Output):
            other, is_made, optional = holder, port.is_made, False
        else:
            reader = inner.inputs.get(name)
            made = [each.is_made for each in reader.connections if each.shell_port == port.id] if reader else []
            other, is_made, optional = holder, bool(made) and all(made), bool(reader and reader.optional)
        runs_in = isinstance(port, Input) != (style in _CALLS)
        tail, head = (box_id, other) if runs_in else (other, box_id)
        types = self._list_types(port)
        ends = port.name, f"{inner.title} · {name}"
        return Arrow(
            f"{tail}>{head}" + (f":{style}" if style != "data" else ""),
            tail,
            head,
            # Without a label: the port names its type once, and has an arrow for each that stands behind it.
            style=style,
            optional=optional,
            flows=(" → ".join(ends if isinstance(port, Input) else reversed(ends)),),
            ref=f"type:{types[0]}" if len(types) == 1 else None,
            is_made=is_made,
        )

    def _list_types(self, port: Input | Output) -> list[str]:
        if isinstance(port, Output) or not port.connections:
            return [port.type] if port.type else []
        outputs = self.lookup.architecture.outputs
        types = dict.fromkeys(
            outputs[name].type for each in port.connections for name in each.outputs if name in outputs
        )
        return [name for name in types if name]

    def _find_style(self, port: Input | Output) -> FlowStyle:
        architecture = self.lookup.architecture
        sources = [name for each in port.connections for name in each.outputs] if isinstance(port, Input) else []
        known = [name for name in sources if name in architecture.outputs]
        return flow_style(architecture, known[0]) if known else port_style(architecture, port)

    def _describe(self, inner_flows: int) -> str:
        shell = self.shell
        counts = (
            f"{count_noun(len(shell.children), 'component')} inside and {count_noun(inner_flows, 'flow')} among them"
        )
        ports = f"{count_noun(len(shell.inputs), 'input')} and {count_noun(len(shell.outputs), 'output')}"
        return f"{shell.title} with {counts}; it has {ports}."
