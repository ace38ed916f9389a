"""Who still uses what is going away, and does what replaces it lead anywhere?"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from itertools import chain

from archgen.diagnostics import NO_SPAN, Diagnostic, Label, Severity, Span
from archgen.frozen import NamedTuple
from archgen.model.architecture import Architecture
from archgen.model.component_nesting import list_described_outputs, list_relied_outputs
from archgen.model.deprecation_lookup import find_deprecation, find_replacement
from archgen.model.generic_names import read_generic_name
from archgen.model.promise import Deprecation

_KIND_WORDS = {"output": "output", "type": "type", "component_type": "component type"}
_MAX_LISTED = 6


class _Use(NamedTuple):
    """Somebody who uses something deprecated: in words, where, and the element that it concerns."""

    phrase: str
    kind: str
    name: str
    deprecated: Deprecation
    span: Span
    element: str


def deprecated_use(architecture: Architecture) -> Iterator[Diagnostic]:
    """Something that is going away is still used."""
    for use in _list_uses(architecture):
        if not use.deprecated.is_past(architecture.commit_day):
            yield _diagnose_use(architecture, use, "deprecated-use")


def expired_use(architecture: Architecture) -> Iterator[Diagnostic]:
    """Something is used whose last day is over."""
    if architecture.commit_day is None:
        return
    for use in _list_uses(architecture):
        if use.deprecated.is_past(architecture.commit_day):
            yield _diagnose_use(architecture, use, "expired-use")


def _diagnose_use(architecture: Architecture, use: _Use, rule: str) -> Diagnostic:
    deprecated = use.deprecated
    until = ""
    if rule == "expired-use":
        until = f", which was there until {deprecated.until}: the newest commit is of {architecture.commit_day}"
    elif deprecated.until:
        until = f", which is there until {deprecated.until}"
    replacement = find_replacement(architecture, use.kind, deprecated)
    short = replacement
    if use.kind == "output" and replacement and replacement.rpartition(".")[0] == use.name.rpartition(".")[0]:
        short = ".".join(replacement.split(".")[-2:])
    at = deprecated.at
    return Diagnostic(
        rule,
        f"{use.phrase} the deprecated {_KIND_WORDS[use.kind]} `{use.name}`{until}",
        use.span,
        labels=(Label(at, "deprecated here"),) if at != NO_SPAN and at.file else (),
        help=f"use `{short}` instead" if short else f"ask its owner what replaces it; {_explain_dead_end(use)}",
        element=use.element,
    )


def _explain_dead_end(use: _Use) -> str:
    """Return why nothing can be named that replaces what is going away."""
    deprecated = use.deprecated
    if deprecated.use is None:
        return f"`deprecated` of `{use.name}` names nothing"
    if deprecated.target is None:
        return f"`use: {deprecated.use}` at `{use.name}` names nothing that can take its place"
    return f"`use: {deprecated.use}` at `{use.name}` leads in a circle of what is deprecated itself"


def _list_uses(architecture: Architecture) -> Iterator[_Use]:
    """Yield who uses what is deprecated: readers of outputs, then who uses types, then who is made from component types."""
    types = {name: each.deprecated for name, each in architecture.types.items() if each.deprecated}
    component_types = {name: each.deprecated for name, each in architecture.component_types.items() if each.deprecated}
    if any(output.deprecated for _, output in list_described_outputs(architecture)):
        yield from _list_readers(architecture)
    if types:
        yield from _list_type_users(architecture, types)
    if component_types:
        yield from _list_instances(architecture, component_types)


def _list_readers(architecture: Architecture) -> Iterator[_Use]:
    told: set[tuple[str, str]] = set()
    for counted in list_relied_outputs(architecture):
        deprecated = counted.port.deprecated
        # Who reads one output over two ways reads it once.
        if deprecated and (counted.reader.id, counted.port.id) not in told:
            told.add((counted.reader.id, counted.port.id))
            span = counted.connection.at if counted.connection.at != NO_SPAN else counted.reader.at
            phrase = f"`{counted.reader.id}` reads"
            yield _Use(phrase, "output", counted.port.id, deprecated, span, counted.reader.component)


def _list_type_users(architecture: Architecture, types: Mapping[str, Deprecation]) -> Iterator[_Use]:
    yield from _list_naming_ports(architecture, types)
    yield from _list_type_readers(architecture, types)
    yield from _list_holders(architecture, types)


def _list_naming_ports(architecture: Architecture, types: Mapping[str, Deprecation]) -> Iterator[_Use]:
    """Yield the ports and operations that name a type."""
    for component, output in list_described_outputs(architecture):
        # The type of what a composed component passes on follows from inside: it is told there.
        is_given_on = bool(component.children) and output.type_at == NO_SPAN
        if output.deprecated is None and not is_given_on:
            span = output.type_at if output.type_at != NO_SPAN else output.at
            for name in _list_names(output.type, types):
                yield _Use(f"`{output.id}` has", "type", name, types[name], span, component.id)
    for component in architecture.list_described_components():
        for port in component.inputs.values():
            for name in _list_names(port.type, types):
                yield _Use(f"`{port.id}` expects", "type", name, types[name], port.type_at, component.id)
        for operation in component.operations.values():
            for type_name in dict.fromkeys(operation.type_names):
                for name in _list_names(type_name, types):
                    phrase = f"the operation `{operation.id}` of `{component.id}` has"
                    yield _Use(phrase, "type", name, types[name], operation.at, component.id)


def _list_type_readers(architecture: Architecture, types: Mapping[str, Deprecation]) -> Iterator[_Use]:
    """Yield the inputs that say nothing of a type: they read what their sources send."""
    told: set[tuple[str, str]] = set()
    for counted in list_relied_outputs(architecture):
        reader = counted.reader
        # Who reads what is going away with its type leaves both at once.
        if reader.type is not None or counted.port.deprecated is not None:
            continue
        for name in _list_names(counted.leaf.type, types):
            if (reader.id, name) not in told:
                told.add((reader.id, name))
                span = counted.connection.at if counted.connection.at != NO_SPAN else reader.at
                yield _Use(f"`{reader.id}` reads", "type", name, types[name], span, reader.component)


def _list_holders(architecture: Architecture, types: Mapping[str, Deprecation]) -> Iterator[_Use]:
    """Yield the types that hold another one."""
    for holder in architecture.types.values():
        if holder.at == NO_SPAN or holder.deprecated is not None:
            continue  # a type that is going away itself
        fields = ((field.element_type, field.type_at) for _, field in holder.list_fields())
        parts = ((name, holder.at) for name in (holder.request, holder.response, holder.feedback) if name)
        for type_name, span in dict.fromkeys(chain(fields, parts, [(holder.name, holder.at)])):
            for name in _list_names(type_name, types):
                if name in holder.generic or name == holder.name:
                    continue
                yield _Use(f"the type `{holder.name}` holds", "type", name, types[name], span, holder.name)


def _list_names(type_name: str | None, types: Mapping[str, Deprecation]) -> list[str]:
    """Return the deprecated types that a name holds: itself, and what `Box<Old>` names in its brackets."""
    pending, names = [type_name] if type_name else [], dict[str, None]()
    while pending:
        name = pending.pop()
        names |= {name: None} if name in types else {}
        pending += read_generic_name(name).arguments if "<" in name else ()
    return [*names]


def _list_instances(architecture: Architecture, component_types: Mapping[str, Deprecation]) -> Iterator[_Use]:
    for component in architecture.list_described_components():
        name = component.type_name
        if name in component_types:
            phrase = f"`{component.id}` is an instance of"
            yield _Use(phrase, "component_type", name, component_types[name], component.at, component.id)
    for component_type in architecture.component_types.values():
        name = component_type.base_name
        if name in component_types and component_type.deprecated is None:
            phrase = f"the component type `{component_type.id}` is made from"
            yield _Use(phrase, "component_type", name, component_types[name], component_type.at, component_type.id)


def circular_replacement(architecture: Architecture) -> Iterator[Diagnostic]:
    """What is to be used instead of something deprecated is to be replaced by that again."""
    outputs = {
        output.id: (output.deprecated, component.id)
        for component, output in list_described_outputs(architecture)
        if output.deprecated and output.deprecated.target
    }
    yield from _find_circles(architecture, "output", outputs)
    types = {name: (each.deprecated, name) for name, each in architecture.types.items() if each.deprecated}
    yield from _find_circles(architecture, "type", types)
    component_types = {
        name: (each.deprecated, name) for name, each in architecture.component_types.items() if each.deprecated
    }
    yield from _find_circles(architecture, "component_type", component_types)


def _find_circles(
    architecture: Architecture, kind: str, holders: Mapping[str, tuple[Deprecation, str]]
) -> Iterator[Diagnostic]:
    judged: set[str] = set()
    for name in holders:
        way: list[str] = []
        current: str | None = name
        while current is not None and current not in judged and current not in way:
            way.append(current)
            deprecated = find_deprecation(architecture, kind, current)
            current = deprecated.target if deprecated else None
        if current is not None and current in way:
            circle = way[way.index(current) :]
            yield _diagnose_circle(kind, circle, [holders[each] for each in circle if each in holders])
        judged.update(way)


def _diagnose_circle(kind: str, circle: list[str], holders: list[tuple[Deprecation, str]]) -> Diagnostic:
    first, element = holders[0]
    names = [f"`{name}`" for name in circle[:_MAX_LISTED]]
    rest = ["..."] if len(circle) > _MAX_LISTED else []
    way = " > ".join([*names, *rest, names[0]])
    message = f"the {_KIND_WORDS[kind]} `{circle[0]}` is to be replaced by itself"
    return Diagnostic(
        "circular-replacement",
        message if len(circle) == 1 else f"{message}: {way}",
        first.use_at,
        labels=tuple(Label(deprecated.use_at, "and this") for deprecated, _ in holders[1:_MAX_LISTED]),
        help="name what is to stay, or leave `use` out",
        element=element,
    )


RULES = (
    (deprecated_use, Severity.WARNING),
    (expired_use, Severity.ERROR),
    (circular_replacement, Severity.ERROR),
)
