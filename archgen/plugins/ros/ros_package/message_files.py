"""Messages, services and actions of a package as types with fields."""

from __future__ import annotations

import re
from collections.abc import Mapping
from typing import Any

from archgen.plugin.findings import Diagnostic
from archgen.plugin.importing import node_to_data, parse_yaml, resolve_scalar
from archgen.plugin.ros import (
    Interface,
    InterfaceConstant,
    InterfaceField,
    load_shipped_interfaces,
    parse_interface_definition,
)

_HUMP = re.compile(r"(?<=[a-z0-9])(?=[A-Z])|(?<=[A-Z]{2})(?=[A-Z][a-z])")


def make_type_name(message: str) -> str:
    """Return how people call a message: `PlanGrasp` is `Plan grasp`."""
    words = _HUMP.sub(" ", message.rpartition("/")[2].replace("_", " ")).split()
    rest = (word if word.isupper() or not word[1:].islower() else word.lower() for word in words[1:])
    return " ".join([words[0], *rest]) if words else message


def read_message_definition(
    text: str, message: str, shown_path: str, *, is_ros_1: bool, distro: str | None = None
) -> tuple[dict[str, Any], tuple[Diagnostic, ...]]:
    """Return the type that a definition makes, and what is wrong in it. Lines that ROS refuses are left out.

    `distro` is the distribution that the workspace is for, where one is known: it may hold newer messages than that.
    """
    definition = parse_interface_definition(text, message, shown_path, ros1=is_ros_1)
    interface = definition.interface
    data: dict[str, Any] = {"message": message}
    if message in load_shipped_interfaces(distro).names:
        # archgen knows what is in it: written once more it would be another one.
        return data, definition.diagnostics
    if interface.comment.strip():
        data["comment"] = interface.comment.strip()
    if len(interface.parts) == 1:
        data["fields"] = _write_fields(interface, 0)
        data["constants"] = _write_constants(interface, 0)
    else:
        for number, part_name in enumerate(interface.part_names):
            data[_PART_KEYS[part_name]] = _write_fields(interface, number)
    return {
        key: value for key, value in data.items() if value or key not in {"comment", "constants"}
    }, definition.diagnostics


_PART_KEYS = {
    "request": "request",
    "response": "response",
    "goal": "request",
    "result": "response",
    "feedback": "feedback",
}


def _write_fields(interface: Interface, number: int) -> dict[str, Any]:
    return {each.name: _write_field(each) for each in interface.parts[number]}


def _write_field(each: InterfaceField) -> Any:  # noqa: ANN401 - the short or the long form
    type_name = f"{each.type}{each.array}"
    more = {"default": _read_literal(each.default) if each.default else None, "comment": each.comment or None}
    kept = {key: value for key, value in more.items() if value is not None}
    return {"type": type_name, **kept} if kept else type_name


def _write_constants(interface: Interface, number: int) -> dict[str, Any]:
    constants = interface.constants[number] if interface.constants else ()
    return {each.name: _write_constant(each) for each in constants}


def _write_constant(each: InterfaceConstant) -> Mapping[str, Any]:
    value = each.value.strip("'\"") if each.type.startswith(("string", "wstring")) else _read_literal(each.value)
    return {"type": each.type, "value": value, **({"comment": each.comment} if each.comment else {})}


def _read_literal(text: str) -> Any:  # noqa: ANN401 - a value of any type
    stripped = text.strip()
    if stripped[:1] in {"[", '"', "'"}:
        document, problems = parse_yaml("value", f"value: {stripped}")
        node = document.root.get("value") if document and not problems else None
        return text if node is None else node_to_data(node)
    return resolve_scalar(stripped) if stripped else text
