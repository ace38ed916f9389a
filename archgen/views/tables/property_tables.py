"""The properties of elements in documents: each that the project declares, with what has it, and the free ones."""

from __future__ import annotations

from collections.abc import Iterator

from archgen.diagnostics import join_words
from archgen.model.architecture import AnnotatedElement, list_annotated_elements
from archgen.model.element_annotations import PropertyDeclaration, describe_range
from archgen.views import inline_text
from archgen.views.elements.annotation_facts import title_property, write_property
from archgen.views.lookup import Lookup
from archgen.views.shapes import Block, Column, Facts, Inlines, Markdown, Paragraph, Section, Table, Text


def make_property_sections(lookup: Lookup) -> tuple[Section, ...]:
    """Return a section for each declared property, and one for all others; nothing where there are none."""
    elements = [each for each in _list_shown(lookup) if each.element.annotations.properties]
    sections = [
        Section(f"property:{each.id}", each.title, tuple(_make_blocks(lookup, each, elements)))
        for each in lookup.architecture.properties.values()
    ]
    if table := _make_free_table(lookup, elements):
        sections.append(Section("property:", "Other properties", (table,)))
    return tuple(sections)


def _list_shown(lookup: Lookup) -> Iterator[AnnotatedElement]:
    for each in list_annotated_elements(lookup.architecture):
        component = each.owner_id if each.kind in {"component", "input", "output"} else None
        if component is None or lookup.shows_part(component):
            yield each


def _make_blocks(lookup: Lookup, declared: PropertyDeclaration, elements: list[AnnotatedElement]) -> Iterator[Block]:
    if declared.description:
        yield Markdown(declared.description)
    kinds = join_words([kind.replace("_", " ") for kind in declared.of])
    facts = (
        ("Of", f"each {kinds}" if declared.required else kinds),
        ("Values", ", ".join(declared.choices) or describe_range(declared) or (declared.type or "")),
        ("Unit", declared.unit or ""),
    )
    if known_facts := tuple((name, inline_text.to_inlines(text)) for name, text in facts if text):
        yield Facts(known_facts)
    rows = tuple(
        (_link_element(lookup, each), inline_text.to_inlines(_name_kind(each)), write_value(lookup, each, declared.id))
        for each in elements
        if declared.id in each.element.annotations.properties
    )
    columns = (Column("Element", 2), Column("Kind"), Column("Value"))
    if rows:
        yield Table(f"table:property/{declared.id}", declared.title, columns, rows)
    else:
        yield Paragraph(inline_text.to_inlines(Text("Nothing has it yet.", muted=True)))


def write_value(lookup: Lookup, each: AnnotatedElement, name: str) -> Inlines:
    """Return the value of a property in its own table: it leads nowhere."""
    (run,) = write_property(lookup, name, each.element.annotations.properties[name])
    return (Text(run.text, sort_number=run.sort_number),)


def _make_free_table(lookup: Lookup, elements: list[AnnotatedElement]) -> Table | None:
    declared_names = lookup.architecture.properties
    rows = tuple(
        (
            _link_element(lookup, each),
            inline_text.to_inlines(_name_kind(each)),
            inline_text.to_inlines(title_property(lookup, name)),
            write_value(lookup, each, name),
        )
        for each in elements
        for name in each.element.annotations.properties
        if name not in declared_names
    )
    columns = (Column("Element", 2), Column("Kind"), Column("Property"), Column("Value"))
    return Table("table:properties", "Other properties", columns, rows) if rows else None


def _name_kind(each: AnnotatedElement) -> str:
    return each.kind.replace("_", " ")


def _link_element(lookup: Lookup, each: AnnotatedElement) -> Inlines:
    architecture = lookup.architecture
    if each.kind in {"input", "output"}:
        component = architecture.find_component(each.owner_id)
        title = component.title if component else each.owner_id
        return (Text(title, ref=f"component:{each.owner_id}"), Text(f" {each.id.rpartition('.')[2]}", code=True))
    title = str(getattr(each.element, "title", each.id))
    return (Text(each.id if each.kind == "node" else title, ref=f"{each.kind}:{each.id}"),)


def make_glossary_table(lookup: Lookup) -> Table | None:
    """List the terms of the glossary, sorted; references to a term lead to its row. None where there are none."""
    terms = sorted(lookup.architecture.glossary.values(), key=lambda each: (each.term.casefold(), each.term))
    rows = tuple(
        ((Text(each.term, strong=True),), inline_text.to_inlines(" ".join(each.text.split()))) for each in terms
    )
    anchors = tuple(f"term:{each.term}" for each in terms)
    columns = (Column("Term"), Column("Meaning", 3))
    return Table("table:glossary", "Terms", columns, rows, row_anchors=anchors) if rows else None
