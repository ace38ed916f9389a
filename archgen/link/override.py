"""Override figures of timing without touching a file: `object_recognizer.timing.wcet=120 ms`."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import replace
from typing import Any

from archgen.diagnostic import Diagnostic
from archgen.frozen import dataclass
from archgen.link.sense import sound
from archgen.model.architecture import Architecture
from archgen.model.node import Node
from archgen.model.quantity import UNITS, parse
from archgen.model.timing import Timing, Trigger
from archgen.source import NOWHERE
from archgen.suggest import did_you_mean

_DURATION, _FREQUENCY = "duration", "frequency"
_QUANTITIES = {
    "period": _DURATION,
    "rate": _FREQUENCY,
    "jitter": _DURATION,
    "wcet": _DURATION,
    "bcet": _DURATION,
    "throttle": _DURATION,
    "response": _DURATION,
}
_COUNTS = ("every", "priority", "core")
_BEHAVIOURS = ("periodic", "event", "on_demand", "once")
KEYS = (*_QUANTITIES, *_COUNTS, "behaviour", "trigger")
"""The keys of `timing` that can be overridden."""
_COUNT_LENGTH = 9


class OverrideError(ValueError):
    """A figure cannot be overridden; the message says why."""


@dataclass(frozen=True, slots=True)
class Assignment:
    """A new value for one key of one activity: a node's part for a component ("" if the node implements none)."""

    node: str
    component: str
    key: str
    value: Any

    def __str__(self) -> str:
        return f"{self.node}.timing.{self.key}={self.value}"


def lay(architecture: Architecture, written: Iterable[str]) -> Architecture:
    """Return an architecture with overrides written as `ELEMENT.timing.KEY=VALUE`. Raises `OverrideError`."""
    for text in written:
        for assignment in read(architecture, text):
            architecture = assigned(architecture, assignment)
    # Only at the end: two overrides may make sense together that do not one by one, such as bcet and wcet both raised.
    _judge(architecture)
    return architecture


def read(architecture: Architecture, text: str) -> tuple[Assignment, ...]:
    """Parse one override text into an override for each activity that it concerns. Raises `OverrideError`."""
    # From the right: an id may itself be `timing`.
    path, equals, value = text.partition("=")
    element, dot, key = path.strip().rpartition(".timing.")
    if not equals or not dot or not element:
        msg = f"`{text}` is not ELEMENT.timing.KEY=VALUE, for instance object_recognizer.timing.wcet=120ms"
        raise OverrideError(msg)
    if key not in KEYS:
        guess = did_you_mean(key, KEYS)
        msg = f"`timing` has no key `{key}` that can be set" + (f"; {guess}" if guess else f": use {', '.join(KEYS)}")
        raise OverrideError(msg)
    made = _value(key, value.strip())
    return tuple(Assignment(node, component, key, made) for node, component in _activities(architecture, element))


def assigned(architecture: Architecture, assignment: Assignment) -> Architecture:
    """Return an architecture with one value overridden; overriding the rate removes the period, and the reverse."""
    node = architecture.nodes[assignment.node]
    timing = node.timing.get(assignment.component, Timing(at=node.at))
    changes = {assignment.key: assignment.value}
    if assignment.key in {"rate", "period"}:
        changes["period" if assignment.key == "rate" else "rate"] = None
    places = {key: at for key, at in timing.places.items() if changes.get(key, key) is not None}
    made = replace(timing, **changes, places={**places, assignment.key: timing.places.get(assignment.key, timing.at)})
    changed = replace(node, timing={**node.timing, assignment.component: made})
    return replace(architecture, nodes={**architecture.nodes, node.id: changed})


def _value(key: str, text: str) -> object:
    readers: Mapping[str, Callable[[str], object | None]] = {
        "behaviour": lambda word: word if word in _BEHAVIOURS else None,
        "trigger": lambda word: Trigger(word, None, NOWHERE) if word in {"any", "all"} else None,  # type: ignore[arg-type]
    }
    if key in _QUANTITIES:
        made: object | None = parse(text, _QUANTITIES[key])
        wanted = f"a {_QUANTITIES[key]} such as {'120 ms' if _QUANTITIES[key] == _DURATION else '10 Hz'}"
        wanted += f" (units: {' '.join(UNITS[_QUANTITIES[key]])})"
    elif key in _COUNTS:
        made, wanted = _count(text), "a whole number"
    else:
        made = readers[key](text)
        wanted = "any or all" if key == "trigger" else ", ".join(_BEHAVIOURS)
    if made is None:
        long = "; that has too many digits" if sum(map(str.isdigit, text)) > _COUNT_LENGTH else ""
        msg = f"`{key}` takes {wanted}, not `{text}`{long}"
        raise OverrideError(msg)
    return made


def _count(text: str) -> int | None:
    return int(text) if text.isascii() and text.isdigit() and len(text) <= _COUNT_LENGTH else None


def _activities(architecture: Architecture, element: str) -> tuple[tuple[str, str], ...]:
    """Return the activities (node, component) of an element: a node, `node.component`, or a component with one node."""
    node = architecture.nodes.get(element)
    if node is not None:
        return tuple((node.id, component) for component in node.implements or ("",))
    first, _, rest = element.partition(".")
    if rest and first in architecture.nodes:
        parts = architecture.nodes[first].implements
        found = [one for one in parts if one == rest or one.rpartition(".")[2] == rest]
        if len(found) == 1:
            return ((first, found[0]),)
    return _of_component(architecture, element)


def _of_component(architecture: Architecture, element: str) -> tuple[tuple[str, str], ...]:
    components = [name for name in architecture.components if name == element or name.endswith(f".{element}")]
    if element in architecture.components:
        components = [element]
    if len(components) != 1:
        names = [*architecture.nodes, *architecture.components]
        guess = did_you_mean(element, [part for name in names for part in (name, name.rpartition(".")[2])])
        said = f"`{element}` may mean {', '.join(components[:6])}" if components else f"nothing is called `{element}`"
        raise OverrideError(
            said if components else f"{said}; {guess or '`archgen list` gives the names of all elements'}"
        )
    nodes: list[Node] = list(architecture.implementers(components[0]))
    if len(nodes) != 1:
        names = [node.id for node in nodes]
        msg = f"{len(nodes)} nodes implement `{components[0]}`: name one of them ({', '.join(names[:6])})"
        raise OverrideError(msg)
    return ((nodes[0].id, components[0]),)


def _judge(architecture: Architecture) -> None:
    """Raise `OverrideError` for figures that a file could not state either."""
    for node in architecture.nodes.values():
        for timing in node.timing.values():
            # drop_senseless reads the position of every figure that it reports; an overridden one may have none.
            places = {key: timing.places.get(key, timing.at) for key in KEYS}
            found: list[Diagnostic] = []
            sound(replace(timing, places=places), node.id, found)
            for wrong in found:
                raise OverrideError(f"{node.id}: {wrong.message}" + (f"; {wrong.help}" if wrong.help else ""))
