"""The functional level in documents: what groups and components are for, what they read and what they publish."""

from __future__ import annotations

from archgen.model.component import Component, Group, Input, Output
from archgen.views import timing_of, words
from archgen.views.index import Index
from archgen.views.shapes import (
    Block,
    Bullets,
    Column,
    Facts,
    Figure,
    Inlines,
    Markdown,
    Paragraph,
    Table,
    Text,
    without_empty_columns,
)


def group_blocks(view: Index, group: Group) -> tuple[Block, ...]:
    """Describe a group: its owner, its purpose, its picture and its components."""
    shown = view.components(group.id)
    blocks: list[Block] = [Facts(tuple(_group_facts(view, group)))]
    if group.description:
        blocks.append(Markdown(group.description))
    blocks.append(
        # The figure is always named; site and report drop the figures that were not drawn (`keep_drawn`).
        Figure(
            f"figure:groups/{group.id}",
            f"groups/{group.id}",
            f"{group.title}: components and neighbours",
            f"The components of {group.title} with the flows between them and to neighbouring components.",
        )
    )
    if shown:
        blocks.append(component_table(view, f"table:components/{group.id}", f"Components of {group.title}", shown))
    else:
        blocks.append(Paragraph(words.text(Text("This group has no components yet.", muted=True))))
    return tuple(blocks)


def _group_facts(view: Index, group: Group) -> list[tuple[str, Inlines]]:
    rows = [("Owner", words.owner_links(view.architecture, group.owners))]
    rows.append(("Components", words.text(str(len(group.components)))))
    if group.tags:
        rows.append(("Tags", words.text(", ".join(group.tags))))
    if group.urls:
        rows.append(("Links", words.urls(group.urls.items())))
    return rows


def component_table(view: Index, anchor: str, caption: str, components: list[Component]) -> Table:
    """List components with their purpose, role and nodes."""
    rows = tuple(
        (
            words.text(words.component_link(component)),
            words.maybe(first_sentence(component.functionality)),
            words.maybe(component.role),
            words.joined((words.node_link(node),) for node in view.nodes_of.get(component.id, ())) or words.UNKNOWN,
        )
        for component in components
    )
    columns = (Column("Component", 1.1), Column("Purpose", 2.4), Column("Role", 0.6), Column("Nodes", 1.1))
    return Table(anchor, caption, columns, rows)


def first_sentence(markdown: str | None) -> str | None:
    """Return the first sentence of a Markdown text without its emphasis marks; None for no text."""
    if not markdown:
        return None
    line = " ".join(markdown.split("\n\n")[0].split())
    # A full stop counts only before a blank or the end, so that "0.5 m" and "ROS2.x" stay whole.
    end = next((i for i, c in enumerate(line) if c in ".!?" and line[i + 1 : i + 2] in {"", " "}), len(line) - 1)
    return line[: end + 1].replace("**", "").replace("`", "")


def component_blocks(view: Index, component: Component) -> tuple[Block, ...]:
    """Describe a component: facts, functionality, picture, requirements, performance, inputs and outputs."""
    blocks: list[Block] = [
        Facts(tuple(_component_facts(view, component))),
        Markdown(component.functionality)
        if component.functionality
        else Paragraph(words.text(Text("What it does is not described yet.", muted=True))),
    ]
    if component.description:
        blocks.append(Markdown(component.description))
    blocks.append(
        Figure(
            f"figure:components/{component.id}",
            f"components/{component.id}",
            f"{component.title}: inputs and outputs",
            f"{component.title} with its inputs at the left and its outputs at the right.",
        )
    )
    blocks += _requirements(view, component)
    blocks += _performance(component)
    blocks += _inputs(view, component)
    blocks += _outputs(view, component)
    return tuple(blocks)


def _component_facts(view: Index, component: Component) -> list[tuple[str, Inlines]]:
    """Return the facts above a component's description."""
    architecture = view.architecture
    rows = [
        ("Group", words.text(words.group_link(architecture, component.group))),
        ("Owner", words.owner_links(architecture, component.owners)),
        ("Role", words.maybe(component.role)),
    ]
    timing = words.timing_sentence(component.timing)
    if timing:
        rows.append(("Timing", words.text(timing)))
    nodes = view.nodes_of.get(component.id, ())
    if rate := timing_of.component_fact(view, nodes, component.id):
        rows.append(("Rate", rate))
    rows.append(("Implemented by", words.joined((words.node_link(node),) for node in nodes) or words.UNKNOWN))
    if component.tags:
        rows.append(("Tags", words.text(", ".join(component.tags))))
    if component.urls:
        rows.append(("Links", words.urls(component.urls.items())))
    return rows


def _requirements(view: Index, component: Component) -> list[Block]:
    # `requirements: []` states that there are none, a missing key that nobody knows yet; inputs and outputs likewise.
    if not component.requirements:
        said = "It serves no requirement." if component.requirements_known else "Its requirements are not known yet."
        return [Paragraph(words.text(Text("Requirements. ", strong=True), Text(said, muted=True)))]
    items = tuple(
        words.requirement_link(view.architecture, use.text) if use.is_id else words.text(use.text)
        for use in component.requirements
    )
    return [Paragraph(words.text(Text("Requirements", strong=True))), Bullets(items)]


