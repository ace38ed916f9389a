"""Add the types that are used and that nobody declares: messages, shipped types, and what generic types make."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping

from archgen.frozen import NamedTuple, replace
from archgen.link.data_types.field_types import is_bound_name, list_held_names, make_bound_type
from archgen.model.generic_names import MAX_NAME_LENGTH, read_generic_name
from archgen.model.message_types import PART_KEYS, ConceptualType, full_message_name

MAX_MADE_FIELDS = 20_000
"""Fields that a project may make of its generic types: each generic type in another one may double them."""


class OversizedType(NamedTuple):
    """A name that a port or a type uses, and why not all that follows from it is made."""

    name: str
    reason: str


class _PendingName(NamedTuple):
    """A name that is used, and the one in the project's files from which it follows."""

    name: str
    first_name: str
    is_field: bool = False


def add_used_types(
    types: dict[str, ConceptualType], used_names: Iterable[str], shipped_types: Mapping[str, ConceptualType]
) -> list[OversizedType]:
    """Add to the declared types those that ports and other types use; return what would be too large.

    A name that is a message is that message; then comes what a generic type makes of it, then the shipped type. A name
    that is none of these becomes a type without a message; in a field it is left to those who read fields. `used_names`
    is consumed lazily.
    """
    _bind_declared_types(types)
    adder = _TypeAdder(types, shipped_types)
    for each in list(types.values()):
        adder.add_names(_list_inner_names(each, each.name, types))
    for name in used_names:
        if name not in types:
            adder.add_names([_PendingName(name, name)])
    return adder.oversized_types


def _bind_declared_types(types: dict[str, ConceptualType]) -> None:
    """Give fields to types that are declared as `Envelope<Pose>: {message: ...}`, without fields of their own."""
    for name, declared in list(types.items()):
        bound_type = make_bound_type(name, types) if not declared.has_content else None
        if bound_type is not None:
            types[name] = replace(
                bound_type,
                message=declared.message,
                comment=declared.comment or bound_type.comment,
                size=declared.size or bound_type.size,
                status=declared.status or bound_type.status,
                version=declared.version or bound_type.version,
                deprecated=declared.deprecated or bound_type.deprecated,
                at=declared.at,
                message_at=declared.message_at,
            )


def _list_inner_names(
    holder: ConceptualType, first_name: str, types: Mapping[str, ConceptualType]
) -> Iterator[_PendingName]:
    """Yield the types that a type names, less those that its type parameters are part of."""
    names = [(name, False) for key in PART_KEYS if (name := getattr(holder, key))]
    names += [(field.element_type, True) for _, field in holder.list_fields() if field.type]
    for name, is_field in names:
        if not holder.generic or not any(held in holder.generic for held in list_held_names(name, types)):
            yield _PendingName(name, first_name, is_field)


class _TypeAdder:
    """Adds types by their names, each once."""

    def __init__(self, types: dict[str, ConceptualType], shipped_types: Mapping[str, ConceptualType]) -> None:
        self.oversized_types: list[OversizedType] = []
        self._types = types
        self._shipped_types = shipped_types
        self._made_count = 0

    def add_names(self, names: Iterable[_PendingName]) -> None:
        """Add types, and all that their fields name."""
        pending_names = [*reversed(list(names))]
        while pending_names:
            pending = pending_names.pop()
            # A type may itself name types, hence a work list; that each is added once also ends circles.
            if pending.name in self._types:
                continue
            is_bound = is_bound_name(pending.name, self._types)
            added_type = self._make_bound_type(pending) if is_bound else self._make_plain_type(pending)
            if is_bound:
                arguments = read_generic_name(pending.name).arguments
                pending_names += [_PendingName(name, pending.first_name, is_field=True) for name in arguments]
            if added_type is not None:
                self._types[pending.name] = added_type
                pending_names += _list_inner_names(added_type, pending.first_name, self._types)

    def _make_bound_type(self, pending: _PendingName) -> ConceptualType | None:
        generic_type = self._types[read_generic_name(pending.name).base]
        # Counted before they are made.
        self._made_count += 1 + sum(map(len, (generic_type.fields or (), *generic_type.part_fields.values())))
        if len(pending.name) > MAX_NAME_LENGTH:
            reason = f"makes types with names of more than {MAX_NAME_LENGTH} characters"
        elif self._made_count > MAX_MADE_FIELDS:
            reason = f"and other generic types make more than {MAX_MADE_FIELDS:,} fields"
        else:
            # As unbound as the generic type itself: that is reported, and that it has no message follows.
            unbound_type = ConceptualType(pending.name, generic=generic_type.generic)
            return make_bound_type(pending.name, self._types) or unbound_type
        self.oversized_types.append(OversizedType(pending.first_name, reason))
        return ConceptualType(pending.name, generic=generic_type.generic)

    def _make_plain_type(self, pending: _PendingName) -> ConceptualType | None:
        message, shipped_type = full_message_name(pending.name), self._shipped_types.get(pending.name)
        if pending.is_field and (message or shipped_type is None):
            return None
        if message:
            return ConceptualType(pending.name, message, origin="message")
        return (
            replace(shipped_type, name=pending.name, origin="shipped") if shipped_type else ConceptualType(pending.name)
        )
