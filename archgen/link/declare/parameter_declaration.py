"""Declare the parameters of components."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import replace

from archgen.link import mapping_values
from archgen.link.value_readers import read_values
from archgen.model.parameter import Parameter, format_parameter
from archgen.syntax.yaml_tree import MappingEntry, MappingNode, node_to_data

_HANDED_PREFIX = "self."
_OPENING = "$("
_REFERENCE_PATTERN = re.compile(r"\$\$\(|\$\(self\.(?P<name>[^\s()]{1,200})\)")


def declare_parameters(body: MappingNode) -> dict[str, Parameter]:
    """Declare the parameters of a component, by their dotted names."""
    return {
        name: _declare_parameter(entry, declaration)
        for name, entry, declaration in mapping_values.iterate_elements(body, "parameters")
    }


def _declare_parameter(entry: MappingEntry, declaration: MappingNode) -> Parameter:
    limits = [
        item.value for item in mapping_values.get_scalars(declaration, "range") if isinstance(item.value, int | float)
    ]
    choices = declaration.get("choices")
    value = declaration.get("value")
    return Parameter(
        name=entry.key,
        **read_values("parameter_declaration", Parameter, declaration),
        value=None if value is None else node_to_data(value),
        range=(limits[0], limits[1]) if len(limits) == 2 else None,  # noqa: PLR2004 - least and greatest
        choices=None
        if choices is None
        else tuple(item.value for item in mapping_values.get_scalars(declaration, "choices")),
        hints=mapping_values.get_data(declaration, "hints"),
        hint_places=dict(mapping_values.list_hint_places(mapping_values.get_mapping(declaration, "hints"))),
        at=entry.key_span,
    )


def hand_in_value(parameter: Parameter, outer_parameters: Mapping[str, Parameter]) -> Parameter | None:
    """Return a parameter with the value that the component around it hands in; None where that has no such parameter.

    `outer_parameters` are those of the component around it. A parameter without `from` stays as it is. What
    it says itself of its type, unit and limits stays, too. The value keeps the place where it is written.
    """
    if parameter.handed_from is None:
        return parameter
    source = outer_parameters.get(parameter.handed_from.removeprefix(_HANDED_PREFIX))
    if source is None:
        return None
    return replace(
        parameter,
        value=source.value,
        value_at=source.value_at,
        type=parameter.type or source.type,
        unit=parameter.unit or source.unit,
        range=parameter.range or source.range,
        choices=parameter.choices or source.choices,
    )


def fill_in_text(text: str, outer_parameters: Mapping[str, Parameter]) -> tuple[object, tuple[str, ...]]:
    """Return a text with the values that `$(self.NAME)` stands for, and the names that the component around lacks.

    `outer_parameters` are those of the component around it. Alone it keeps the value's type; `$$(` stands for `$(`. A name
    without a value stays as it is written.
    """
    whole = _REFERENCE_PATTERN.fullmatch(text)
    if whole is not None and whole["name"] and (source := outer_parameters.get(whole["name"])) is not None:
        return (text if source.value is None else source.value), ()
    missing_names: list[str] = []

    def replace_reference(match: re.Match[str]) -> str:
        if not match["name"]:
            return _OPENING
        parameter = outer_parameters.get(match["name"])
        if parameter is None:
            missing_names.append(match["name"])
        return match[0] if parameter is None or parameter.value is None else format_parameter(parameter.value)

    return _REFERENCE_PATTERN.sub(replace_reference, text), tuple(missing_names)
