"""Declare conceptual types: the project's own, and those that its ports use besides."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import replace

from archgen.diagnostic import Diagnostic, Label
from archgen.link import reading
from archgen.model.mapping import Type, full_message
from archgen.syntax.tree import Entry, Table


def declare_types(
    root: Table, used: Iterable[str], shipped: Mapping[str, Type], found: list[Diagnostic]
) -> dict[str, Type]:
    """Return every type that is declared or used, by name.

    The project's own declaration wins, then a name that is itself a message, then the shipped type; a name that is none
    of these becomes a type without a message. `used_names` is consumed lazily.
    """
    types: dict[str, Type] = {}
    for _, entry, below in reading.elements(root, "types"):
        declared = _declared(entry, below)
        earlier = types.setdefault(declared.name, declared)
        if earlier is not declared:
            found.append(_twice(declared, earlier))
    waiting = [*reversed([name for one in types.values() for name in _inside(one)])]
    names = iter(used)
    while True:
        name = waiting.pop() if waiting else next(names, None)
        if name is None:
            return _in_order(types)
        # A shipped type may itself carry types, hence a work list; `name not in types` also ends circles.
        if name not in types:
            types[name] = _from_outside(name, shipped)
            waiting += _inside(types[name])


def _in_order(types: dict[str, Type]) -> dict[str, Type]:
    """Sort the project's own types first, as written, then all others by origin and name.

    A packed file keeps this order: packing a packed project must change nothing.
    """
    ranks = {"project": 0, "shipped": 1, "message": 2}
    own = [one for one in types.values() if one.origin == "project" and one.at.file]
    rest = sorted(
        (one for one in types.values() if one.origin != "project" or not one.at.file),
        # A type that nobody declared has the origin "project" (rank 0) but no file: it ranks with the messages.
        key=lambda one: (ranks[one.origin] or 2, one.name),
    )
    return {one.name: one for one in (*own, *rest)}


def _declared(entry: Entry, below: Table) -> Type:
    name = reading.type_name(entry.key)
    status = reading.text(below, "status")
    return Type(
        name=name,
        message=reading.message(below) or full_message(name),
        comment=reading.text(below, "comment"),
        size=reading.measure(below, "size", "size"),
        status=status if status in {"existing", "planned"} else None,  # type: ignore[arg-type]
        request=_other(below, "request"),
        response=_other(below, "response"),
        feedback=_other(below, "feedback"),
        at=entry.at,
        message_at=reading.place(below, "message"),
    )


def _other(below: Table, key: str) -> str | None:
    written = reading.text(below, key)
    return reading.type_name(written) if written else None


def _inside(one: Type) -> Iterator[str]:
    """Yield the names of the types that a service or an action carries: they count as used."""
    return (name for name in (one.request, one.response, one.feedback) if name)


def _from_outside(name: str, shipped: Mapping[str, Type]) -> Type:
    message = full_message(name)
    if message:
        return Type(name, message, origin="message")
    known = shipped.get(name)
    return replace(known, name=name, origin="shipped") if known else Type(name)


def _twice(second: Type, first: Type) -> Diagnostic:
    return Diagnostic(
        "conflicting-values",
        f"the type `{second.name}` is declared twice: blanks and the way letters are composed do not count",
        second.at,
        labels=(Label(first.at, "declared here"),),
        help="keep one of them",
        element=second.name,
    )
