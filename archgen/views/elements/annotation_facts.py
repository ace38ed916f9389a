"""What elements of any kind may say beside their own keys, in documents and on cards, and what a card consists of."""

from __future__ import annotations

from collections.abc import Iterator
from urllib.parse import quote

from archgen.diagnostics import Span
from archgen.frozen import dataclass
from archgen.model.architecture import Annotated
from archgen.model.component import Component, ComponentType
from archgen.model.element_annotations import read_figure
from archgen.model.parameter import format_parameter
from archgen.model.path_resolver import title_from_id
from archgen.views import inline_text
from archgen.views.lookup import Lookup
from archgen.views.shapes import Block, Inlines, Markdown, Text


@dataclass(frozen=True, slots=True)
class ElementCard:
    """Kind, id and title of an element, where it is defined, its facts, and lists below subheadings."""

    kind: str
    id: str
    title: str
    span: Span
    facts: tuple[tuple[str, str], ...]
    lists: tuple[tuple[str, tuple[str, ...]], ...] = ()


def known_facts(facts: list[tuple[str, str]]) -> tuple[tuple[str, str], ...]:
    """Drop facts without a value."""
    return tuple((name, value) for name, value in facts if value)


def format_fact(value: object) -> str:
    """Format a field's value on one line."""
    if value is None:
        return ""
    return ", ".join(map(str, value)) if isinstance(value, tuple) else " ".join(str(value).split())


def drop_empty_lists(*lists: tuple[str, tuple[str, ...]]) -> Iterator[tuple[str, tuple[str, ...]]]:
    """Yield the lists that hold something: of most elements these say nothing, and that is no news."""
    return (each for each in lists if each[1])


def list_finding_lines(lookup: Lookup, element_id: str) -> Iterator[str]:
    """Format the findings about an element."""
    for finding in lookup.findings_of.get(element_id, ()):
        yield f"{finding.severity}[{finding.rule}]: {finding.message}"


_MAX_HINT = 300
"""Letters of the hints for one program that are shown; the files have all of them."""
_MARKDOWN_SIGNS = str.maketrans({sign: f"\\{sign}" for sign in "\\`*_{}[]()<>#!|&~"})


def list_annotation_facts(lookup: Lookup, element: Annotated) -> Iterator[tuple[str, Inlines]]:
    """Yield the properties of an element, each on a line, and for whom it has hints; nothing where it has neither."""
    annotations = element.annotations
    if annotations.properties:
        lines = (
            (Text(f"{title_property(lookup, name)}: "), *write_property(lookup, name, text))
            for name, text in annotations.properties.items()
        )
        yield "Properties", inline_text.join_lines(lines)
    if annotations.hints:
        hints = (
            (Text(f"{program}: "), Text(_shorten_hint(data), code=True)) for program, data in annotations.hints.items()
        )
        yield "Hints", inline_text.join_lines(hints)


def list_annotation_lines(element: Annotated) -> Iterator[tuple[str, str]]:
    """Yield the properties and hints of an element as facts of its card."""
    annotations = element.annotations
    if annotations.properties:
        yield "properties", ", ".join(f"{name}: {text}" for name, text in annotations.properties.items())
    if annotations.hints:
        yield "hints", ", ".join(f"{program}: {_shorten_hint(data)}" for program, data in annotations.hints.items())


def _shorten_hint(data: object) -> str:
    text = " ".join(format_parameter(data).split())
    return text if len(text) <= _MAX_HINT else f"{text[:_MAX_HINT]} ..."


def title_property(lookup: Lookup, name: str) -> str:
    """Return what a property is called: as declared, else made from its id."""
    declared = lookup.architecture.properties.get(name)
    return declared.title if declared else title_from_id(name)


def write_property(lookup: Lookup, name: str, text: str) -> Inlines:
    """Return the value of a property, which leads to its place in the chapter of properties; figures sort by number."""
    figure = read_figure(text)
    is_declared = name in lookup.architecture.properties
    number = str(figure.value) if figure else None
    return (Text(text, ref=f"property:{name}" if is_declared else None, sort_number=number),)


def list_contact_facts(element: Component | ComponentType) -> Iterator[tuple[str, Inlines]]:
    """Yield the status of a component or a type, and whom to ask about it."""
    if element.status:
        yield "Status", inline_text.to_inlines(element.status)
    if element.contact:
        yield "Contact", inline_text.to_inlines(element.contact)


def make_image_blocks(lookup: Lookup, element: Component | ComponentType) -> list[Block]:
    """Return the picture of a component or a type; nothing where it has none, or where a library has it."""
    if not element.image:
        return []
    type_name = element.id if isinstance(element, ComponentType) else element.type_name
    component_type = lookup.architecture.component_types.get(type_name)
    if component_type and component_type.library and component_type.image == element.image:
        return []
    title = " ".join(element.title.split()).translate(_MARKDOWN_SIGNS)
    # As a picture of a chapter: read inside of the project's folder, cleaned, and copied.
    return [Markdown(f"![{title}](<{quote(element.image)}>)")]
