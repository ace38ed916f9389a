"""Override figures of timing without touching a file: `object_recognizer.timing.wcet=120 ms`.

What is not below `timing` (`box.threads=2`) is overridden by `process_overrides`.
"""

from __future__ import annotations

import re
from collections.abc import Iterable
from typing import Any, get_args

from archgen.diagnostics import NAMES_HELP, Diagnostic, did_you_mean
from archgen.frozen import dataclass, replace
from archgen.link import process_overrides
from archgen.link.process_overrides import OverrideError, ProcessOverride
from archgen.link.sanity_checks import drop_senseless
from archgen.model.architecture import Architecture
from archgen.model.declared_timing import (
    ActivityBehaviour,
    DroppedMessages,
    InputTiming,
    ResourceTime,
    Timing,
    Trigger,
)
from archgen.model.node import Node
from archgen.model.quantity import UNIT_FACTORS, parse_quantity

_DURATION, _FREQUENCY = "duration", "frequency"
_QUANTITY_KEYS = {
    "period": _DURATION,
    "rate": _FREQUENCY,
    "jitter": _DURATION,
    "wcet": _DURATION,
    "bcet": _DURATION,
    "throttle": _DURATION,
    "response": _DURATION,
    "deadline": _DURATION,
}
_COUNT_KEYS = ("every", "priority", "core")
_BEHAVIOUR_WORDS = get_args(ActivityBehaviour)
_WORD_KEYS = {"behaviour": _BEHAVIOUR_WORDS, "dropped": get_args(DroppedMessages)}
_PLAIN_KEYS = (*_QUANTITY_KEYS, *_COUNT_KEYS, "cores", "behaviour", "trigger", "dropped")
OVERRIDE_KEYS = (*_PLAIN_KEYS, "inputs.INPUT.wcet", "uses.RESOURCE")
"""The keys of `timing` that can be overridden, as help names them."""
_PART_KEYS = re.compile(r"inputs\.(?P<input>.+)\.(?P<bound>wcet|bcet)\Z|uses\.(?P<resource>[^.]+)(?P<least>\.min)?\Z")
"""Keys below a key of `timing`."""
_EXCLUSIVE_KEYS = {"rate": "period", "period": "rate", "core": "cores", "cores": "core", "wcet": "measured_times"}
"""Keys of which one replaces the other. What is measured is not measured of another `wcet`."""


@dataclass(frozen=True, slots=True)
class TimingOverride:
    """A new value for one key of one activity: a node's part for a component ("" if the node implements none)."""

    node: str
    component: str
    key: str
    value: Any

    def __str__(self) -> str:
        return f"{self.node}.timing.{self.key}={self.value}"


def apply_overrides(architecture: Architecture, override_texts: Iterable[str]) -> Architecture:
    """Return an architecture with overrides written as `ELEMENT.timing.KEY=VALUE` or `ELEMENT.KEY=VALUE`.

    Raises `OverrideError`.
    """
    for text in override_texts:
        for override in read_override(architecture, text):
            architecture = apply_override(architecture, override)
    # Only at the end: two overrides may make sense together that do not one by one, such as bcet and wcet both raised.
    _check_timing(architecture)
    return architecture


def read_override(architecture: Architecture, text: str) -> tuple[TimingOverride | ProcessOverride, ...]:
    """Parse one override text into an override for each activity that it concerns. Raises `OverrideError`."""
    path, equals, value = text.partition("=")
    process_override = process_overrides.read_process_override(architecture, path.strip(), value.strip())
    if equals and process_override is not None:
        return (process_override,)
    element, key = _split_path(path.strip())
    if not equals or not element:
        raise OverrideError(
            f"`{text}` is not ELEMENT.timing.KEY=VALUE, for instance object_recognizer.timing.wcet=120ms, nor "
            "ELEMENT.KEY=VALUE, for instance sensor_box.threads=2"
        )
    if not _is_key(key):
        guess = did_you_mean(key, OVERRIDE_KEYS)
        msg = f"`timing` has no key `{key}` that can be set" + (
            f"; {guess}" if guess else f": use {', '.join(OVERRIDE_KEYS)}"
        )
        raise OverrideError(msg)
    parsed_value = _parse_value(key, value.strip())
    overrides = tuple(
        TimingOverride(node, component, own_key, own_value)
        for node, component in _find_activities(architecture, element)
        if (own_key := _complete_key(architecture, component, key))
        and (own_value := _complete_value(architecture, component, parsed_value)) is not None
    )
    if not overrides:
        input_name = key.removeprefix("inputs.").rpartition(".")[0] if key != "trigger" else value.strip(" []")
        names = [port.name for port in architecture.inputs.values()]
        raise OverrideError(f"`{element}` has no input `{input_name}`; {did_you_mean(input_name, names) or NAMES_HELP}")
    return overrides


