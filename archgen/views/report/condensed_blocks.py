"""Blocks that stand apart on a page of the site, put together for paper: facts in one list, ports in one table."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence

from archgen.frozen import replace
from archgen.model.component import Component
from archgen.model.node import Endpoint, Node, Qos
from archgen.model.port_media import ROS
from archgen.views import inline_text
from archgen.views.elements.functional_level import list_component_facts
from archgen.views.elements.implementation_level import list_node_facts, make_implementation_blocks, make_node_blocks
from archgen.views.elements.parameter_blocks import make_effective_table
from archgen.views.elements.port_tables import PortKind, list_port_cells
from archgen.views.lookup import Lookup
from archgen.views.shapes import (
    Block,
    Bullets,
    Column,
    Fact,
    FactRow,
    Facts,
    Figure,
    Inlines,
    Markdown,
    Paragraph,
    Table,
    Text,
    drop_column,
    drop_empty_columns,
    keep_columns,
    make_columns,
)

_MIN_CONSTANT_ROWS = 3
"""From this many rows on, a column that says the same in all of them is said once, in the caption."""
_PORT_COLUMNS = make_columns(
    ("Use", 0.3), ("Port", 1.1), ("Type", 1.2), ("From / to", 2.0), ("Inside", 1.4), ("Medium", 0.7), ("Remarks", 1.2)
)


def condense_component(lookup: Lookup, component: Component, blocks: Iterable[Block]) -> tuple[Block, ...]:
    """Put the blocks of a component together: text, facts, picture, one table of ports, what can be set and called."""
    texts: list[Block] = []
    figures: list[Block] = []
    rows: list[FactRow] = []
    last_tables: list[Block] = []
    pending_title = ""
    for block in blocks:
        match block:
            case Facts():
                rows += _list_printed_facts(lookup, component)
            case Figure():
                figures.append(block)
            case Table(kind="table:inputs" | "table:outputs"):
                pass
            case Table(kind="table:set" | "table:operations" | "table:components" as kind):
                is_inner = kind == "table:components"
                last_tables.append(drop_repeated_columns(drop_column(block, "nodes")) if is_inner else block)
            case Table():
                rows.append(("Performance", inline_text.join_lines(_phrase_row(block, row) for row in block.rows)))
            case Bullets():
                rows.append((pending_title, inline_text.join_lines(block.items)))
            case Paragraph() if len(block.inlines) == 1 and block.inlines[0].strong:
                pending_title = block.inlines[0].text
            case Paragraph() if (row := _read_fact(block)) is not None:
                rows.append(row)
            case _:
                texts.append(block)
    facts = [Facts(tuple(rows))] if rows else []
    return (*texts, *facts, *figures, *_make_port_tables(lookup, component), *last_tables)


def _read_fact(paragraph: Paragraph) -> FactRow | None:
    """Return a paragraph that begins with its title in bold as a fact: `Inputs`, "It has no inputs."."""
    first, *others = paragraph.inlines
    if not first.strong or not first.text.endswith(". "):
        return None
    return first.text.removesuffix(". "), tuple(others)


def _phrase_row(table: Table, row: Sequence[Inlines]) -> Inlines:
    """Write a row of a table as a phrase: `Response: 95 %, execution time 20 ms`."""
    name, *values = row
    parts = [
        inline_text.to_inlines(f"{column.title.lower()} ", *value)
        for column, value in zip(table.columns[1:], values, strict=True)
        if value and value != inline_text.UNKNOWN_INLINES
    ]
    return (*name, Text(": "), *inline_text.join_inlines(parts)) if parts else name


def _list_printed_facts(lookup: Lookup, component: Component) -> Iterator[FactRow]:
    """Yield the facts of a component; its group is the chapter that it stands in, and its role stands beside its owner."""
    facts = list(list_component_facts(lookup, component))
    role = next((fact.value for fact in facts if fact.key == "role"), ())
    for fact in facts:
        if fact.key == "owner" and role:
            yield "Owner, role", (*fact.value, Text(", "), *role)
        elif fact.key not in {"group", "role"}:
            yield print_fact(fact)


def print_fact(fact: Fact) -> FactRow:
    """Return a fact as paper has it: nothing shows there that links lead elsewhere, and hosts have links too."""
    return "See also" if fact.key == "links" else fact.title, fact.value


def _make_port_tables(lookup: Lookup, component: Component) -> Iterator[Table]:
    """Yield inputs and outputs as one table, if there are any. A medium is said only where it is not digital."""
    uses: tuple[tuple[str, PortKind], ...] = (("in", "input"), ("out", "output"))
    rows = tuple(
        (
            inline_text.to_inlines(use),
            port.name,
            port.type,
            port.ends,
            port.inside,
            () if _join_texts(port.medium) == "digital" else port.medium,
            port.remarks,
        )
        for use, kind in uses
        for port in list_port_cells(lookup, component, kind)
    )
    if rows:
        table = Table(f"table:ports/{component.id}", f"Ports of {component.title}", _PORT_COLUMNS, rows)
        yield drop_repeated_columns(table, kept_columns=4)


def drop_repeated_columns(table: Table, kept_columns: int = 1) -> Table:
    """Drop columns that are empty, and those that say the same in each of several rows, which the caption says instead.

    The first `kept_columns` stay, whatever they say.
    """
    remarks, kept_indices = [], []
    for index, column in enumerate(table.columns):
        texts = list(dict.fromkeys(_join_texts(row[index]) for row in table.rows))
        if index < kept_columns or ((len(texts) > 1 or len(table.rows) < _MIN_CONSTANT_ROWS) and texts != [""]):
            kept_indices.append(index)
        elif texts != [""]:
            remarks.append(f"{column.title} of all: {texts[0]}")
    return replace(keep_columns(table, kept_indices), caption="; ".join((table.caption, *remarks)))


def _join_texts(cell: Inlines) -> str:
    return "".join(part.text for part in cell)


_USE_WORDS = {"subscribes": "sub", "publishes": "pub", "serves": "serves", "calls": "calls"}
_USE_ORDER = tuple(_USE_WORDS)
_OWN_FACTS = {"implements", "ros_name", "kind"}
"""Keys of the facts that the first line of a node says."""


def make_ros_blocks(lookup: Lookup, component: Component) -> tuple[Block, ...]:
    """Describe the nodes of a component; one that implements several is described at the first that is shown."""
    all_nodes = lookup.nodes_of.get(component.id, ())
    own_nodes = [node for node in all_nodes if _find_described_component(lookup, node) == component.id]
    texts: list[Block] = []
    rows: list[FactRow] = []
    anchors: list[str | None] = []
    for node in all_nodes:
        if node not in own_nodes:
            rows.append(("Node", _refer_to_node(lookup, node)))
            anchors.append(None)
            continue
        node_blocks = make_node_blocks(lookup, node)
        texts += [
            block for block in node_blocks if isinstance(block, Markdown) or getattr(block, "kind", "text") == "note"
        ]
        node_rows = list(_condense_facts(node, component, list_node_facts(lookup, node)))
        rows += node_rows
        anchors += [f"node:{node.id}", *(None for _ in node_rows[1:])]
    table = _make_endpoint_table(lookup, component, own_nodes)
    silent_nodes = [node for node in own_nodes if not lookup.endpoints_of.get(node.id)]
    silence = [Text(f"{', '.join(node.id for node in silent_nodes)}: no topic, service or action.", muted=True)]
    return (
        *texts,
        *([Facts(tuple(rows), tuple(anchors))] if rows else []),
        *make_implementation_blocks(lookup, component.id),
        *([Paragraph(tuple(silence))] if silent_nodes else []),
        *([table] if table else []),
    )


def condense_node_facts(lookup: Lookup, node: Node, component: Component) -> Iterator[FactRow]:
    """Yield what a node of a component is, where it runs and how fast it works, in a row each."""
    rows = _condense_facts(node, component, list_node_facts(lookup, node))
    yield from (row for row in rows if row[0] in {"Node", "Package and host", "Timing"})


def _find_described_component(lookup: Lookup, node: Node) -> str | None:
    """Return the id of the component that a node is described at: the first shown one that it implements."""
    return next((name for name in node.implements if lookup.scope.shows_component(name)), None)


def _refer_to_node(lookup: Lookup, node: Node) -> Inlines:
    first = _find_described_component(lookup, node)
    place = (inline_text.component_link(lookup.architecture.components[first]),) if first else ()
    return inline_text.to_inlines(
        "The node ", inline_text.node_link(node), " implements this too; it is described at ", *place, "."
    )


def _condense_facts(node: Node, component: Component, facts: Sequence[Fact]) -> Iterator[FactRow]:
    """Yield the facts of a node: what it is in one row, where it runs with its package in a second, times in a third."""
    values = {fact.key: fact.value for fact in facts if fact.key in _OWN_FACTS}
    kind = values.get("kind", ())
    ros_name = (Text(", ROS name "), *values["ros_name"]) if "ros_name" in values else ()
    name = inline_text.to_inlines(Text(node.id, code=True, strong=True), *ros_name, ", ", *kind)
    others = [item for item in node.implements if item != component.id]
    if others:
        name = (*name, Text("; implements "), *values["implements"])
    yield "Node", name
    place_keys = {"package", "host", *(() if node.owners == component.owners else ("owner",))}
    if places := [fact for fact in facts if fact.key in place_keys]:
        yield "Package and host", _join_named(places)
    if times := [fact for fact in facts if fact.key in {"timing", "activity"}]:
        yield "Timing", _join_named(times)
    said_keys = {*_OWN_FACTS, "requirements", "package", "host", "owner", "timing", "activity"}
    yield from (print_fact(fact) for fact in facts if fact.key not in said_keys)


def _join_named(facts: Iterable[Fact]) -> Inlines:
    """Join facts with their names: `runs on Base Computer; owner SSSA`. A package and a timing need no name."""
    parts = [
        fact.value
        if fact.key in {"package", "timing"}
        else inline_text.to_inlines(f"{fact.title[:1].lower()}{fact.title[1:]} ", *fact.value)
        for fact in facts
    ]
    return inline_text.join_inlines(parts, "; ")


def _make_endpoint_table(lookup: Lookup, component: Component, nodes: Sequence[Node]) -> Table | None:
    rows = tuple(
        (
            inline_text.to_code(node.id),
            inline_text.to_inlines(_USE_WORDS[endpoint.use]),
            (*inline_text.name_carrier(endpoint), *([Text(" internal", muted=True)] if endpoint.internal else [])),
            _message_cell(endpoint),
            inline_text.to_code((endpoint.port or "").rpartition(".")[2]),
            _qos_cell(endpoint),
        )
        for node in nodes
        for endpoint in sorted(lookup.endpoints_of.get(node.id, ()), key=lambda each: _USE_ORDER.index(each.use))
    )
    columns = make_columns(("Node", 1.0), ("Use", 0.5), ("Name", 1.9), ("Message", 1.9), ("Port", 0.9), ("QoS", 0.6))
    caption = f"Topics, services and actions of {component.title}"
    table = Table(f"table:endpoints/{component.id}", caption, columns, rows)
    if len(nodes) == 1:
        table = Table(table.anchor, caption, columns[1:], tuple(row[1:] for row in rows))
    return drop_repeated_columns(table, kept_columns=3) if rows else None


def _message_cell(endpoint: Endpoint) -> Inlines:
    if endpoint.medium != ROS and endpoint.type:
        return inline_text.type_link(endpoint.type)
    return (
        inline_text.to_inlines(Text(shorten_message(endpoint.message), code=True))
        if endpoint.message
        else inline_text.UNKNOWN_INLINES
    )


def set_small(table: Table) -> Table:
    """Return a table in small type on an upright page, without a number: its title stands above it."""
    return replace(table, wide=False, numbered=False, dense=True)


def shorten_message(name: str) -> str:
    """Return a message's name without the folder that its use tells: `nav_msgs/Odometry` for `nav_msgs/msg/Odometry`."""
    package, _, rest = name.partition("/")
    folder, _, short_name = rest.partition("/")
    return f"{package}/{short_name}" if folder in {"msg", "srv", "action"} and short_name else name