def _performance(component: Component) -> list[Block]:
    if not component.performance:
        return [Paragraph(words.text(Text("Performance. ", strong=True), Text("Not known yet.", muted=True)))]
    rows = tuple(
        (
            words.text(indicator.title),
            words.maybe(indicator.accuracy),
            words.maybe(str(indicator.execution_time) if indicator.execution_time else None),
        )
        for indicator in component.performance
    )
    columns = (Column("Indicator"), Column("Accuracy", 1.5), Column("Execution time"))
    return [Table(f"table:performance/{component.id}", f"{component.title}: performance", columns, rows)]


def _inputs(view: Index, component: Component) -> list[Block]:
    if not component.inputs:
        said = "It has no inputs." if component.inputs_known else "Its inputs are not known yet."
        return [Paragraph(words.text(Text("Inputs. ", strong=True), Text(said, muted=True)))]
    rows = tuple(
        (_name(port), _from(view, port), _input_types(view, port), _medium(port), _remarks(port))
        for port in component.inputs.values()
    )
    columns = (Column("Input"), Column("From", 1.9), Column("Type", 1.2), Column("Medium", 0.8), Column("Remarks", 1.3))
    table = Table(f"table:inputs/{component.id}", f"{component.title}: inputs", columns, rows)
    return [without_empty_columns(table)]


def _outputs(view: Index, component: Component) -> list[Block]:
    if not component.outputs:
        said = "It has no outputs." if component.outputs_known else "Its outputs are not known yet."
        return [Paragraph(words.text(Text("Outputs. ", strong=True), Text(said, muted=True)))]
    rows = tuple(
        (_name(port), words.type_link(port.type), _read_by(view, port), _medium(port), _remarks(port))
        for port in component.outputs.values()
    )
    columns = (Column("Output"), Column("Type", 1.2), Column("To", 1.9), Column("Medium", 0.8), Column("Remarks", 1.3))
    table = Table(f"table:outputs/{component.id}", f"{component.title}: outputs", columns, rows)
    return [without_empty_columns(table)]


def _name(port: Input | Output) -> Inlines:
    return words.text(Text(port.name, code=True))


def _from(view: Index, port: Input) -> Inlines:
    """Return the sources of an input, one on each line, with partners other than the component's own."""
    sources = [
        (*words.source_words(view.architecture, connection), *_other_owner(view, port.component, connection.outputs))
        for connection in port.connections
    ]
    if port.external:
        sources.append(words.text(Text("outside: ", muted=True), port.external))
    return words.lines(sources) or words.UNKNOWN


def _other_owner(view: Index, component: str, outputs: tuple[str, ...]) -> Inlines:
    """Return the owners of the outputs who do not own the component, in brackets; empty where there are none."""
    found = view.architecture
    mine = found.components[component].owners
    owners = dict.fromkeys(p for o in outputs for p in found.components[found.outputs[o].component].owners)
    # Only a flow that crosses from one partner to another names them: the component's own are in its facts.
    others = [owner for owner in owners if owner not in mine]
    return (Text(" ("), *words.joined(words.partner_link(found, o) for o in others), Text(")")) if others else ()


def _input_types(view: Index, port: Input) -> Inlines:
    """Return the types of an input: its own first, then those of the outputs it reads."""
    outputs = (view.architecture.outputs[o] for connection in port.connections for o in connection.outputs)
    types = dict.fromkeys([port.type, *(output.type for output in outputs)] if port.type else (o.type for o in outputs))
    return words.joined(words.type_link(name) for name in types if name) or words.UNKNOWN


def _read_by(view: Index, port: Output) -> Inlines:
    """Return the readers of an output, one on each line."""
    found = view.architecture
    readers = [found.inputs[connection.input] for connection in view.readers.get(port.id, ())]
    cells = [(*words.port_link(found, reader), *_reader_owner(view, port, reader)) for reader in readers]
    if port.external:
        cells.append(words.text(Text("outside: ", muted=True), port.external))
    return words.lines(cells) or words.text(Text("nobody yet", muted=True))


def _reader_owner(view: Index, port: Output, reader: Input) -> Inlines:
    """Return the owners of a reader who do not own the output's component, in brackets."""
    found = view.architecture
    mine = found.components[port.component].owners
    others = [owner for owner in found.components[reader.component].owners if owner not in mine]
    return (Text(" ("), *words.joined(words.partner_link(found, o) for o in others), Text(")")) if others else ()


def _medium(port: Input | Output) -> Inlines:
    return words.text("physical" if port.physical else "digital")


def _remarks(port: Input | Output) -> Inlines:
    optional = "optional" if isinstance(port, Input) and port.optional else ""
    remarks = "; ".join(part for part in (optional, port.description) if part)
    return words.text(remarks) if remarks else ()
