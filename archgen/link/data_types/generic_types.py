"""Make types of generic ones: `Envelope<Pose>` has the fields of `Envelope`, with `Pose` for its type parameter."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from dataclasses import replace
from typing import NamedTuple

from archgen.diagnostics.common_wording import join_words
from archgen.diagnostics.diagnostic import Diagnostic, Label
from archgen.diagnostics.source_span import NO_SPAN, Span
from archgen.model.generic_names import read_generic_name, write_generic_name
from archgen.model.message_types import ConceptualType, DataField

_NAME_PART = re.compile(r"<=[0-9]+|[<>,]")


class TypeMention(NamedTuple):
    """A type as a port or a field names it, without the brackets of an array."""

    name: str
    span: Span
    element: str
    """The id of the component or the name of the type in which it stands."""
    parameters: tuple[str, ...] = ()
    """The type parameters of the type in which it stands."""
    is_field: bool = False


def list_held_names(name: str, types: Mapping[str, ConceptualType]) -> Iterator[str]:
    """Yield a name, and what it names if it is one of a generic type: `List<Pair<A, B>>`, `List`, `Pair<A, B>`, ..."""
    pending_names = [name]
    while pending_names:
        inner_name = pending_names.pop()
        yield inner_name
        if is_bound_name(inner_name, types):
            base, arguments = read_generic_name(inner_name)
            yield base
            pending_names += reversed(arguments)


def is_bound_name(name: str, types: Mapping[str, ConceptualType]) -> bool:
    """Whether a name is one of a generic type, with as many types as may be: `<` may stand in any type's name."""
    base, arguments = read_generic_name(name)
    return bool(arguments) and base in types and bool(types[base].generic)


def make_bound_type(name: str, types: Mapping[str, ConceptualType]) -> ConceptualType | None:
    """Return the type that a name such as `Envelope<Pose>` makes of a generic type; None for any other name."""
    base, arguments = read_generic_name(name)
    generic_type = types.get(base)
    if generic_type is None or not arguments or len(generic_type.generic) != len(arguments):
        return None
    stands_for = dict(zip(generic_type.generic, arguments, strict=True))
    return replace(
        generic_type,
        name=name,
        message=None,
        fields=None if generic_type.fields is None else _bind_fields(generic_type.fields, stands_for),
        part_fields={part: _bind_fields(fields, stands_for) for part, fields in generic_type.part_fields.items()},
        request=bind_name(generic_type.request, stands_for),
        response=bind_name(generic_type.response, stands_for),
        feedback=bind_name(generic_type.feedback, stands_for),
        generic=(),
        # Nothing declares it: it is used.
        at=NO_SPAN,
        message_at=NO_SPAN,
    )


def _bind_fields(fields: tuple[DataField, ...], stands_for: Mapping[str, str]) -> tuple[DataField, ...]:
    return tuple(
        replace(field, type=f"{bind_name(field.element_type, stands_for)}{field.array}") if field.type else field
        for field in fields
    )


def bind_name(name: str | None, stands_for: Mapping[str, str]) -> str | None:
    """Return a name with what the type parameters in it stand for: `List<T>` is `List<Pose>`."""
    if not name:
        return name
    # Only whole names between the marks are type parameters: `T` in `Twist` is none.
    pieces, position = list[str](), 0
    for mark in _NAME_PART.finditer(name):
        pieces += [_replace_word(name[position : mark.start()], stands_for), mark[0]]
        position = mark.end()
    pieces.append(_replace_word(name[position:], stands_for))
    return write_generic_name("".join(pieces))


def _replace_word(text: str, stands_for: Mapping[str, str]) -> str:
    word = text.strip()
    return text.replace(word, stands_for[word]) if word in stands_for else text


def find_unbound_names(mention: TypeMention, types: Mapping[str, ConceptualType]) -> Iterator[Diagnostic]:
    """Report generic types that are named without the types that they stand for, or with a wrong number of them."""
    pending_names = [mention.name]
    while pending_names:
        name = pending_names.pop()
        base, arguments = read_generic_name(name) if is_bound_name(name, types) else (name, ())
        pending_names += reversed(arguments)
        generic_type = types.get(base)
        if generic_type and name not in mention.parameters and len(generic_type.generic) != len(arguments):
            yield _diagnose_unbound_name(mention, generic_type, len(arguments))


def _diagnose_unbound_name(mention: TypeMention, generic_type: ConceptualType, count: int) -> Diagnostic:
    needed_count = len(generic_type.generic)
    needed_text = f"{needed_count} type{'s' * (needed_count > 1)} ({join_words(generic_type.generic, 'and')})"
    actual_text = "none is named" if not count else f"{count} {'is' if count == 1 else 'are'} named"
    example = f"{generic_type.name}<{', '.join(['Pose', 'Twist', 'Path'][i % 3] for i in range(needed_count))}>"
    return Diagnostic(
        "unbound-generic",
        f"`{generic_type.name}` is made for {needed_text}, and {actual_text}",
        mention.span,
        labels=(Label(generic_type.at, "declared here"),),
        help=f"write it as in `{example}`",
        element=mention.element,
    )