def _split_path(path: str) -> tuple[str, str]:
    """Return the element and the key below `timing`, empty where there is none. An id may itself be `timing`."""
    splits = [(path[: match.start()], path[match.end() :]) for match in re.finditer(r"(?=\.timing\.)", path)]
    splits = [(element, key.removeprefix(".timing.")) for element, key in splits]
    return next((split for split in splits if _is_key(split[1])), splits[-1] if splits else ("", ""))


def _is_key(key: str) -> bool:
    return key in _PLAIN_KEYS or _PART_KEYS.match(key) is not None


def _complete_key(architecture: Architecture, component: str, key: str) -> str | None:
    """Return a key with the complete id of the input in it; None where the component has no such input.

    Raises `OverrideError` for a resource that nothing declares.
    """
    match = _PART_KEYS.match(key)
    if match is None:
        return key
    if match["resource"]:
        if match["resource"] not in architecture.resources:
            guess = did_you_mean(match["resource"], architecture.resources)
            raise OverrideError(f"no resource is called `{match['resource']}`; {guess or NAMES_HELP}")
        return key
    port = f"{component}.{match['input'].rpartition('.')[2]}"
    is_meant = port in architecture.inputs and f".{port}".endswith(f".{match['input']}")
    return f"inputs.{port}.{match['bound']}" if is_meant else None


def _complete_value(architecture: Architecture, component: str, value: object) -> object | None:
    """Return a value with the complete ids of the inputs that it names; None where the component lacks one of them."""
    if not isinstance(value, Trigger) or value.inputs is None:
        return value
    ports = tuple(f"{component}.{name.rpartition('.')[2]}" for name in value.inputs)
    are_all_meant = all(
        port in architecture.inputs and f".{port}".endswith(f".{name}")
        for port, name in zip(ports, value.inputs, strict=True)
    )
    return replace(value, inputs=ports) if are_all_meant else None


def apply_override(architecture: Architecture, override: TimingOverride | ProcessOverride) -> Architecture:
    """Return an architecture with one value overridden.

    A rate removes the period, a set of cores the core, and the reverse; inputs that fire it its own clock.
    """
    if isinstance(override, ProcessOverride):
        return process_overrides.apply_process_override(architecture, override)
    node = architecture.nodes[override.node]
    timing = node.timing.get(override.component, Timing(at=node.at))
    key, value = _merge_part(timing, override)
    changes: dict[str, Any] = {key: value}
    if key in _EXCLUSIVE_KEYS:
        changes[_EXCLUSIVE_KEYS[key]] = None
    if isinstance(value, Trigger) and value.inputs is not None:
        # What inputs fire has no clock of its own any more.
        changes |= {"behaviour": "event", "period": None, "rate": None}
    kept_places = {name: span for name, span in timing.places.items() if changes.get(name, name) is not None}
    new_timing = replace(timing, **changes, places={**kept_places, key: timing.places.get(key, timing.at)})
    new_node = replace(node, timing={**node.timing, override.component: new_timing})
    return replace(architecture, nodes={**architecture.nodes, node.id: new_node})


def _merge_part(timing: Timing, override: TimingOverride) -> tuple[str, Any]:
    """Return the key of `timing` that changes, and its new value: with all else that is written below it."""
    match = _PART_KEYS.match(override.key)
    if match is None:
        return override.key, override.value
    if match["input"]:
        input_timing = timing.inputs.get(match["input"], InputTiming())
        changed_input = replace(input_timing, **{match["bound"]: override.value})
        return "inputs", {**timing.inputs, match["input"]: changed_input}
    resource_time = timing.uses.get(match["resource"])
    if match["least"] and resource_time is None:
        msg = f"`{override.node}` does not use `{match['resource']}`: set `uses.{match['resource']}` first"
        raise OverrideError(msg)
    if match["least"] and resource_time is not None:
        changed_time = replace(resource_time, min=override.value)
    else:
        changed_time = ResourceTime(override.value, resource_time.min if resource_time else None)
    return "uses", {**timing.uses, match["resource"]: changed_time}


