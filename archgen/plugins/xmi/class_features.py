"""The properties and operations of a class: parameters, operations and the period of a component or component type."""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import dataclass, field

from archgen.plugin.importing import XmlElement
from archgen.plugins.xmi import uml_values
from archgen.plugins.xmi.import_ledger import ImportLedger, choose_id, name_parameter
from archgen.plugins.xmi.uml_catalogue import read_description
from archgen.plugins.xmi.uml_index import get_kind, get_name, is_true, list_child_elements

_PERIOD_NAME = "sample"
_VISIBILITIES = frozenset({"public", "protected", "private"})
_ANSWERS = frozenset({"return", "out"})


@dataclass(slots=True)
class ClassFeatures:
    """What the features of a class become."""

    parameters: dict[str, object] = field(default_factory=dict)
    operations: dict[str, object] = field(default_factory=dict)
    timing: dict[str, object] = field(default_factory=dict)
    data_types: dict[str, str] = field(default_factory=dict)
    """The types of its protected properties by name: the data of ports of these names."""

    def list_sections(self) -> dict[str, object]:
        """Return the keys of a component for what there is."""
        sections = {"parameters": self.parameters, "operations": self.operations, "timing": self.timing}
        return {key: value for key, value in sections.items() if value}


def read_features(
    ledger: ImportLedger, owner: XmlElement, port_names: Collection[str], parts: Collection[XmlElement]
) -> ClassFeatures:
    """Return the features of a class. `port_names` are those of its ports, `parts` what is a component inside of it."""
    reader = _FeatureReader(ledger, port_names)
    for child in list_child_elements(owner, "Property", "Operation"):
        if child in parts:
            continue
        if get_kind(child) == "Operation":
            reader.read_operation(child)
        elif child.tag in {"ownedAttribute", "attribute", "ownedMember"}:
            reader.read_property(child)
    return reader.features


class _FeatureReader:
    """Reads the features of one class."""

    def __init__(self, ledger: ImportLedger, port_names: Collection[str]) -> None:
        self.features = ClassFeatures()
        self._index, self._ledger, self._port_names = ledger.index, ledger, port_names

    def read_property(self, element: XmlElement) -> None:
        name, type_name = get_name(element), uml_values.find_type_name(self._index, element)
        if name in self._port_names:
            # A port gives access to it: it is the port's data, and no parameter.
            self.features.data_types[name] = type_name
            self._ledger.take(element)
        elif not name:
            self._ledger.refuse(element, "it has no name")
        elif name.lower() == _PERIOD_NAME and (text := uml_values.read_default(self._index, element)) is not None:
            self._read_period(element, text)
        else:
            self._read_parameter(element, name, type_name)

    def _read_period(self, element: XmlElement, text: str) -> None:
        default = element.find("defaultValue")
        # archgen keeps the words of a period as the literal's name.
        words = get_name(default) if default is not None else ""
        timing = uml_values.read_period(words) if words else None
        timing = uml_values.read_period(text) if timing is None else timing
        if timing is None:
            why = f"`{text[:60]}` of `{get_name(element)}` is no period in seconds"
            self._ledger.leave(element, why, "write a number, such as `0.02`")
        else:
            self.features.timing |= timing
            self._ledger.take(element)

    def _read_parameter(self, element: XmlElement, name: str, type_name: str) -> None:
        reference = self._index.find_reference(element, "type")
        enumeration = reference.element if reference and reference.element is not None else None
        choices = (
            [get_name(each) for each in list_child_elements(enumeration, "EnumerationLiteral") if get_name(each)]
            if enumeration is not None and get_kind(enumeration) == "Enumeration"
            else []
        )
        kind = "string" if choices else uml_values.find_parameter_type(type_name)
        key = name_parameter(name)
        if kind is None:
            why = f"its type `{type_name[:60]}` is no value" if type_name else "nothing says what type it has"
            self._ledger.leave(element, f"the property `{name[:80]}` is no parameter: {why}")
            return
        if key in self.features.parameters:
            self._ledger.refuse(element, "there is another one of this name")
            return
        is_list = uml_values.is_many(element)
        parameter: dict[str, object] = {"choices": choices} if choices else {"type": kind}
        parameter |= {"type": f"{kind}[]"} if is_list else {}
        parameter |= self._read_value(element, kind, choices, is_list=is_list)
        parameter |= read_description(self._ledger, element)
        if is_true(element, "isReadOnly"):
            parameter["read_only"] = True
        if (visibility := element.attributes.get("visibility", "")) in _VISIBILITIES:
            parameter["visibility"] = visibility
        self.features.parameters[key] = parameter
        self._ledger.take(element)

    def _read_value(self, element: XmlElement, kind: str, choices: list[str], *, is_list: bool) -> dict[str, object]:
        """Return the `value` of a parameter; nothing where it has no default, or one that does not fit."""
        text = uml_values.read_default(self._index, element)
        if text is None:
            return {}
        words = (
            [word for each in text.strip().strip("[]{}").split(",") if (word := each.strip())] if is_list else [text]
        )
        default = f"the default `{text[:60]}` of `{get_name(element)}`"
        try:
            values = [uml_values.convert_value(each, kind) for each in words]
        except ValueError:
            self._ledger.leave(element, f"{default} is no {kind}: the parameter has no value")
            return {}
        if choices and not set(values) <= set(choices):
            self._ledger.leave(element, f"{default} is none of its enumeration's values")
            return {}
        return {"value": values if is_list else values[0]}

    def read_operation(self, element: XmlElement) -> None:
        name = get_name(element)
        if not name:
            self._ledger.refuse(element, "it has no name")
            return
        operation_id = choose_id(element, "operation", self.features.operations)
        # Code calls an operation by its id where it has no other name.
        operation: dict[str, object] = {} if name == operation_id else {"title": name}
        request: dict[str, object] = {}
        answers: dict[str, object] = {}
        for parameter in list_child_elements(element, "Parameter"):
            direction = parameter.attributes.get("direction", "in")
            type_name = uml_values.find_type_name(self._index, parameter)
            type_name = uml_values.find_field_type(type_name) or type_name
            type_name += uml_values.write_array(parameter) if type_name else ""
            self._ledger.take(parameter)
            if direction == "return" and not type_name:
                continue
            sides = answers if direction in _ANSWERS else request
            answer_id = "return" if direction == "return" and "return" not in sides else ""
            sides[answer_id or choose_id(parameter, "value", sides)] = type_name or None
            if direction == "inout":
                answers[choose_id(parameter, "value", answers)] = type_name or None
        if request:
            operation["request"] = request
        if answers:
            # An answer alone needs no name.
            operation["response"] = answers.get("return") if answers.keys() == {"return"} else answers
        visibility = element.attributes.get("visibility", "")
        if visibility == "protected" and name.lower().startswith(("get", "set")):
            operation["call"] = "synchronous" if name.lower().startswith("get") else "asynchronous"
        if visibility in _VISIBILITIES:
            operation["visibility"] = visibility
        self.features.operations[operation_id] = operation | read_description(self._ledger, element)
        self._ledger.take(element)
