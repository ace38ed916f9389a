"""Parameters that generate_parameter_library declares: a YAML file with types, defaults, ranges and descriptions."""

from __future__ import annotations

from collections.abc import Iterator
from math import isfinite
from typing import Any

from archgen.plugin.importing import MappingNode, ScalarNode, YamlNode, node_to_data
from archgen.plugin.model import is_parameter_name
from archgen.plugins.ros.ros_package.import_account import ImportAccount

_TYPES = {
    "bool": "boolean",
    "int": "integer",
    "double": "float",
    "string": "string",
}
_KEYS = frozenset({"type", "default_value", "description", "read_only", "validation", "additional_constraints"})
_MAX_DEPTH = 20


def is_declaration_file(root: MappingNode) -> bool:
    """Whether a YAML file declares parameters: at its top a mapping with, somewhere below, a `type` that the tool knows."""
    return any(isinstance(entry.value, MappingNode) and _find_declaration(entry.value, 0) for entry in root)


def _find_declaration(mapping: MappingNode, depth: int) -> bool:
    if _is_declaration(mapping):
        return True
    inner = [entry.value for entry in mapping if isinstance(entry.value, MappingNode)]
    return depth < _MAX_DEPTH and any(_find_declaration(each, depth + 1) for each in inner)


def is_parameter_value(value: object) -> bool:
    """Whether a parameter of ROS can have a value: a single one, or a list of such."""
    items = value if isinstance(value, list | tuple) else [value]
    return not any(item is None or isinstance(item, dict | list | tuple) for item in items)


def _is_declaration(mapping: MappingNode) -> bool:
    kind = mapping.get("type")
    return isinstance(kind, ScalarNode) and _read_type(kind.text) is not None and {e.key for e in mapping} <= _KEYS


def _read_type(text: str) -> tuple[str, int | None] | None:
    """Return the language's type for one of the tool, and how long it may be at most; None for another word."""
    base, _, fixed = text.partition("_fixed_")
    is_list = base.endswith("_array")
    known = _TYPES.get(base.removesuffix("_array"))
    if text == "none":
        return "", None
    if known is None or (fixed and not fixed.isdecimal()):
        return None
    return f"{known}[]" if is_list else known, int(fixed) if fixed and len(fixed) < 10 else None  # noqa: PLR2004 - a length


def read_declared_parameters(
    mapping: MappingNode, account: ImportAccount, outer: str = "", depth: int = 0
) -> tuple[dict[str, Any], list[str]]:
    """Return parameters by their dotted names, and the sets below which any parameter is accepted."""
    parameters: dict[str, Any] = {}
    open_sets: list[str] = []
    for entry in mapping if depth < _MAX_DEPTH else ():
        if entry.key.startswith("__map_") and (not outer or is_parameter_name(outer.removesuffix("."))):
            open_sets.append(outer.removesuffix(".") or "*")
            words = f"the parameters below `{entry.key}` stand once for each name in a list: any are accepted"
            account.add_note("__map_", words, entry.key_span, fate="noted")
        elif not isinstance(entry.value, MappingNode):
            account.add_note(entry.key, "it is no parameter", entry.key_span)
        elif _is_declaration(entry.value) and not is_parameter_name(f"{outer}{entry.key}"):
            account.add_note("parameter", f"`{outer}{entry.key}` is no name of a parameter", entry.key_span)
        elif _is_declaration(entry.value):
            parameters[f"{outer}{entry.key}"] = _read_parameter(entry.key, entry.value, account)
            account.count("parameter")
        else:
            inner, inner_sets = read_declared_parameters(entry.value, account, f"{outer}{entry.key}.", depth + 1)
            parameters |= inner
            open_sets += inner_sets
    return parameters, list(dict.fromkeys(open_sets))


def _read_parameter(name: str, declaration: MappingNode, account: ImportAccount) -> dict[str, Any]:
    kind = declaration.get("type")
    type_name, length = _read_type(kind.text if isinstance(kind, ScalarNode) else "") or ("", None)
    default = declaration.get("default_value")
    data: dict[str, Any] = {"type": type_name or "string"}
    if not type_name:
        account.add_note("type: none", f"`{name}` has no type of its own", declaration.span, fate="noted")
    value = None if default is None else node_to_data(default)
    if default is not None and value is not None and not is_parameter_value(value):
        words = f"what `{name}` is by default is no value that a parameter of ROS can have"
        account.add_note("default_value", words, default.span)
    elif value is not None:
        data["value"] = float(value) if type_name == "float" and isinstance(value, int) else value
    if length is not None:
        account.add_note("fixed", f"`{name}` has at most {length} items: a length cannot be said", declaration.span)
    description = declaration.get("description")
    if isinstance(description, ScalarNode) and description.text.strip():
        data["description"] = description.text.strip()
    read_only = declaration.get("read_only")
    if isinstance(read_only, ScalarNode) and read_only.value is True:
        data["read_only"] = True
    validation = declaration.get("validation")
    if isinstance(validation, MappingNode):
        _read_validation(name, validation, data, account)
    return data


def _read_validation(name: str, validation: MappingNode, data: dict[str, Any], account: ImportAccount) -> None:
    least: Any = None
    greatest: Any = None
    for rule, arguments, node in _list_rules(validation):
        is_list = str(data["type"]).endswith("[]")
        is_choice = len(arguments) == 1 and isinstance(arguments[0], list) and is_parameter_value(arguments[0])
        if rule == "one_of" and is_choice and not is_list:
            data["choices"] = arguments[0]
        elif rule in {"bounds", "element_bounds"} and len(arguments) == 2:  # noqa: PLR2004 - least and greatest
            least, greatest = arguments
        elif rule in {"gt_eq", "lower_bounds", "lower_element_bounds"} and len(arguments) == 1:
            least = arguments[0]
        elif rule in {"lt_eq", "upper_bounds", "upper_element_bounds"} and len(arguments) == 1:
            greatest = arguments[0]
        else:
            shown = f"{rule}: {arguments}" if arguments else rule
            account.add_note(f"validation {rule}", f"`{name}`: `{shown}` cannot be said", node.span)
    if (
        _are_numbers(least, greatest)
        and least <= greatest
        and data["type"] in {"integer", "float", "integer[]", "float[]"}
    ):
        data["range"] = [least, greatest]
    elif least is not None or greatest is not None:
        words = f"`{name}` is at {'least' if greatest is None else 'most'} {least if greatest is None else greatest}: a range has two ends"
        account.add_note("validation", words, validation.span)


def _are_numbers(*values: object) -> bool:
    return all(isinstance(value, int | float) and not isinstance(value, bool) and isfinite(value) for value in values)


def _list_rules(validation: MappingNode) -> Iterator[tuple[str, list[Any], YamlNode]]:
    for entry in validation:
        value = node_to_data(entry.value)
        arguments = value if isinstance(value, list) else [] if value is None else [value]
        # `bounds<>: [0, 1]`; `one_of<>: [[a, b]]`
        yield entry.key.partition("<")[0], list(arguments), entry.value
