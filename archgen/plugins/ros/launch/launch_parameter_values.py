"""Parameters as launch files give them: values with their types, commands whose output is the value, and files."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from archgen.plugin.importing import node_to_data, parse_yaml, resolve_scalar
from archgen.plugins.ros.launch.command_words import split_words
from archgen.plugins.ros.launch.launch_context import LaunchContext
from archgen.plugins.ros.launch.launch_values import (
    OPEN,
    LaunchValue,
    Substitution,
    UnknownValue,
    describe_launch_value,
    name_object,
)

_MAX_DEPTH = 20
_PARAMETER_TYPES = {
    "str": "text",
    "string": "text",
    "yaml": "yaml",
    "int": "plain",
    "integer": "plain",
    "double": "float",
}


class CommandWords(list[str]):
    """The words of a command whose output is the value."""


def evaluate_parameter(value: LaunchValue, context: LaunchContext, depth: int = 0) -> Any:  # noqa: ANN401
    """Return the value of a parameter as data; CommandWords or an UnknownValue, in mappings too, where it is no plain value."""
    if depth > _MAX_DEPTH:
        return UnknownValue("values nested very deep")
    if isinstance(value, UnknownValue) or value is None or isinstance(value, bool | int | float | str):
        return value
    if isinstance(value, Mapping):
        return _evaluate_mapping(value, context, depth)
    if isinstance(value, list | tuple):
        if any(isinstance(item, Substitution) for item in value) and not any(
            isinstance(item, bool | int | float) for item in value
        ):
            # As launch_ros has it: texts and substitutions in one list are one text.
            return evaluate_parameter(Substitution("join", tuple(value)), context, depth + 1)
        items = [
            context.resolve(item) if isinstance(item, list | tuple) else evaluate_parameter(item, context, depth + 1)
            for item in value
        ]
        return next((item for item in items if isinstance(item, UnknownValue)), items)
    return _evaluate_substitution(value, context) if isinstance(value, Substitution) else name_object(value)


def _evaluate_mapping(value: Mapping[Any, LaunchValue], context: LaunchContext, depth: int) -> dict[str, Any]:
    found: dict[str, Any] = {}
    for raw_key, raw_value in value.items():
        key = context.resolve(raw_key)
        if isinstance(key, str):
            found[key] = evaluate_parameter(raw_value, context, depth + 1)
        else:
            found[describe_launch_value(key)] = key
    return found


def split_parameter(value: Any, name: str) -> tuple[Any, list[tuple[str, UnknownValue | CommandWords]]]:  # noqa: ANN401
    """Return what is plain of a parameter's value, None for nothing, and what is not, by the dotted names."""
    if isinstance(value, UnknownValue | CommandWords):
        return None, [(name, value)]
    if not isinstance(value, dict) or not value:
        return value, []
    kept: dict[str, Any] = {}
    others: list[tuple[str, UnknownValue | CommandWords]] = []
    for key, inner in value.items():
        plain, rest = split_parameter(inner, f"{name}.{key}")
        others += rest
        if plain is not None:
            kept[key] = plain
    return kept or None, others


def _evaluate_substitution(value: Substitution, context: LaunchContext) -> Any:  # noqa: ANN401
    if value.kind == "command":
        return _split_command(value, context)
    if value.kind == "typed":
        inner, kind = value.parts[0], _PARAMETER_TYPES.get(str(value.parts[1]), "yaml")
        command = inner[0] if isinstance(inner, list | tuple) and len(inner) == 1 else inner
        if isinstance(command, Substitution) and command.kind == "command":
            return _split_command(command, context)
        text = context.resolve(inner)
        return text if isinstance(text, UnknownValue) or kind == "text" else _convert_text(text, kind)
    text = context.resolve(value)
    return text if isinstance(text, UnknownValue) else read_value_text(text)


def _convert_text(text: str, kind: str) -> Any:  # noqa: ANN401
    found = read_value_text(text)
    return float(found) if kind == "float" and isinstance(found, int) and not isinstance(found, bool) else found


def read_value_text(text: str) -> Any:  # noqa: ANN401
    """Return what a text is as YAML: `true`, `0.5` and `[1, 2]` are no texts."""
    stripped = text.strip()
    if not stripped or OPEN in stripped:
        return text
    if stripped[0] in "[{" and "\n" not in stripped:
        document, problems = parse_yaml("value", f"value: {stripped}")
        node = document.root.get("value") if document and not problems else None
        return text if node is None else node_to_data(node)
    found = resolve_scalar(stripped)
    return text if isinstance(found, str) or found is None else found


def _split_command(value: Substitution, context: LaunchContext) -> Any:  # noqa: ANN401
    """Return the words of a command, with `$(...)` in one piece."""
    text = context.resolve(value.parts[0])
    return text if isinstance(text, UnknownValue) else CommandWords(split_words(text))