def _qos_cell(endpoint: Endpoint) -> Inlines:
    if endpoint.flow != "topic" or endpoint.medium != ROS:
        return ()
    text = _shorten_qos(endpoint.qos)
    return (Text(text, muted=not endpoint.qos.written),)


def _shorten_qos(qos: Qos) -> str:
    """Write a quality of service in short: `R 10` is reliable with depth 10, `BE` best effort, `TL` transient local."""
    reliability = (
        "BE" if qos.reliability == "best_effort" else "R" if qos.reliability == "reliable" else qos.reliability
    )
    depth = "all" if qos.history == "keep_all" else "" if qos.depth is None else str(qos.depth)
    parts = [" ".join(part for part in (reliability, depth) if part)]
    parts += ["TL"] if qos.durability == "transient_local" else []
    parts += [f"D {qos.deadline}"] if qos.deadline else []
    parts += [f"L {qos.lifespan}"] if qos.lifespan else []
    parts += ["M"] if qos.liveliness != "automatic" else []
    parts += [f"lease {qos.lease_duration}"] if qos.lease_duration else []
    return " · ".join(parts)


def make_parameter_table(lookup: Lookup) -> Table | None:
    """List the parameters of all shown nodes."""
    rows: list[tuple[Inlines, ...]] = []
    for node in lookup.shown_nodes():
        if table := make_effective_table(lookup, node):
            name: Inlines = (Text(node.id, ref=f"node:{node.id}", code=True),)
            rows += [(name, *row, *(((),) if len(row) == 2 else ())) for row in table.rows]  # noqa: PLR2004
    columns = (Column("Node"), Column("Parameter"), Column("Value"), Column("From"))
    if not rows:
        return None
    return drop_empty_columns(Table("table:parameters", "Parameters of the nodes", columns, tuple(rows)))
