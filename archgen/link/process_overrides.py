"""Override how processes, hosts and resources run what is on them, without touching a file: `sensor_box.threads=2`.

Read the values of overrides, and say what is wrong with them.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from archgen.diagnostics import did_you_mean, join_words
from archgen.diagnostics.rule_options import parse_percentage
from archgen.frozen import dataclass, replace
from archgen.model.architecture import Architecture
from archgen.model.declared_timing import EXECUTOR_ORDERS, HOST_ORDERS, RESOURCE_ORDERS, FairScheduling
from archgen.model.deployment import Container, Host
from archgen.model.node import Node
from archgen.model.quantity import parse_quantity

_ORDERS = {"nodes": EXECUTOR_ORDERS, "containers": EXECUTOR_ORDERS, "hosts": HOST_ORDERS, "resources": RESOURCE_ORDERS}
_KEYS: Mapping[str, tuple[str, ...]] = {
    "nodes": ("threads", "scheduling", "reentrant", "callback_groups", "host", "container"),
    "containers": ("threads", "scheduling", "host"),
    "hosts": ("cores", "scheduling"),
    "resources": ("scheduling",),
}
"""The keys of each section that can be overridden."""
_ALL_KEYS = tuple(dict.fromkeys(key for keys in _KEYS.values() for key in keys))
NO_CONTAINER = "none"
"""What `container` is set to for a process of its own."""


@dataclass(frozen=True, slots=True)
class ProcessOverride:
    """A new value for one key of a node, container, host or resource; `part` is the callback group or the core."""

    section: str
    element_id: str
    key: str
    part: str
    value: Any


def read_process_override(architecture: Architecture, path: str, text: str) -> ProcessOverride | None:
    """Parse `ELEMENT.KEY` (the element's section may stand in front) and a value; None where it is no such path.

    Raises `OverrideError` for an element or a value that does not fit.
    """
    words = path.split(".")
    sections = [section for section in _KEYS if words[0] == section and words[2:]]
    element_id, *rest = words[1:] if sections else words
    if not rest or rest[0] not in _ALL_KEYS or "timing" in rest:
        return None
    key, part = rest[0], ".".join(rest[1:])
    fitting = [s for s in sections or _KEYS if key in _KEYS[s] and element_id in getattr(architecture, s)]
    if len(fitting) != 1:
        raise OverrideError(_explain_no_element(architecture, element_id, key, fitting))
    value = _parse_value(architecture, fitting[0], element_id, key, part, text)
    override = ProcessOverride(fitting[0], element_id, key, part, value)
    _refuse_in_container(architecture, override)
    return override


def _explain_no_element(architecture: Architecture, element_id: str, key: str, fitting: list[str]) -> str:
    if fitting:
        paths = join_words([f"`{section}.{element_id}.{key}`" for section in fitting], "or")
        return f"`{element_id}.{key}` can mean {paths}"
    names = [name for section, keys in _KEYS.items() if key in keys for name in getattr(architecture, section)]
    kinds = join_words([section.removesuffix("s") for section, keys in _KEYS.items() if key in keys], "or")
    guess = did_you_mean(element_id, names)
    return f"no {kinds} is called `{element_id}`" + (f"; {guess}" if guess else "")


def _parse_value(  # noqa: PLR0913, PLR0917 - the parts of one override
    architecture: Architecture, section: str, element_id: str, key: str, part: str, text: str
) -> object:
    name = f"{key}.{part}" if part else key
    value: object | None
    if key == "callback_groups":
        components = architecture.nodes[element_id].implements
        value = _find_members(components, split_list(text)) if part else None
        expected = f"components of `{element_id}`, as in callback_groups.GROUP={components[0] if components else 'a'}"
    elif part and (section, key) != ("hosts", "scheduling"):
        value, expected = None, "a value of its own, without a part below it"
    elif key == "scheduling" and part.startswith("fair."):
        value, expected = _parse_fair_figure(part.removeprefix("fair."), text)
    elif key == "scheduling":
        is_core = not part or parse_count(part) is not None
        value = text if text in _ORDERS[section] and is_core else None
        expected = ", ".join(_ORDERS[section]) + (", by host or by the number of a core" if section == "hosts" else "")
    elif key == "host":
        value = text if text in architecture.hosts else None
        expected = "a host" + (f"; {guess}" if (guess := did_you_mean(text, architecture.hosts)) else "")
    elif key == "container":
        value = text if text in architecture.containers or text == NO_CONTAINER else None
        guess = did_you_mean(text, architecture.containers)
        expected = f"a container, or `{NO_CONTAINER}` for a process of its own" + (f"; {guess}" if guess else "")
    elif key == "reentrant":
        value, expected = {"true": True, "false": False}.get(text), "true or false"
    else:
        value, expected = parse_count(text) or None, "a whole number from 1"
    return require_value(name, text, value, expected)


def _parse_fair_figure(name: str, text: str) -> tuple[object | None, str]:
    """Return a figure of a fair order, None where it is none, and what is expected."""
    if name in {"slice", "tick"}:
        return parse_quantity(text, "duration"), "a duration, such as 3 ms"
    if name == "lead":
        return parse_count(text) or None, "a whole number from 1"
    share = parse_percentage(text) if name == "other_load" else None
    expected = (
        "a share below 100 %" if name == "other_load" else "one of fair.slice, fair.tick, fair.lead, fair.other_load"
    )
    return share if share is not None and share < 1 else None, expected


def _find_members(components: tuple[str, ...], names: list[str]) -> tuple[str, ...] | None:
    """Return the components that names mean; None where one of them means none or several."""
    matches = [[c for c in components if c == name or c.endswith(f".{name}")] for name in names]
    return tuple(match[0] for match in matches) if matches and all(len(match) == 1 for match in matches) else None


def _refuse_in_container(architecture: Architecture, override: ProcessOverride) -> None:
    if override.section == "nodes" and override.key in {"threads", "scheduling", "host"}:
        container = architecture.nodes[override.element_id].container
        if container:
            msg = f"`{override.element_id}` runs in the container `{container}`: set `containers.{container}.{override.key}`"
            raise OverrideError(msg)


def apply_process_override(architecture: Architecture, override: ProcessOverride) -> Architecture:
    """Return an architecture with one value overridden."""
    elements = getattr(architecture, override.section)
    element = elements[override.element_id]
    changes: dict[str, Any] = {override.key: override.value}
    if isinstance(element, Host) and override.key == "scheduling":
        changes = _change_orders(element, override)
    elif isinstance(element, Node) and override.key == "callback_groups":
        changes = _change_groups(element, override)
    elif isinstance(element, Container) and override.key == "host":
        # A node without a host of its own has its container's.
        nodes = {
            node.id: replace(node, host=override.value) if node.container == element.id else node
            for node in architecture.nodes.values()
        }
        architecture = replace(architecture, nodes=nodes)
    elif isinstance(element, Node) and override.key == "container":
        changes = _change_container(architecture, element, override.value)
    elif override.key == "reentrant" and override.value:
        changes["callback_groups"] = {}
    changed_section: dict[str, Any] = {override.section: {**elements, override.element_id: replace(element, **changes)}}
    return replace(architecture, **changed_section)


def _change_orders(host: Host, override: ProcessOverride) -> dict[str, Any]:
    if not override.part:
        return {"scheduling": override.value}
    if override.part.startswith("fair."):
        figure = {override.part.removeprefix("fair."): override.value}
        return {"scheduling": "fair", "fair": replace(host.fair or FairScheduling(), **figure)}
    return {"core_scheduling": {**host.core_scheduling, int(override.part): override.value}}


def _change_container(architecture: Architecture, node: Node, name: str) -> dict[str, Any]:
    """Return the container of a node, and the host that it has by it; a process of its own stays where it was."""
    container = architecture.containers.get(name)
    return {"container": container.id, "host": container.host or node.host} if container else {"container": None}


def _change_groups(node: Node, override: ProcessOverride) -> dict[str, Any]:
    """Return the callback groups with one of them as overridden: its components leave their other groups."""
    other_groups = {
        name: remaining
        for name, members in node.callback_groups.items()
        if name != override.part
        and (remaining := tuple(component for component in members if component not in override.value))
    }
    return {"callback_groups": {**other_groups, override.part: override.value}, "reentrant": False}


_MAX_COUNT_DIGITS = 9


class OverrideError(ValueError):
    """A figure cannot be overridden; the message says why."""


def parse_count(text: str) -> int | None:
    """Return a whole number, None for any other text."""
    return int(text) if text.isascii() and text.isdigit() and len(text) <= _MAX_COUNT_DIGITS else None


def parse_counts(text: str) -> tuple[int, ...] | None:
    """Return a list of whole numbers in ascending order, each once; None for any other text."""
    numbers = [parse_count(word) for word in split_list(text)]
    return (
        tuple(sorted({number for number in numbers if number is not None})) if numbers and None not in numbers else None
    )


def split_list(text: str) -> list[str]:
    """Return the entries of a list as files have it; its brackets may be left out."""
    inner = text[1:-1] if text.startswith("[") and text.endswith("]") else text
    return [word.strip() for word in inner.split(",")] if inner.strip() else []


def require_value(key: str, text: str, parsed_value: object | None, expected: str) -> object:
    """Return a value that could be read. Raises `OverrideError` where it is None."""
    if parsed_value is not None:
        return parsed_value
    digits_hint = "; that has too many digits" if sum(map(str.isdigit, text)) > _MAX_COUNT_DIGITS else ""
    raise OverrideError(f"`{key}` takes {expected}, not `{text}`{digits_hint}")
