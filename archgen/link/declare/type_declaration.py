"""Declare conceptual types: the project's own, and those that its ports use besides.

Find types that hold themselves by their fields. ROS refuses such messages: their size would have no end. Find the types
that replace deprecated ones.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from itertools import chain

from archgen.diagnostics import Diagnostic, Label, find_closest, first_written_span
from archgen.frozen import dataclass, replace
from archgen.link import mapping_values
from archgen.link.data_types.field_types import (
    FieldTypeReader,
    OversizedType,
    TypeMention,
    TypeSources,
    add_used_types,
    find_unbound_names,
    is_bound_name,
    list_held_names,
)
from archgen.link.data_types.message_definitions import TypeDefinition, TypeReading, read_type_content
from archgen.link.element_outline import ElementOutline
from archgen.link.promise_reading import read_deprecation
from archgen.link.value_readers import read_values
from archgen.model.graph_search import find_rings
from archgen.model.message_types import PART_KEYS, ConceptualType, DataField, full_message_name
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
    from archgen.link.data_types.message_definitions import DefinitionMaker, name_messages

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


_MAX_GUESSES = 200


def name_replacements(
    types: dict[str, ConceptualType], sources: TypeSources, diagnostics: list[Diagnostic]
) -> list[str]:
    """Give deprecated types the names of those that replace them, and return these; report names that nothing has."""
    found_names: list[str] = []
    guesses_left = _MAX_GUESSES
    for each in list(types.values()):
        deprecated = each.deprecated
        if deprecated is None or deprecated.use is None:
            continue
        name = mapping_values.normalise_type_name(deprecated.use)
        if _is_known(name, types, sources):
            types[each.name] = replace(each, deprecated=replace(deprecated, target=name))
            found_names.append(name)
        elif not sources.is_partial and name not in sources.lost_keys:
            guess = find_closest(name, (other for other in types if other != each.name)) if guesses_left > 0 else None
            guesses_left -= 1
            diagnostics.append(
                Diagnostic(
                    "unknown-reference",
                    f"no type named `{name}`",
                    deprecated.use_at,
                    help=f"did you mean `{guess}`?"
                    if guess
                    else f"declare it below `types`, as in `{name}: package/msg/Name`",
                    element=each.name,
                )
            )
    return found_names


def _is_known(name: str, types: dict[str, ConceptualType], sources: TypeSources) -> bool:
    return (
        name in types
        or name in sources.shipped_types
        or full_message_name(name) is not None
        or is_bound_name(name, types)
    )


_MAX_LABELS = 6
"""So many of a circle's fields are shown."""


def drop_circular_fields(types: dict[str, ConceptualType], diagnostics: list[Diagnostic]) -> None:
    """Report circles of fields, and take the fields of which they consist out of the types.

    What generic types stand for counts as held. So a type that grows (`Envelope<T>` holds `Envelope<Envelope<T>>`) is a
    circle, and what is left has an end.
    """
    held_types = {
        name: [held for _, field in each.list_fields() for held in _list_held_types(field, each, types)]
        for name, each in types.items()
    }
    for ring in find_rings(held_types):
        diagnostics.append(_diagnose_ring(ring, types))
        members = frozenset(ring)
        for name in ring:
            types[name] = _drop_fields(types[name], members, types)


def _list_held_types(field: DataField, holder: ConceptualType, types: Mapping[str, ConceptualType]) -> Iterator[str]:
    for name in list_held_names(field.element_type, types):
        if name in types and name not in holder.generic:
            yield name


def _drop_fields(
    holder: ConceptualType, members: frozenset[str], types: Mapping[str, ConceptualType]
) -> ConceptualType:
    def keep_sound(fields: Sequence[DataField]) -> tuple[DataField, ...]:
        return tuple(field for field in fields if members.isdisjoint(_list_held_types(field, holder, types)))

    return replace(
        holder,
        fields=None if holder.fields is None else keep_sound(holder.fields),
        part_fields={part: keep_sound(fields) for part, fields in holder.part_fields.items()},
    )


def _diagnose_ring(ring: Sequence[str], types: Mapping[str, ConceptualType]) -> Diagnostic:
    members = frozenset(ring)
    way = list(_walk_ring(ring[0], members, types))
    (first_field, next_name), *others = way
    detour = "" if next_name == ring[0] else f", through `{next_name}`"
    labels = tuple(Label(field.type_at, f"which holds `{name}`") for field, name in others[:_MAX_LABELS])
    return Diagnostic(
        "circular-fields",
        f"the type `{ring[0]}` holds itself{detour}",
        first_field.type_at,
        labels=labels,
        help="name it by an id or an index, or take what both hold into a third type",
        element=ring[0],
    )


def _walk_ring(
    start: str, members: frozenset[str], types: Mapping[str, ConceptualType]
) -> Iterator[tuple[DataField, str]]:
    """Yield a way through the fields of a ring, from a member on to where it closes: back at it, or at one before."""
    name, seen_names = start, set[str]()
    while name not in seen_names:
        seen_names.add(name)
        held_types = {
            held: field
            for _, field in reversed(list(types[name].list_fields()))
            for held in _list_held_types(field, types[name], types)
            if held in members
        }
        # Straight back where that is possible; else the first field that stays in the ring.
        name = start if start in held_types else next(reversed(held_types))
        yield held_types[name], name