def _parse_value(key: str, text: str) -> object:
    dimension = _QUANTITY_KEYS.get(key, None if key in _PLAIN_KEYS else _DURATION)
    if dimension is not None:
        parsed_value: object | None = parse_quantity(text, dimension)
        expected = f"a {dimension} such as {'120 ms' if dimension == _DURATION else '10 Hz'}"
        expected += f" (units: {' '.join(UNIT_FACTORS[dimension])})"
    elif key in _COUNT_KEYS:
        parsed_value, expected = process_overrides.parse_count(text), "a whole number"
    elif key == "cores":
        parsed_value, expected = process_overrides.parse_counts(text), "whole numbers, such as 2, 3"
    elif key == "trigger":
        names = process_overrides.split_list(text) if text.startswith("[") else []
        plain_trigger = Trigger(text) if text in {"any", "all"} else None  # type: ignore[arg-type]
        parsed_value = Trigger("any", tuple(names)) if names else plain_trigger
        expected = "any, all, or inputs, such as [scan]"
    else:
        parsed_value, expected = text if text in _WORD_KEYS[key] else None, ", ".join(_WORD_KEYS[key])
    return process_overrides.require_value(key, text, parsed_value, expected)


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
    if not components and element in architecture.component_types:
        return _list_instance_activities(architecture, element)
    if not components and element in architecture.shells:
        leaves = ", ".join(architecture.leaves_of(element)[:6])
        raise OverrideError(f"`{element}` is composed: name a component inside ({leaves})")
    if len(components) != 1:
        names = [*architecture.nodes, *architecture.components, *architecture.component_types]
        guess = did_you_mean(element, [candidate for name in names for candidate in (name, name.rpartition(".")[2])])
        message = (
            f"`{element}` may mean {', '.join(components[:6])}" if components else f"nothing is called `{element}`"
        )
        raise OverrideError(message if components else f"{message}; {guess or NAMES_HELP}")
    nodes: list[Node] = list(architecture.nodes_implementing(components[0]))
    if not nodes:
        raise OverrideError(f"no node implements `{components[0]}`: its timing counts nowhere")
    if len(nodes) != 1:
        names = [node.id for node in nodes]
        msg = f"{len(nodes)} nodes implement `{components[0]}`: name one of them ({', '.join(names[:6])})"
        raise OverrideError(msg)
    return ((nodes[0].id, components[0]),)


def _list_instance_activities(architecture: Architecture, type_name: str) -> tuple[tuple[str, str], ...]:
    """Return the activities of all instances of a component type, and of types that are made from it."""
    instances = [
        each
        for each in architecture.components.values()
        if any(base.id == type_name for base in architecture.list_bases(each.type_name))
    ]
    activities = tuple((node.id, each.id) for each in instances for node in architecture.nodes_implementing(each.id))
    if not activities:
        reason = (
            "no node implements one of its instances" if instances else "it has no instance without components inside"
        )
        raise OverrideError(f"`{type_name}` is a component type, and {reason}: its timing counts nowhere")
    return activities


def _check_timing(architecture: Architecture) -> None:
    """Raise `OverrideError` for figures that a file could not state either."""
    for node in architecture.nodes.values():
        for timing in node.timing.values():
            # drop_senseless reads the position of every figure that it reports; an overridden one may have none.
            spans = {key: timing.places.get(key, timing.at) for key in (*_PLAIN_KEYS, "inputs", "uses")}
            diagnostics: list[Diagnostic] = []
            drop_senseless(replace(timing, places=spans), node.id, diagnostics)
            for diagnostic in diagnostics:
                raise OverrideError(
                    f"{node.id}: {diagnostic.message}" + (f"; {diagnostic.help}" if diagnostic.help else "")
                )
            _check_bounds(node.id, timing)


def _check_bounds(node_id: str, timing: Timing) -> None:
    """Raise `OverrideError` for a part of `timing` whose shortest time is above its longest, or a deadline of zero."""
    bounds = [(f"inputs.{port}", each.bcet, each.wcet) for port, each in timing.inputs.items()]
    bounds += [(f"uses.{resource}", each.min, each.max) for resource, each in timing.uses.items()]
    for name, least, most in bounds:
        if least is not None and most is not None and least.value > most.value:
            raise OverrideError(f"{node_id}: the shortest time of `{name}` ({least}) is above the longest ({most})")
    if timing.deadline is not None and not timing.deadline.value:
        raise OverrideError(f"{node_id}: `deadline` cannot be zero")
