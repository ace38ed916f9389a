"""What hints tell the start-up: under which address a computer is found, and which image holds a program."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from archgen.plugin.findings import NO_SPAN, Diagnostic, Span, did_you_mean, first_written_span
from archgen.plugin.generating import tell_left_out
from archgen.plugin.model import Architecture, ElementAnnotations

_BACKEND = "start"


def read_hint(annotations: ElementAnnotations, key: str) -> str:
    """Return what `hints: {start: {KEY: ...}}` of an element says; empty where it says nothing of that."""
    hints = annotations.hints.get(_BACKEND)
    value = hints.get(key) if isinstance(hints, Mapping) else None
    return value.strip() if isinstance(value, str) else ""


def find_unread_hints(architecture: Architecture) -> Iterator[Diagnostic]:
    """Yield the hints for the start-up that nobody reads: unknown ones, and those that are no text."""
    for host in architecture.hosts.values():
        yield from _judge_hints(host.id, host.annotations, host.at, ("address", "image"))
    for container in architecture.containers.values():
        yield from _judge_hints(container.id, container.annotations, container.at, ("image",))
    for node in architecture.nodes.values():
        yield from _judge_hints(node.id, node.annotations, node.at, ("image",))


def _judge_hints(
    element: str, annotations: ElementAnnotations, at: Span, known_keys: tuple[str, ...]
) -> Iterator[Diagnostic]:
    hints = annotations.hints.get(_BACKEND)
    if hints is None:
        return
    places = annotations.hint_places
    place = first_written_span(places.get((_BACKEND,), NO_SPAN), at)
    known = f"what is known here is {' and '.join(f'`{key}`' for key in known_keys)}, each a text"
    if not isinstance(hints, Mapping):
        yield tell_left_out(
            f"the hints of `{element}` for `start` are no mapping", place, element=element, help_line=known
        )
        return
    for key, value in hints.items():
        key_place = first_written_span(places.get((_BACKEND, key), NO_SPAN), place)
        if key not in known_keys:
            message = f"nobody reads the hint `{key}` of `{element}` for `start`"
            yield tell_left_out(
                message, key_place, element=element, help_line=did_you_mean(str(key), known_keys) or known
            )
        elif not isinstance(value, str) or not value.strip():
            message = f"the hint `{key}` of `{element}` for `start` is no text"
            yield tell_left_out(message, key_place, element=element, help_line=known)
