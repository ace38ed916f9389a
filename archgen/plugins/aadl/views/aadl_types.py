"""Data and calls as AADL has them: packages of ROS's messages, and one of the project's own types."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping
from typing import Any

from archgen.plugin.generating import write_place
from archgen.plugin.model import PART_KEYS, Architecture, ConceptualType, DataField, flow_of
from archgen.plugin.ros import full_message_name
from archgen.plugins.aadl.views.aadl_words import (
    AadlProperty,
    NameSpace,
    list_own_sources,
    make_classifier,
    make_item,
    make_named_properties,
    make_property,
    make_text_properties,
    read_aadl_hints,
    write_aadl_string,
    write_texts,
)

UNTYPED = "ros::untyped"
"""The data of a port whose type nobody says: readers refuse a port without any."""
UNTYPED_CALL = "ros::untyped_call"
BASE_TYPES: Mapping[str, str] = {
    "bool": "Boolean",
    "byte": "Unsigned_8",
    "char": "Unsigned_8",
    "string": "String",
    "wstring": "String",
    **{f"float{bits}": f"Float_{bits}" for bits in (32, 64)},
    **{f"int{bits}": f"Integer_{bits}" for bits in (8, 16, 32, 64)},
    **{f"uint{bits}": f"Unsigned_{bits}" for bits in (8, 16, 32, 64)},
}
"""The types of the standard's package `Base_Types` for those of fields."""
_SHARED_BASES = frozenset({"byte", "char", "wstring"})
_FIXED_ARRAY = re.compile(r"\[[1-9][0-9]{0,8}\]\Z")
_GREATEST_SIZE = 2**32
"""The most bytes that the standard's own project file lets readers take."""


