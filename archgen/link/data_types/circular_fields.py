"""Find types that hold themselves by their fields. ROS refuses such messages: their size would have no end."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace

from archgen.diagnostics.diagnostic import Diagnostic, Label
from archgen.link.data_types.generic_types import list_held_names
from archgen.model.graph_search import find_rings
from archgen.model.message_types import ConceptualType, DataField

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
