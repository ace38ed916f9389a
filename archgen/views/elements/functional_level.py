"""The functional level in documents: what groups, components and component types are for, what they read and publish."""

from __future__ import annotations

import re
from collections.abc import Collection, Iterable, Iterator
from fractions import Fraction

from archgen.model.component import Component, ComponentType, Group
from archgen.model.component_nesting import list_surrounding
from archgen.views import inline_text, requirement_servers, timing_words
from archgen.views.element_references import place_run
from archgen.views.elements import port_tables
from archgen.views.elements.annotation_facts import list_annotation_facts, list_contact_facts, make_image_blocks
from archgen.views.elements.element_names import join_surrounding_titles
from archgen.views.elements.parameter_blocks import make_parameter_blocks
from archgen.views.elements.port_tables import write_badges, write_deprecation
from archgen.views.lookup import Lookup
from archgen.views.sequences.sequence_blocks import link_use_cases
from archgen.views.shapes import (
    Block,
    Bullets,
    Column,
    Fact,
    Facts,
    Figure,
    Inlines,
    Markdown,
    Paragraph,
    Table,
    Text,
    drop_empty_columns,
    make_columns,
    show_facts,
)
from archgen.views.timing import element_timing
from archgen.views.type_names import link_type, list_instances, type_page_link

_MAX_NODES = 4
"""With more nodes inside of a composed component a table counts them."""


def make_group_blocks(lookup: Lookup, group: Group, without: Collection[str] = ()) -> tuple[Block, ...]:
    """Describe a group: its owner, its purpose, its picture and its components, without the facts of some keys."""
    components = lookup.shown_members(group.id)
    blocks: list[Block] = [show_facts(list_group_facts(lookup, group), without)]
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
    if components:
        blocks.append(
            make_component_table(lookup, f"table:components/{group.id}", f"Components of {group.title}", components)
        )
    else:
        blocks.append(Paragraph(inline_text.to_inlines(Text("This group has no components yet.", muted=True))))
    return tuple(blocks)


def list_group_facts(lookup: Lookup, group: Group) -> Iterator[Fact]:
    """Yield the facts above a group's description."""
    yield Fact("owner", "Owner", inline_text.owner_links(lookup.architecture, group.owners))
    composed = [shell for shell in lookup.architecture.shells.values() if shell.group == group.id]
    counted = f"{len(group.components)}{f', and {len(composed)} composed of others' if composed else ''}"
    yield Fact("components", "Components", inline_text.to_inlines(counted))
    if group.tags:
        yield Fact("", "Tags", inline_text.to_inlines(", ".join(group.tags)))
    if group.urls:
        yield Fact("links", "Links", inline_text.link_urls(group.urls.items(), lookup.repository))
    yield from (Fact("", *row) for row in list_annotation_facts(lookup, group))


def make_component_table(
    lookup: Lookup, anchor: str, caption: str, components: list[Component], *, inside_of: str | None = None
) -> Table:
    """List components with their purpose, role and nodes; with their types where one of them has a type.

    Each is named with what it is inside of, as seen from within `inside_of`; with None, not at all.
    """
    rows = tuple(
        (
            _make_name_cell(lookup, component, inside_of),
            (link_type(lookup.architecture, component),) if component.component_type else (),
            describe_purpose(component.functionality),
            inline_text.value_or_unknown(component.role),
            _make_node_cell(lookup, component),
        )
        for component in components
    )
    columns = (Column("Component", 1.1), Column("Purpose", 2.4), Column("Role", 0.6), Column("Nodes", 1.1, key="nodes"))
    if any(component.component_type for component in components):
        return Table(anchor, caption, (columns[0], Column("Type", 0.9), *columns[1:]), rows)
    return Table(anchor, caption, columns, tuple((row[0], *row[2:]) for row in rows))


