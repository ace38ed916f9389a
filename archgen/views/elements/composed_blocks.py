"""Composed components in documents: their ports with what stands behind each, and what is inside."""

from __future__ import annotations

from collections.abc import Iterable

from archgen.model.component import Component, Input, Output
from archgen.model.component_nesting import find_component
from archgen.views import inline_text
from archgen.views.elements import functional_level, port_tables, promise_words
from archgen.views.elements.annotation_facts import make_image_blocks
from archgen.views.elements.parameter_blocks import make_parameter_blocks
from archgen.views.lookup import Lookup
from archgen.views.shapes import (
    Block,
    Column,
    Facts,
    Figure,
    Inlines,
    Markdown,
    Paragraph,
    Table,
    Text,
    drop_empty_columns,
)


def make_composed_blocks(lookup: Lookup, shell: Component, *, with_texts: bool = True) -> tuple[Block, ...]:
    """Describe a composed component: facts, what it does, its picture, its ports, and the components directly inside."""
    blocks: list[Block] = [Facts(tuple(functional_level.list_component_facts(lookup, shell)))]
    if with_texts:
        blocks.append(functional_level.make_functionality_block(shell))
        blocks += make_image_blocks(lookup, shell)
        blocks += [Markdown(shell.description)] if shell.description else []
    blocks.append(
        Figure(
            f"figure:composed/{shell.id}",
            f"composed/{shell.id}",
            f"{shell.title}: what is inside",
            f"{shell.title} as a frame with its ports at the rim and its components inside.",
        )
    )
    blocks += functional_level.make_requirement_blocks(lookup, shell) if shell.requirements else []
    blocks += functional_level.make_performance_blocks(shell) if shell.performance else []
    blocks += _make_port_blocks(lookup, shell)
    blocks += make_parameter_blocks(shell)
    children = lookup.shown_children(shell)
    if children:
        caption = f"Components of {shell.title}"
        blocks.append(functional_level.make_component_table(lookup, f"table:components/{shell.id}", caption, children))
    return tuple(blocks)


def _make_port_blocks(lookup: Lookup, shell: Component) -> Iterable[Block]:
    yield _make_port_block(
        (shell, "input", shell.inputs_known),
        (Column("Input"), Column("From", 1.6), Column("Type", 1.2), Column("Read inside by", 1.6)),
        [_list_input_cells(lookup, port) for port in shell.inputs.values()],
    )
    yield _make_port_block(
        (shell, "output", shell.outputs_known),
        (Column("Output"), Column("Type", 1.2), Column("Given on from", 1.6), Column("To", 1.6)),
        [_list_output_cells(lookup, port) for port in shell.outputs.values()],
    )


def _make_port_block(
    side: tuple[Component, str, bool], columns: tuple[Column, ...], rows: list[tuple[Inlines, ...]]
) -> Block:
    """Return the table of the ports of one side, or a sentence; `side` has the word for one, and whether all are known."""
    shell, word, is_known = side
    if rows:
        last_columns = (Column("Medium", 0.8), Column("Remarks", 1.2))
        table = Table(f"table:{word}s/{shell.id}", f"{shell.title}: {word}s", (*columns, *last_columns), tuple(rows))
        return drop_empty_columns(table)
    message = f"It has no {word}s." if is_known else f"Its {word}s are not known yet."
    title = f"{word.capitalize()}s. "
    return Paragraph(inline_text.to_inlines(Text(title, strong=True), Text(message, muted=True)))


def _list_input_cells(lookup: Lookup, port: Input) -> tuple[Inlines, ...]:
    return (
        inline_text.to_inlines(Text(port.name, code=True)),
        port_tables.make_source_cell(lookup, port),
        port_tables.make_input_type_cell(lookup, port),
        _list_behind(lookup, "input", port),
        *port_tables.make_last_cells(lookup, port),
    )


def _list_output_cells(lookup: Lookup, port: Output) -> tuple[Inlines, ...]:
    architecture = lookup.architecture
    readers = [
        reader
        for reader, connection in lookup.connections_at(port.component)
        if port.id in (connection.shell_port, *connection.outputs) and not reader.id.startswith(f"{port.component}.")
    ]
    cells = [
        inline_text.port_link(architecture, reader) for reader in {reader.id: reader for reader in readers}.values()
    ]
    if port.external:
        cells.append(inline_text.to_inlines(Text("outside: ", muted=True), port.external))
    return (
        inline_text.to_inlines(Text(port.name, code=True), *promise_words.write_badges(port)),
        inline_text.type_link(port.type),
        _list_behind(lookup, "output", port),
        inline_text.join_lines(cells) or inline_text.to_inlines(Text("nobody yet", muted=True)),
        *port_tables.make_last_cells(lookup, port),
    )


def _list_behind(lookup: Lookup, kind: str, port: Input | Output) -> Inlines:
    """Return what stands behind a port, each on a line."""
    lines = []
    for inner_id in lookup.architecture.shell_ports.get(f"{kind} {port.id}", ()):
        holder, _, name = inner_id.rpartition(".")
        if holder == port.component:
            words = "its own output " if kind == "input" else "its own input "
            lines.append(inline_text.to_inlines(Text(words, muted=True), Text(name, code=True)))
        else:
            component = find_component(lookup.architecture, holder)
            made_words = (Text(" (autoconnect)", muted=True),) if isinstance(port, Output) and port.is_made else ()
            lines.append((inline_text.component_link(component), Text(" · "), Text(name, code=True), *made_words))
    return inline_text.join_lines(lines) or inline_text.to_inlines(Text("nothing inside yet", muted=True))
