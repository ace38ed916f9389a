"""Override figures of timing without touching a file: `object_recognizer.timing.wcet=120 ms`."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import replace
from typing import get_args

from archgen.diagnostics.diagnostic import Diagnostic
from archgen.diagnostics.source_span import NO_SPAN
from archgen.diagnostics.suggestions import NAMES_HELP, did_you_mean
from archgen.link.sanity_checks import drop_senseless
from archgen.model.architecture import Architecture
from archgen.model.declared_timing import ActivityBehaviour, Trigger
from archgen.model.node import Node
from archgen.model.quantity import UNIT_FACTORS, parse_quantity
from archgen.model.timing_override import ArchitectureOverride, ThreadsOverride, TimingOverride, apply_override

_DURATION, _FREQUENCY = "duration", "frequency"
_QUANTITY_KEYS = {
    "period": _DURATION,
    "rate": _FREQUENCY,
    "jitter": _DURATION,
    "wcet": _DURATION,
    "bcet": _DURATION,
    "throttle": _DURATION,
    "response": _DURATION,
}
_COUNT_KEYS = ("every", "priority", "core")
_BEHAVIOUR_WORDS = get_args(ActivityBehaviour)
OVERRIDE_KEYS = (*_QUANTITY_KEYS, *_COUNT_KEYS, "behaviour", "trigger")
"""The keys of `timing` that can be overridden."""
_MAX_COUNT_DIGITS = 9


class OverrideError(ValueError):
    """A figure cannot be overridden; the message says why."""


def apply_overrides(architecture: Architecture, override_texts: Iterable[str]) -> Architecture:
    """Return an architecture with overrides written as `ELEMENT.timing.KEY=VALUE`. Raises `OverrideError`."""
    for text in override_texts:
        for override in read_override(architecture, text):
            architecture = apply_override(architecture, override)
    # Only at the end: two overrides may make sense together that do not one by one, such as bcet and wcet both raised.
    _check_timing(architecture)
    return architecture


def read_override(architecture: Architecture, text: str) -> tuple[ArchitectureOverride, ...]:
    """Parse one override text into an override for each activity that it concerns. Raises `OverrideError`."""
    # From the right: an id may itself be `timing`.
    path, equals, value = text.partition("=")
    if equals and ".timing." not in path and path.strip().endswith(".threads"):
        return (_read_threads(architecture, path.strip().removesuffix(".threads"), value.strip()),)
    element, dot, key = path.strip().rpartition(".timing.")
    if not equals or not dot or not element:
        msg = f"`{text}` is not ELEMENT.timing.KEY=VALUE, for instance object_recognizer.timing.wcet=120ms"
        raise OverrideError(msg)
    if key not in OVERRIDE_KEYS:
        guess = did_you_mean(key, OVERRIDE_KEYS)
        msg = f"`timing` has no key `{key}` that can be set" + (
            f"; {guess}" if guess else f": use {', '.join(OVERRIDE_KEYS)}"
        )
        raise OverrideError(msg)
    parsed_value = _parse_value(key, value.strip())
    return tuple(
        TimingOverride(node, component, key, parsed_value)
        for node, component in _find_activities(architecture, element)
    )


def _read_threads(architecture: Architecture, element: str, text: str) -> ThreadsOverride:
    """Return another number of threads of a container. Raises `OverrideError`."""
    if element not in architecture.containers:
        guess = did_you_mean(element, architecture.containers)
        msg = f"no container is called `{element}`" + (f"; {guess}" if guess else "")
        raise OverrideError(msg)
    threads = _parse_count(text)
    if not threads:
        msg = f"`threads` takes a whole number from 1 on, not `{text}`"
        raise OverrideError(msg)
    return ThreadsOverride(element, "container", threads)


def _parse_value(key: str, text: str) -> object:
    readers: Mapping[str, Callable[[str], object | None]] = {
        "behaviour": lambda word: word if word in _BEHAVIOUR_WORDS else None,
        "trigger": lambda word: Trigger(word, None, NO_SPAN) if word in {"any", "all"} else None,  # type: ignore[arg-type]
    }
    if key in _QUANTITY_KEYS:
        parsed_value: object | None = parse_quantity(text, _QUANTITY_KEYS[key])
        expected = f"a {_QUANTITY_KEYS[key]} such as {'120 ms' if _QUANTITY_KEYS[key] == _DURATION else '10 Hz'}"
        expected += f" (units: {' '.join(UNIT_FACTORS[_QUANTITY_KEYS[key]])})"
    elif key in _COUNT_KEYS:
        parsed_value, expected = _parse_count(text), "a whole number"
    else:
        parsed_value = readers[key](text)
        expected = "any or all" if key == "trigger" else ", ".join(_BEHAVIOUR_WORDS)
    if parsed_value is None:
        digits_hint = "; that has too many digits" if sum(map(str.isdigit, text)) > _MAX_COUNT_DIGITS else ""
        msg = f"`{key}` takes {expected}, not `{text}`{digits_hint}"
        raise OverrideError(msg)
    return parsed_value


def _parse_count(text: str) -> int | None:
    return int(text) if text.isascii() and text.isdigit() and len(text) <= _MAX_COUNT_DIGITS else None


def _find_activities(architecture: Architecture, element: str) -> tuple[tuple[str, str], ...]:
    """Return the activities (node, component) of an element: a node, `node.component`, or a component with one node."""
    node = architecture.nodes.get(element)
    if node is not None:
        return tuple((node.id, component) for component in node.implements or ("",))
    node_id, _, component_text = element.partition(".")
    if component_text and node_id in architecture.nodes:
        components = architecture.nodes[node_id].implements
        matching_components = [
            component_id
            for component_id in components
            if component_id == component_text or component_id.rpartition(".")[2] == component_text
        ]
        if len(matching_components) == 1:
            return ((node_id, matching_components[0]),)
    return _find_component_activity(architecture, element)


def _find_component_activity(architecture: Architecture, element: str) -> tuple[tuple[str, str], ...]:
    components = [name for name in architecture.components if name == element or name.endswith(f".{element}")]
    if element in architecture.components:
        components = [element]
    if len(components) != 1:
        names = [*architecture.nodes, *architecture.components]
        guess = did_you_mean(element, [candidate for name in names for candidate in (name, name.rpartition(".")[2])])
        message = (
            f"`{element}` may mean {', '.join(components[:6])}" if components else f"nothing is called `{element}`"
        )
        raise OverrideError(message if components else f"{message}; {guess or NAMES_HELP}")
    nodes: list[Node] = list(architecture.nodes_implementing(components[0]))
    if not nodes:
        msg = f"no node implements `{components[0]}`: its timing counts nowhere"
        raise OverrideError(msg)
    if len(nodes) != 1:
        names = [node.id for node in nodes]
        msg = f"{len(nodes)} nodes implement `{components[0]}`: name one of them ({', '.join(names[:6])})"
        raise OverrideError(msg)
    return ((nodes[0].id, components[0]),)


def _check_timing(architecture: Architecture) -> None:
    """Raise `OverrideError` for figures that a file could not state either."""
    for node in architecture.nodes.values():
        for timing in node.timing.values():
            # drop_senseless reads the position of every figure that it reports; an overridden one may have none.
            spans = {key: timing.places.get(key, timing.at) for key in OVERRIDE_KEYS}
            diagnostics: list[Diagnostic] = []
            drop_senseless(replace(timing, places=spans), node.id, diagnostics)
            for diagnostic in diagnostics:
                raise OverrideError(
                    f"{node.id}: {diagnostic.message}" + (f"; {diagnostic.help}" if diagnostic.help else "")
                )