def _make_node_cell(lookup: Lookup, component: Component) -> Inlines:
    """Return the nodes of a component; of many inside of a composed one only how many they are."""
    nodes = lookup.nodes_inside(component.id)
    if component.children and len(nodes) > _MAX_NODES:
        return inline_text.to_inlines(inline_text.count_noun(len(nodes), "node"))
    return inline_text.join_inlines((inline_text.node_link(node),) for node in nodes) or inline_text.UNKNOWN_INLINES


def _make_name_cell(lookup: Lookup, component: Component, inside_of: str | None) -> Inlines:
    """Return a link to a component; of a composed one with how many are inside."""
    around = list_surrounding(lookup.architecture, component.id) if inside_of is not None else ()
    inner = around[around.index(inside_of) + 1 :] if inside_of in around else around
    titles = "".join(f"{lookup.architecture.shells[name].title} · " for name in inner)
    link = inline_text.component_link(component)
    place = (Text(titles, muted=True),) if titles else ()
    if component.id not in lookup.architecture.shells:
        return (*place, link)
    inside = [leaf for leaf in lookup.architecture.leaves_of(component.id) if leaf != component.id]
    return (*place, link, Text(f" ({inline_text.count_noun(len(inside), 'component')})", muted=True))


_MAX_SENTENCE = 300
"""A sentence in a row of a table is cut there."""


def first_sentence(markdown: str | None) -> str | None:
    """Return the first sentence of a Markdown text, on one line; None for no text."""
    if not markdown:
        return None
    line = " ".join(markdown.split("\n\n")[0].split())
    # A full stop counts only before a blank or the end, so that "0.5 m" and "ROS2.x" stay whole.
    end = next((i for i, c in enumerate(line) if c in ".!?" and line[i + 1 : i + 2] in {"", " "}), len(line) - 1)
    # What a colon promises stands in the next paragraph.
    sentence = f"{line[:-1]}…" if end == len(line) - 1 and line.endswith(":") else line[: end + 1]
    return inline_text.cut_text(sentence, _MAX_SENTENCE)


def describe_purpose(markdown: str | None) -> Inlines:
    """Return the first sentence of a Markdown text, its marked words in italics, in bold or as code."""
    sentence = first_sentence(markdown)
    return inline_text.read_marks(sentence) if sentence else inline_text.UNKNOWN_INLINES


