"""Hand parameters in from the component around: `from: self.side`, and `$(self.frame_prefix)` in texts.

Declare the parameters of components.
"""

from __future__ import annotations

import re
from collections.abc import Mapping

from archgen.diagnostics import Diagnostic, Span, did_you_mean
from archgen.frozen import replace
from archgen.link import mapping_values
from archgen.link.element_outline import ElementOutline
from archgen.link.value_readers import read_values
from archgen.model.parameter import Parameter, format_parameter
from archgen.syntax.yaml_tree import MappingEntry, MappingNode, ScalarNode, SequenceNode, YamlNode, node_to_data


class HandedParameters:
    """The parameters of components, with what the components around them hand in."""

    def __init__(self, outline: ElementOutline, diagnostics: list[Diagnostic]) -> None:
        """Take what the project declares; what the component around lacks goes to `diagnostics`."""
        self._outline = outline
        self.diagnostics = diagnostics
        self._parameters: dict[str, dict[str, Parameter]] = {}

    def find_parameters(self, component_id: str) -> dict[str, Parameter]:
        """Return the parameters of a component, composed or not, by dotted name."""
        if component_id not in self._parameters:
            shell = self._outline.shells.get(component_id)
            entry = shell.entry if shell else self._outline.components[component_id]
            written = declare_parameters(mapping_values.get_body(entry))
            self._parameters[component_id] = self._hand_in(component_id, written) if written else written
        return self._parameters[component_id]

    def fill_in_name(self, text: str, component_id: str, place: Span) -> str:
        """Return a text of a component with the parameters of that component, which are its own `self` here."""
        if "$" not in text:
            return text
        parameters = self.find_parameters(component_id)
        value, missing_names = fill_in_text(text, parameters)
        for name in missing_names:
            self.diagnostics.append(
                Diagnostic(
                    "unknown-reference",
                    f"`{component_id}` has no parameter `{name}`",
                    place,
                    help=did_you_mean(name, parameters) or f"declare `{name}` among its parameters",
                    element=component_id,
                )
            )
        return str(value)

    def fill_in_body(self, body: MappingNode, component_id: str) -> MappingNode:
        """Return what a component says of its node with its parameters filled in; parameters of the node are data."""
        if not any(_holds_reference(entry.value) for entry in body):
            return body
        return MappingNode({entry.key: self._fill_in_entry(entry, component_id) for entry in body}, body.span)

    def _fill_in_entry(self, entry: MappingEntry, component_id: str) -> MappingEntry:
        if entry.key == "parameters" or not _holds_reference(entry.value):
            return entry
        return entry.with_value(self._fill_in_node(entry.value, component_id))

    def _fill_in_node(self, node: YamlNode, component_id: str) -> YamlNode:
        if isinstance(node, MappingNode):
            return self.fill_in_body(node, component_id)
        if isinstance(node, SequenceNode):
            return SequenceNode([self._fill_in_node(item, component_id) for item in node.items], node.span)
        text = self.fill_in_name(node.text, component_id, node.span)
        return node if text == node.text else ScalarNode(text, text, node.span)

    def _hand_in(self, component_id: str, written: Mapping[str, Parameter]) -> dict[str, Parameter]:
        parent = self._outline.expansion.parents.get(component_id) if self._outline.expansion else None
        around = self.find_parameters(parent) if parent else {}
        return {name: self._fill_in(component_id, each, around, parent) for name, each in written.items()}

    def _fill_in(
        self, component_id: str, parameter: Parameter, around: Mapping[str, Parameter], parent: str | None
    ) -> Parameter:
        handed = hand_in_value(parameter, around)
        if handed is None:
            self._report_missing(component_id, parameter.handed_from or "", parameter.at, around, parent)
            return parameter
        if not isinstance(handed.value, str) or "$" not in handed.value:
            return handed
        value, missing_names = fill_in_text(handed.value, around)
        for name in missing_names:
            self._report_missing(component_id, f"self.{name}", handed.value_at, around, parent)
        return replace(handed, value=value)

    def _report_missing(
        self, component_id: str, reference: str, place: Span, around: Mapping[str, Parameter], parent: str | None
    ) -> None:
        name = reference.removeprefix("self.")
        if parent is None:
            message = f"`{reference}` names a parameter of the component around `{component_id}`, but there is none"
            help_line = "write the value, or put the component into another one"
        else:
            message = f"`{parent}` has no parameter `{name}` to hand in"
            help_line = did_you_mean(name, around) or f"declare `{name}` among the parameters of `{parent}`"
        self.diagnostics.append(Diagnostic("unknown-reference", message, place, help=help_line, element=component_id))


def _holds_reference(node: YamlNode) -> bool:
    """Whether a text in a tree may name a parameter."""
    if isinstance(node, MappingNode):
        return any(_holds_reference(entry.value) for entry in node)
    if isinstance(node, SequenceNode):
        return any(map(_holds_reference, node.items))
    return "$" in node.text


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
