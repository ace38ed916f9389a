"""Declare conceptual types: the project's own, and those that its ports use besides."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import replace

from archgen.diagnostics.diagnostic import Diagnostic, Label
from archgen.link import mapping_values
from archgen.model.message_types import ConceptualType, full_message_name
from archgen.syntax.yaml_tree import MappingEntry, MappingNode


def declare_types(
    root: MappingNode,
    used_names: Iterable[str],
    shipped_types: Mapping[str, ConceptualType],
    diagnostics: list[Diagnostic],
) -> dict[str, ConceptualType]:
    """Return every type that is declared or used, by name.

    The project's own declaration wins, then a name that is itself a message, then the shipped type; a name that is none
    of these becomes a type without a message. `used_names` is consumed lazily.
    """
    types: dict[str, ConceptualType] = {}
    for _, entry, body in mapping_values.iterate_elements(root, "types"):
        declared_type = _declare_type(entry, body)
        earlier_type = types.setdefault(declared_type.name, declared_type)
        if earlier_type is not declared_type:
            diagnostics.append(_diagnose_duplicate_type(declared_type, earlier_type))
    pending_names = [*reversed([name for known_type in types.values() for name in _list_carried_types(known_type)])]
    names = iter(used_names)
    while True:
        name = pending_names.pop() if pending_names else next(names, None)
        if name is None:
            return _sort_types(types)
        # A shipped type may itself carry types, hence a work list; `name not in types` also ends circles.
        if name not in types:
            types[name] = _make_undeclared_type(name, shipped_types)
            pending_names += _list_carried_types(types[name])


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


def _declare_type(entry: MappingEntry, body: MappingNode) -> ConceptualType:
    name = mapping_values.normalise_type_name(entry.key)
    status = mapping_values.get_text(body, "status")
    return ConceptualType(
        name=name,
        message=mapping_values.get_message(body) or full_message_name(name),
        comment=mapping_values.get_text(body, "comment"),
        size=mapping_values.get_quantity(body, "size", "size"),
        status=status if status in {"existing", "planned"} else None,  # type: ignore[arg-type]
        request=_read_type_name(body, "request"),
        response=_read_type_name(body, "response"),
        feedback=_read_type_name(body, "feedback"),
        frame=mapping_values.get_text(body, "frame"),
        at=entry.key_span,
        message_at=mapping_values.get_span(body, "message"),
        frame_at=mapping_values.get_span(body, "frame"),
    )


def _read_type_name(body: MappingNode, key: str) -> str | None:
    text = mapping_values.get_text(body, key)
    return mapping_values.normalise_type_name(text) if text else None


def _list_carried_types(carrier: ConceptualType) -> Iterator[str]:
    """Yield the names of the types that a service or an action carries: they count as used."""
    return (name for name in (carrier.request, carrier.response, carrier.feedback) if name)


def _make_undeclared_type(name: str, shipped_types: Mapping[str, ConceptualType]) -> ConceptualType:
    message = full_message_name(name)
    if message:
        return ConceptualType(name, message, origin="message")
    shipped_type = shipped_types.get(name)
    return replace(shipped_type, name=name, origin="shipped") if shipped_type else ConceptualType(name)


def _diagnose_duplicate_type(second_type: ConceptualType, first_type: ConceptualType) -> Diagnostic:
    return Diagnostic(
        "conflicting-values",
        f"the type `{second_type.name}` is declared twice: blanks and the way letters are composed do not count",
        second_type.at,
        labels=(Label(first_type.at, "declared here"),),
        help="keep one of them",
        element=second_type.name,
    )
