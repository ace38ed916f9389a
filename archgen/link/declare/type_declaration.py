"""Declare conceptual types: the project's own, and those that its ports use besides."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from itertools import chain

from archgen.diagnostics.diagnostic import Diagnostic, Label
from archgen.diagnostics.source_span import first_written_span
from archgen.frozen import dataclass
from archgen.link import mapping_values
from archgen.link.data_types.circular_fields import drop_circular_fields
from archgen.link.data_types.field_reading import TypeReading, read_type_content
from archgen.link.data_types.field_types import FieldTypeReader, TypeSources
from archgen.link.data_types.generic_types import TypeMention, find_unbound_names, list_held_names
from archgen.link.data_types.message_definitions import DefinitionMaker, TypeDefinition
from archgen.link.data_types.message_names import name_messages
from archgen.link.data_types.type_replacements import name_replacements
from archgen.link.data_types.used_types import OversizedType, add_used_types
from archgen.link.element_outline import ElementOutline
from archgen.link.promise_reading import read_deprecation
from archgen.link.value_readers import read_values
from archgen.model.message_types import PART_KEYS, ConceptualType, full_message_name
from archgen.model.ros_distro import is_ros_1
from archgen.syntax.yaml_tree import MappingEntry, MappingNode


@dataclass(frozen=True, slots=True)
class DeclaredTypes:
    """Every type that is declared or used, by name, and the messages that types with fields define.

    `message_mentions` are the messages that fields name, each with its place and the type.
    """

    types: Mapping[str, ConceptualType]
    definitions: tuple[TypeDefinition, ...] = ()
    message_mentions: tuple[TypeMention, ...] = ()
    diagnostics: tuple[Diagnostic, ...] = ()


def declare_types(root: MappingNode, outline: ElementOutline, sources: TypeSources) -> DeclaredTypes:
    """Return every type that is declared or used, by name; the project's own declaration wins."""
    diagnostics = list[Diagnostic]()
    types = _declare_own_types(root, sources, diagnostics)
    replacements = name_replacements(types, sources, diagnostics)
    if not any(each.has_content or each.generic for each in types.values()):
        # Nearly every project: its ports need not be looked at one by one.
        add_used_types(types, chain(outline.list_used_types(), replacements), sources.shipped_types)
        return DeclaredTypes(_sort_types(types), diagnostics=tuple(diagnostics))
    drop_circular_fields(types, diagnostics)
    mentions = [*_list_port_mentions(outline), *(each for holder in types.values() for each in _list_mentions(holder))]
    oversized_types = add_used_types(
        types, chain((each.name for each in mentions if not each.is_field), replacements), sources.shipped_types
    )
    first_mentions = {mention.name: mention for mention in reversed(mentions)}
    diagnostics += (_diagnose_oversized_type(each, types, first_mentions) for each in oversized_types)
    diagnostics += (finding for mention in mentions for finding in find_unbound_names(mention, types))
    definitions = _define_messages(types, mentions, sources, diagnostics)
    return DeclaredTypes(
        _sort_types(types), definitions, tuple(_list_message_mentions(mentions, types)), tuple(diagnostics)
    )


def _declare_own_types(
    root: MappingNode, sources: TypeSources, diagnostics: list[Diagnostic]
) -> dict[str, ConceptualType]:
    types, ros1 = dict[str, ConceptualType](), is_ros_1(sources.distro)
    for _, entry, body in mapping_values.iterate_elements(root, "types"):
        name = mapping_values.normalise_type_name(entry.key)
        reading = TypeReading(name, ros1, diagnostics, is_damaged=entry.key in sources.damaged_elements)
        declared_type = _declare_type(entry, body, reading, sources.library_ids.get(name))
        earlier_type = types.setdefault(declared_type.name, declared_type)
        if earlier_type is not declared_type:
            diagnostics.append(_diagnose_duplicate_type(declared_type, earlier_type))
    return types


def _list_port_mentions(outline: ElementOutline) -> Iterator[TypeMention]:
    for component, outputs in outline.outputs.items():
        for output in outputs.values():
            if output.type:
                yield TypeMention(output.type, output.type_at, component)
        for entry in outline.inputs[component].values():
            body = mapping_values.get_body(entry)
            type_text = mapping_values.get_text(body, "type")
            if type_text:
                name = mapping_values.normalise_type_name(type_text)
                yield TypeMention(name, mapping_values.get_span(body, "type"), component)


