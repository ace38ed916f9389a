"""Component types in documents: their ports and settings, what they are made from, and their instances with what each says."""

from __future__ import annotations

from collections.abc import Iterable

from archgen.model.component import Component, ComponentType
from archgen.views import inline_text
from archgen.views.elements.annotation_facts import list_annotation_facts, list_contact_facts, make_image_blocks
from archgen.views.elements.element_names import join_surrounding_titles
from archgen.views.elements.functional_level import describe_purpose, list_own_values
from archgen.views.elements.parameter_blocks import make_parameter_blocks
from archgen.views.elements.promise_words import write_badges, write_deprecation
from archgen.views.lookup import Lookup
from archgen.views.shapes import Block, Column, Facts, Inlines, Markdown, Table, Text, drop_empty_columns, make_columns
from archgen.views.type_names import link_type, list_instances, type_page_link

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