class TypeBook:
    """All types that something names, each written once. Asking for the name of a type writes it."""

    def __init__(self, architecture: Architecture, package_name: str, package_names: NameSpace) -> None:
        """Begin with no type; `package_name` is that of the project's own types."""
        self._types = architecture.types
        self._package_name = package_name
        self._package_names = package_names
        self._own_names = NameSpace()
        self._names: dict[tuple[str, str], str] = {}
        self._own: dict[str, list[dict[str, Any]]] = {}
        self._message_packages: dict[str, tuple[str, NameSpace, list[dict[str, Any]]]] = {}
        self._messages: dict[str, str] = {}
        self.call_data: dict[str, tuple[str, str]] = {}
        """What a call takes and gives, by the complete name of its subprogram: two complete names of data."""

    def name_type(self, type_name: str | None, flow: str = "topic") -> str:
        """Return the complete name of the classifier for a type: data, or a subprogram where it is called for."""
        if not type_name:
            return UNTYPED if flow == "topic" else UNTYPED_CALL
        if (type_name, flow) not in self._names:
            found = self._types.get(type_name)
            message = full_message_name(type_name)
            if message and flow_of(message) == flow and (found is None or found.origin == "message"):
                self._names[type_name, flow] = self._name_message(message)
            else:
                own_name = self._own_names.take_name(type_name)
                # The name is known before its fields are asked for: types may hold one another.
                self._names[type_name, flow] = f"{self._package_name}::{own_name}"
                self._own[own_name] = []
                self._own[own_name] += self._record_type(own_name, found or ConceptualType(type_name), flow)
        return self._names[type_name, flow]

    def list_packages(self) -> list[tuple[str, list[dict[str, Any]]]]:
        """Return the packages with their classifiers: those of messages by their names, then the project's own."""
        packages = [(name, classifiers) for name, _, classifiers in self._message_packages.values()]
        own = [each for classifiers in self._own.values() for each in classifiers]
        return [*sorted(packages), *([(self._package_name, own)] if own else [])]

    def _name_message(self, message: str) -> str:
        if message not in self._messages:
            package, kind, name = message.split("/")
            if package not in self._message_packages:
                self._message_packages[package] = (self._package_names.take_name(package), NameSpace(), [])
            package_name, names, classifiers = self._message_packages[package]
            own_name = names.take_name(name)
            is_renamed = package_name != package or own_name != name
            properties = make_text_properties(
                message_name=message if is_renamed else None, flow_kind="action" if kind == "action" else None
            )
            self._messages[message] = f"{package_name}::{own_name}"
            shape = _record_shape(own_name, flow_of(message), names, properties)
            self._note_call(package_name, shape)
            classifiers += shape
        return self._messages[message]

    def _note_call(self, package_name: str, shape: list[dict[str, Any]]) -> None:
        """Remember what a call takes and gives, which come first in its shape."""
        names = [f"{package_name}::{classifier['name']}" for classifier in shape]
        if len(names) > 1:
            self.call_data[names[-1]] = (names[0], names[1])

    def _record_type(self, own_name: str, declared: ConceptualType, flow: str) -> list[dict[str, Any]]:
        size = declared.size
        properties = [
            *make_named_properties(own_name, declared.name),
            *make_text_properties(
                description=declared.comment,
                status=declared.status,
                version=declared.version,
                flow_kind="action" if flow == "action" else None,
            ),
        ]
        if flow == "topic" and size and size.value <= _GREATEST_SIZE and size.value.denominator == 1:
            properties.append(make_property("Data_Size", _write_size(int(size.value))))
        if declared.values:
            properties.append(make_property("Data_Model::Data_Representation", "Enum"))
            properties.append(make_property("Data_Model::Enumerators", write_texts(declared.values)))
        properties += list_own_sources(read_aadl_hints(declared))
        place = write_place(declared.at)
        if flow != "topic":
            is_typed = any(getattr(declared, key) for key in PART_KEYS)
            if declared.message and flow_of(declared.message) == flow and not (declared.has_content or is_typed):
                extends = self._name_message(declared.message)
                self.call_data[f"{self._package_name}::{own_name}"] = self.call_data[extends]
                return [make_classifier("subprogram", own_name, extends=extends, properties=properties, place=place)]
            return self._record_call(own_name, declared, flow, properties)
        has_message = declared.message and flow_of(declared.message) == "topic" and not declared.has_content
        extends = self._name_message(declared.message or "") if has_message else ""
        data = make_classifier("data", own_name, extends=extends, properties=properties, place=place)
        if not declared.fields:
            return [data]
        return [data, self._record_fields(own_name, declared.fields)]

    def _record_call(
        self, own_name: str, declared: ConceptualType, flow: str, properties: list[AadlProperty]
    ) -> list[dict[str, Any]]:
        """Return a call with its parts, and what is in each of them."""
        shape = _record_shape(own_name, flow, self._own_names, properties, write_place(declared.at))
        self._note_call(self._package_name, shape)
        call = shape[-1]
        parts: list[dict[str, Any]] = []
        for key, data, feature in zip(PART_KEYS, shape[:-1], call["features"], strict=False):
            part_type = getattr(declared, key)
            if part_type:
                feature["text"] = f"{feature['text'].rpartition(' ')[0]} {self.name_type(part_type)}"
            elif key in declared.part_fields:
                parts.append(self._record_fields(data["name"], declared.part_fields[key]))
        return [*shape[:-1], *parts, call]

    def _record_fields(self, own_name: str, fields: Iterable[DataField]) -> dict[str, Any]:
        """Return an implementation of data with its fields."""
        names = NameSpace()
        return make_classifier(
            "data", f"{own_name}.impl", subcomponents=[self._record_field(each, names) for each in fields]
        )

    def _record_field(self, field: DataField, names: NameSpace) -> dict[str, Any]:
        name = names.take_name(field.name)
        element_type, bound, _ = field.element_type.partition("<=")
        base = BASE_TYPES.get(element_type)
        is_fixed = _FIXED_ARRAY.match(field.array) is not None
        is_plain = not bound and element_type not in _SHARED_BASES and (not field.array or is_fixed)
        if base:
            classifier = f"Base_Types::{base}"
        else:
            known = field.element_type if field.element_type in self._types else None
            classifier = self.name_type(known or full_message_name(field.element_type))
            is_plain = is_plain and classifier != UNTYPED
        default = field.default if isinstance(field.default, str | None) else ", ".join(field.default)
        properties = [
            *make_named_properties(name, field.name),
            *make_text_properties(
                field_type=None if is_plain else field.type,
                default_value=default,
                unit_name=field.unit,
                description=field.comment,
            ),
        ]
        return make_item(name, f"data {classifier}{field.array if is_fixed else ''}", properties)


def _write_size(size: int) -> str:
    """Return a size (B) in the largest unit in which it is whole."""
    for unit, factor in (("GByte", 10**9), ("MByte", 10**6), ("KByte", 1000)):
        if size and size % factor == 0:
            return f"{size // factor} {unit}"
    return f"{size} Bytes"


def _record_shape(
    name: str, flow: str, names: NameSpace, properties: list[AadlProperty], place: str = ""
) -> list[dict[str, Any]]:
    """Return data without content; for a call a subprogram with what it takes and gives, for an action with its feedback."""
    if flow == "topic":
        return [make_classifier("data", name, properties=properties, place=place)]
    parts = {"Request": "in parameter", "Response": "out parameter"}
    if flow == "action":
        parts = {"Goal": "in parameter", "Result": "out parameter", "Feedback": "out event data port"}
    part_names = {part: names.take_name(f"{name}_{part}") for part in parts}
    features = [make_item(part.lower(), f"{kind} {part_names[part]}") for part, kind in parts.items()]
    mark = [make_property("archgen::Part_Of", write_aadl_string(name))]
    return [
        *(make_classifier("data", each, properties=mark) for each in part_names.values()),
        make_classifier("subprogram", name, features=features, properties=properties, place=place),
    ]
