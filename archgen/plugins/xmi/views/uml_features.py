"""The parameters, operations and period of a component or component type as features of a class."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from decimal import Decimal
from typing import Any

from archgen.plugin.model import parse_quantity
from archgen.plugins.xmi.views.uml_types import IdRegistry, UmlTree, UmlTypes, make_comments, make_tree, read_mapping

_DECLARATION_KEYS = frozenset(
    {"type", "value", "unit", "range", "choices", "description", "read_only", "visibility", "from", "hints"}
)


class UmlFeatures:
    """Writes the features of classes and components."""

    def __init__(self, registry: IdRegistry, types: UmlTypes) -> None:
        self._registry, self._types = registry, types

    def write_features(self, path: str, body: Mapping[str, Any], declared: Mapping[str, str]) -> list[UmlTree]:
        """Return attributes and operations. `declared` are the types of parameters that its type declares."""
        features = [
            tree
            for name, parameter in list_declarations(read_mapping(body.get("parameters")))
            if (tree := self._write_parameter(path, name, parameter, declared)) is not None
        ]
        features += self._write_period(path, read_mapping(body.get("timing")))
        operations = read_mapping(body.get("operations"))
        return features + [self._write_operation(path, name, read_mapping(each)) for name, each in operations.items()]

    def _write_parameter(
        self, path: str, name: str, parameter: Mapping[str, Any], declared: Mapping[str, str]
    ) -> UmlTree | None:
        if "from" in parameter:
            # A value that the component around hands in: UML has no words for it.
            return None
        choices: list[Any] = parameter.get("choices") or []
        value = parameter.get("value")
        if isinstance(value, str) and "$(" in value:
            # A text with a value of the component around in it is no value by itself.
            value = None
        written = parameter.get("type") or declared.get(name) or find_value_type(value)
        written = written or (find_value_type(choices[0]) if choices else None)
        if written is None or (value is None and not parameter.get("type") and not choices):
            return None
        kind, is_list = written.removesuffix("[]"), written.endswith("[]")
        element_id = self._registry.claim(f"parameter.{path}.{name}")
        has_names = (
            bool(choices) and kind == "string" and not is_list and all(isinstance(each, str) for each in choices)
        )
        type_id = self._types.add_choices(f"{path}.{name}", choices) if has_names else self._types.refer_parameter(kind)
        flags = {"isReadOnly": "true" if parameter.get("read_only") else None}
        tree = make_tree(
            "ownedAttribute", "Property", element_id, name, visibility=parameter.get("visibility"), **flags
        )
        tree["attributes"].append(["type", type_id])
        tree["children"] += make_comments(element_id, parameter)
        if is_list:
            tree["children"] += self._types.write_bounds(element_id, "[]")
        if isinstance(value, list):
            text = ", ".join(("true" if each else "false") if isinstance(each, bool) else str(each) for each in value)
            is_readable = all(_reads_back(each) for each in value)
            tree["children"] += [self._types.write_default(element_id, "string", f"[{text}]")] if is_readable else []
        elif value is not None and not isinstance(value, Mapping):
            tree["children"].append(self._types.write_default(element_id, kind, value))
        return tree

    def _write_period(self, path: str, timing: Mapping[str, Any]) -> list[UmlTree]:
        """Return the property `sample`: the period in seconds, 0 where an arrival or a call sets it off."""
        words = str(timing.get("period") or timing.get("rate") or "")
        if period := parse_quantity(words, "duration"):
            nanoseconds = period.value
        elif rate := parse_quantity(words, "frequency"):
            nanoseconds = 10**9 / rate.value if rate.value else rate.value
        else:
            return []
        element_id = self._registry.claim(f"parameter.{path}.sample")
        real = self._types.refer_parameter("float")
        tree = make_tree("ownedAttribute", "Property", element_id, "sample", visibility="public", type=real)
        number = format(Decimal(round(nanoseconds)).scaleb(-9).normalize(), "f")
        tree["children"].append(self._types.write_default(element_id, "float", number, name=words))
        return [tree]

    def _write_operation(self, path: str, name: str, body: Mapping[str, Any]) -> UmlTree:
        element_id = self._registry.claim(f"operation.{path}.{name}")
        title = str(body.get("title") or name)
        tree = make_tree("ownedOperation", "Operation", element_id, title, visibility=body.get("visibility"))
        tree["children"] += make_comments(element_id, body)
        tree["children"] += self._write_arguments(element_id, body.get("request"), "in")
        tree["children"] += self._write_arguments(element_id, body.get("response"), "out")
        return tree

    def _write_arguments(self, operation_id: str, side: object, direction: str) -> Iterator[UmlTree]:
        if side is None:
            return
        named = side if isinstance(side, Mapping) else {"return" if direction == "out" else "value": side}
        for name, type_name in named.items():
            is_return = direction == "out" and not isinstance(side, Mapping)
            argument_id = self._registry.claim(f"argument.{operation_id}.{'return.' * is_return}{name}")
            attributes = {"direction": "return" if is_return else direction if direction == "out" else None}
            written = str(type_name or "")
            type_id = self._types.refer(written.removesuffix("[]")) if written else None
            tree = make_tree("ownedParameter", "Parameter", argument_id, name, type=type_id, **attributes)
            if written.endswith("[]"):
                tree["children"] += self._types.write_bounds(argument_id, "[]")
            yield tree


def list_declarations(parameters: Mapping[str, Any], prefix: str = "") -> Iterator[tuple[str, Mapping[str, Any]]]:
    """Yield the parameters with their dotted names: what is no declaration is a set of them."""
    for name, body in parameters.items():
        is_declaration = not isinstance(body, Mapping) or (
            body.keys() <= _DECLARATION_KEYS and bool(body.keys() & {"value", "type", "choices", "from"})
        )
        if is_declaration:
            yield f"{prefix}{name}", body if isinstance(body, Mapping) else {"value": body}
        else:
            yield from list_declarations(body, f"{prefix}{name}.")


def find_value_type(value: object) -> str | None:
    """Return the type of a parameter that its value shows; None where there is none."""
    if isinstance(value, list):
        inner = find_value_type(value[0]) if value else None
        return f"{inner}[]" if inner else None
    kinds = ((bool, "boolean"), (int, "integer"), (float, "float"), (str, "string"))
    return next((kind for python_type, kind in kinds if isinstance(value, python_type)), None)


def _reads_back(value: object) -> bool:
    """Whether an item of a list is read again as it was: a text with a comma would be two."""
    return not isinstance(value, str) or (
        bool(value.strip()) and value == value.strip() and not set(value) & set(",[]{}\"'")
    )