def _list_mentions(holder: ConceptualType) -> Iterator[TypeMention]:
    """Yield the types that a type names: of its fields, and those that a service or an action carries."""
    for key in PART_KEYS:
        if name := getattr(holder, key):
            yield TypeMention(name, holder.at, holder.name, holder.generic)
    for _, field in holder.list_fields():
        if field.type:
            yield TypeMention(field.element_type, field.type_at, holder.name, holder.generic, is_field=True)


def _list_message_mentions(
    mentions: Iterable[TypeMention], types: Mapping[str, ConceptualType]
) -> Iterator[TypeMention]:
    """Yield the messages that fields name, and names of generic types: those of ports are judged with the ports."""
    for mention in mentions:
        for name in list_held_names(mention.name, types):
            message = full_message_name(name)
            if message and (mention.is_field or name != mention.name):
                yield mention._replace(name=message)


def _define_messages(
    types: dict[str, ConceptualType],
    mentions: Iterable[TypeMention],
    sources: TypeSources,
    diagnostics: list[Diagnostic],
) -> tuple[TypeDefinition, ...]:
    spans = {mention.name: mention.span for mention in reversed(list(mentions))}
    defining_types = name_messages(types, sources, spans, diagnostics)
    type_reader = FieldTypeReader(types, sources)
    maker = DefinitionMaker(types, type_reader, diagnostics)
    definitions = tuple(
        maker.make_definition(types[name], first_written_span(types[name].at, spans.get(name, types[name].at)))
        for name in defining_types
    )
    defined_names = frozenset(defining_types)
    for name, each in types.items():
        if name not in defined_names:
            maker.check_fields(each)
    diagnostics += (finding for mention in mentions for finding in type_reader.find_unknown_names(mention))
    return definitions


def _sort_types(types: dict[str, ConceptualType]) -> dict[str, ConceptualType]:
    """Sort the project's own types first, as written, then all others by origin and name.

    A packed file keeps this order: packing a packed project must change nothing.
    """
    ranks = {"project": 0, "shipped": 1, "message": 2}
    project_types = [
        listed_type for listed_type in types.values() if listed_type.origin == "project" and listed_type.at.file
    ]
    other_types = sorted(
        (listed_type for listed_type in types.values() if listed_type.origin != "project" or not listed_type.at.file),
        # A type that nobody declared has the origin "project" (rank 0) but no file: it ranks with the messages.
        key=lambda listed_type: (ranks[listed_type.origin] or 2, listed_type.name),
    )
    return {listed_type.name: listed_type for listed_type in (*project_types, *other_types)}


def _declare_type(entry: MappingEntry, body: MappingNode, reading: TypeReading, library: str | None) -> ConceptualType:
    content = read_type_content(body, reading)
    values = {"message": full_message_name(reading.name), **read_values("type", ConceptualType, body)}
    return ConceptualType(
        **values,
        name=reading.name,
        **content,
        deprecated=read_deprecation(body, reading.name, reading.diagnostics),
        library=library,
        at=entry.key_span,
    )


def _diagnose_oversized_type(
    oversized: OversizedType, types: Mapping[str, ConceptualType], mentions: Mapping[str, TypeMention]
) -> Diagnostic:
    mention = mentions.get(oversized.name)
    span, element = (mention.span, mention.element) if mention else (types[oversized.name].at, oversized.name)
    help_line = "take generic types out of one another: no message needs so many"
    return Diagnostic("too-large", f"`{oversized.name}` {oversized.reason}", span, help=help_line, element=element)


def _diagnose_duplicate_type(second_type: ConceptualType, first_type: ConceptualType) -> Diagnostic:
    return Diagnostic(
        "conflicting-values",
        f"the type `{second_type.name}` is declared twice: blanks and the way letters are composed do not count",
        second_type.at,
        labels=(Label(first_type.at, "declared here"),),
        help="keep one of them",
        element=second_type.name,
    )