def make_component_blocks(lookup: Lookup, component: Component, without: Collection[str] = ()) -> tuple[Block, ...]:
    """Describe a component: facts without those of some keys, functionality, picture, requirements, performance, ports,
    parameters, operations.
    """
    blocks: list[Block] = [
        show_facts(list_component_facts(lookup, component), without),
        make_functionality_block(component),
        *make_image_blocks(lookup, component),
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
    blocks += make_requirement_blocks(lookup, component)
    blocks += make_performance_blocks(component)
    blocks += port_tables.make_port_blocks(lookup, component)
    blocks += make_parameter_blocks(component)
    return tuple(blocks)


def make_functionality_block(component: Component) -> Block:
    """Return what a component does, as written."""
    if component.functionality:
        return Markdown(component.functionality)
    return Paragraph(inline_text.to_inlines(Text("What it does is not described yet.", muted=True)))


def list_component_facts(lookup: Lookup, component: Component) -> Iterator[Fact]:
    """Yield the facts above a component's description."""
    architecture = lookup.architecture
    yield Fact("group", "Group", inline_text.to_inlines(inline_text.group_link(architecture, component.group)))
    yield from _list_composition_facts(lookup, component)
    yield Fact("owner", "Owner", inline_text.owner_links(architecture, component.owners))
    if component.role or not component.children:
        yield Fact("role", "Role", inline_text.value_or_unknown(component.role))
    if timing := timing_words.format_timing_sentence(component.timing):
        yield Fact("", "Timing", inline_text.to_inlines(timing))
    if worst_way := element_timing.make_whole_fact(lookup, component.id):
        yield Fact("", "Worst way through it", worst_way)
    nodes = lookup.nodes_inside(component.id)
    if rate := element_timing.make_rate_fact(lookup, nodes, component.id):
        yield Fact("", "Rate", rate)
    node_links = inline_text.join_inlines((inline_text.node_link(node),) for node in nodes)
    yield Fact("", "Implemented by", node_links or inline_text.UNKNOWN_INLINES)
    if written_frames := lookup.frames_of.get(component.id):
        frame_links = inline_text.join_inlines(inline_text.frame_link(frame.id) for frame in written_frames)
        yield Fact("", "Writes the frames", frame_links)
    if use_cases := link_use_cases(lookup, component.id):
        yield Fact("", "Takes part in", use_cases)
    if component.tags:
        yield Fact("", "Tags", inline_text.to_inlines(", ".join(component.tags)))
    if component.urls:
        yield Fact("links", "Links", inline_text.link_urls(component.urls.items(), lookup.repository))
    yield from (Fact("", *row) for row in list_contact_facts(component))
    yield from (Fact("", *row) for row in list_annotation_facts(lookup, component))


def _list_composition_facts(lookup: Lookup, component: Component) -> Iterator[Fact]:
    """Yield what a component is inside of, of which type it is, and what it says otherwise than that type."""
    architecture = lookup.architecture
    if around := list_surrounding(architecture, component.id):
        links = ((inline_text.component_link(architecture.shells[name]),) for name in around)
        yield Fact("inside_of", "Inside of", inline_text.join_inlines(links, " · "))
    if component.component_type:
        words = Text(", exactly (a reference)" if component.is_reference else "", muted=True)
        yield Fact("", "Type", (link_type(architecture, component), *((words,) if words.text else ())))
    if own_values := list_own_values(lookup, component):
        yield Fact("", "Otherwise than its type", own_values)


def list_own_values(lookup: Lookup, component: Component, max_letters: int | None = None) -> Inlines:
    """Return what an instance says otherwise than its type, each on a line with its place; empty where it says nothing."""
    lines = []
    for value in lookup.type_texts.list_own_values(component):
        text = " ".join(value.text.split())
        is_long = max_letters is not None and len(text) > max_letters
        shown_text = f"{text[:max_letters]} ..." if is_long else text
        place = place_run(lookup, value.at)
        lines.append((Text(f"{value.name}: {shown_text}"), *((Text(" "), place) if place else ())))
    return inline_text.join_lines(lines)


def make_requirement_blocks(lookup: Lookup, component: Component) -> list[Block]:
    """Return the requirements that a component serves."""
    # `requirements: []` states that there are none, a missing key that nobody knows yet; inputs and outputs likewise.
    if not component.requirements:
        message = "It serves no requirement." if component.requirements_known else "Its requirements are not known yet."
        return [Paragraph(inline_text.to_inlines(Text("Requirements. ", strong=True), Text(message, muted=True)))]
    items = tuple(
        requirement_servers.judged_link(lookup, use.text) if use.is_id else inline_text.to_inlines(use.text)
        for use in component.requirements
    )
    return [Paragraph(inline_text.to_inlines(Text("Requirements", strong=True))), Bullets(items)]


def make_performance_blocks(component: Component) -> list[Block]:
    """Return the table of a component's performance indicators."""
    if not component.performance:
        return [
            Paragraph(inline_text.to_inlines(Text("Performance. ", strong=True), Text("Not known yet.", muted=True)))
        ]
    rows = tuple(
        (
            inline_text.to_inlines(indicator.title),
            _accuracy_cell(indicator.accuracy),
            inline_text.quantity_to_inlines(indicator.execution_time),
        )
        for indicator in component.performance
    )
    columns = (Column("Indicator"), Column("Accuracy", 1.5), Column("Execution time"))
    return [Table(f"table:performance/{component.id}", f"{component.title}: performance", columns, rows)]


def _accuracy_cell(accuracy: str | None) -> Inlines:
    """Return an accuracy as it was written; one that is a share sorts by it."""
    percentage = re.match(r"([0-9]+(?:\.[0-9]+)?) ?%", accuracy or "", re.ASCII)
    if accuracy is None or percentage is None:
        return inline_text.value_or_unknown(accuracy)
    return (Text(accuracy, sort_number=str(Fraction(percentage[1]) / 100)),)


def make_composed_blocks(lookup: Lookup, shell: Component, without: Collection[str] = ()) -> tuple[Block, ...]:
    """Describe a composed component: facts without those of some keys, what it does, its picture, its ports, and the
    components directly inside.
    """
    blocks: list[Block] = [
        show_facts(list_component_facts(lookup, shell), without),
        make_functionality_block(shell),
        *make_image_blocks(lookup, shell),
    ]
    blocks += [Markdown(shell.description)] if shell.description else []
    blocks.append(
        Figure(
            f"figure:composed/{shell.id}",
            f"composed/{shell.id}",
            f"{shell.title}: what is inside",
            f"{shell.title} as a frame with its ports at the rim and its components inside.",
        )
    )
    blocks += make_requirement_blocks(lookup, shell) if shell.requirements else []
    blocks += make_performance_blocks(shell) if shell.performance else []
    blocks += port_tables.make_port_blocks(lookup, shell)
    blocks += make_parameter_blocks(shell)
    children = lookup.shown_children(shell)
    if children:
        caption = f"Components of {shell.title}"
        blocks.append(make_component_table(lookup, f"table:components/{shell.id}", caption, children))
    return tuple(blocks)


_MAX_VALUE = 80
"""Letters of a value that the table of instances shows; the instance's own page has all of it."""


def make_component_type_table(lookup: Lookup, anchor: str = "table:component_types") -> Table | None:
    """List the component types; None where there are none."""
    architecture = lookup.architecture
    rows = tuple(
        (
            (type_page_link(each), *write_badges(each)),
            inline_text.to_code(each.library),
            describe_purpose(each.functionality),
            _make_base_cell(lookup, each),
            inline_text.to_code(", ".join(each.generic)),
            (Text(str(count), sort_number=str(count)),),
        )
        for each in architecture.component_types.values()
        for count in (len(_shown_instances(lookup, each)),)
    )
    columns = make_columns(
        ("Type", 1.2),
        ("Library", 0.8),
        ("Purpose", 2.4),
        ("Made from", 1),
        ("Generic names", 0.8),
        ("Instances", 0.7, "right"),
    )
    return drop_empty_columns(Table(anchor, "Types of components", columns, rows)) if rows else None


def make_type_blocks(lookup: Lookup, component_type: ComponentType) -> tuple[Block, ...]:
    """Describe a component type: facts, what it does, its ports, what it can be set to and asked for, and its instances."""
    blocks: list[Block] = [Facts(tuple(_list_facts(lookup, component_type)))]
    base = lookup.architecture.component_types.get(component_type.base_name)
    # What a type has from another is said there.
    known_texts = {base.functionality, base.description} if base else set()
    texts = (component_type.functionality, component_type.description)
    blocks += [Markdown(text) for text in texts if text and text not in known_texts]
    blocks += make_image_blocks(lookup, component_type)
    blocks += _make_port_table(component_type)
    blocks += make_parameter_blocks(component_type)
    blocks += _make_frame_table(component_type)
    blocks += _make_instance_table(lookup, component_type)
    return tuple(blocks)


def _list_facts(lookup: Lookup, component_type: ComponentType) -> Iterable[tuple[str, Inlines]]:
    architecture = lookup.architecture
    if component_type.library:
        yield "Library", inline_text.to_code(component_type.library)
    if component_type.owner:
        yield "Owner", inline_text.owner_links(architecture, [component_type.owner])
    if component_type.base:
        yield "Made from", _make_base_cell(lookup, component_type)
    if component_type.version:
        yield "Version", inline_text.to_inlines(component_type.version)
    if component_type.deprecated:
        yield "Deprecated", write_deprecation(architecture, "component_type", component_type)
    if component_type.generic:
        yield "Generic names", inline_text.join_inlines((Text(name, code=True),) for name in component_type.generic)
    derived = [each for each in architecture.component_types.values() if each.base_name == component_type.id]
    if derived:
        yield "Made from it", inline_text.join_inlines((type_page_link(each),) for each in derived)
    if component_type.components:
        yield "Inside", inline_text.join_inlines((Text(name, code=True),) for name in component_type.components)
    words = "abstract: it has no instance of its own" if component_type.is_abstract else ""
    yield from list_contact_facts(component_type)
    yield from list_annotation_facts(lookup, component_type)
    count = inline_text.count_noun(len(_shown_instances(lookup, component_type)), "instance")
    yield "Instances", inline_text.to_inlines(", ".join(filter(None, (count, words))))


def _make_base_cell(lookup: Lookup, component_type: ComponentType) -> Inlines:
    base = lookup.architecture.component_types.get(component_type.base_name)
    if base is None:
        return inline_text.to_inlines(component_type.base)
    return (type_page_link(base),)


def _make_port_table(component_type: ComponentType) -> list[Block]:
    rows = tuple(
        (
            inline_text.to_inlines(use),
            inline_text.to_code(name),
            _make_type_cell(component_type, type_name, has_inside=use == "out" and bool(component_type.components)),
        )
        for use, ports in (("in", component_type.inputs), ("out", component_type.outputs))
        for name, type_name in ports.items()
    )
    columns = (Column("Use", 0.3), Column("Port", 1.2), Column("Type", 2))
    anchor = f"table:type_ports/{component_type.id}"
    return [Table(anchor, f"Ports of {component_type.title}", columns, rows)] if rows else []


def _make_type_cell(component_type: ComponentType, type_name: str | None, *, has_inside: bool) -> Inlines:
    if type_name in component_type.generic:
        return (Text(type_name or "", code=True), Text(" (generic)", muted=True))
    if type_name is None and has_inside:
        return (Text("follows from what is inside", muted=True),)
    return inline_text.type_link(type_name)


def _make_frame_table(component_type: ComponentType) -> list[Block]:
    """Return the table of the frames, with their names as the type writes them: each instance has its own."""
    rows = tuple(
        (
            inline_text.to_code(frame.id),
            inline_text.to_inlines(Text(frame.parent, code=True) if frame.parent else Text("a root", muted=True)),
            inline_text.to_inlines("static") if frame.static else inline_text.quantity_to_inlines(frame.rate),
        )
        for frame in component_type.frames
    )
    columns = (Column("Frame", 1.4), Column("Placed in", 1.4), Column("Rate", 0.6, "right"))
    anchor = f"table:type_frames/{component_type.id}"
    return [Table(anchor, f"Frames of each {component_type.title}", columns, rows)] if rows else []


def _shown_instances(lookup: Lookup, component_type: ComponentType) -> list[Component]:
    return [each for each in list_instances(lookup.architecture, component_type.id) if lookup.shows_part(each.id)]


def _make_instance_table(lookup: Lookup, component_type: ComponentType) -> list[Block]:
    rows = tuple(
        (
            (inline_text.component_link(each),),
            inline_text.to_inlines(_join_places(lookup, each)),
            (link_type(lookup.architecture, each),),
            _make_own_cell(lookup, each),
        )
        for each in _shown_instances(lookup, component_type)
    )
    columns = (Column("Instance"), Column("In", 1.2), Column("As"), Column("Says otherwise", 2))
    anchor = f"table:instances/{component_type.id}"
    return [drop_empty_columns(Table(anchor, f"Instances of {component_type.title}", columns, rows))] if rows else []


def _join_places(lookup: Lookup, component: Component) -> str:
    group_title = lookup.architecture.groups[component.group].title
    return " · ".join(filter(None, (group_title, join_surrounding_titles(lookup, component))))


def _make_own_cell(lookup: Lookup, component: Component) -> Inlines:
    if component.is_reference:
        return inline_text.to_inlines(Text("a reference: exactly its type", muted=True))
    return list_own_values(lookup, component, max_letters=_MAX_VALUE)
