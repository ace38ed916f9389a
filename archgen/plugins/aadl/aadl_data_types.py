"""Make types of data and subprograms: messages of ROS, types with fields, services."""

from __future__ import annotations

import json
import re
from typing import Any

from archgen.plugin.ros import parse_interface_definition
from archgen.plugins.aadl.aadl_tree import AadlLink, AadlList, AadlName
from archgen.plugins.aadl.archgen_words import find_own_text, read_own_words
from archgen.plugins.aadl.classifier_names import KnownClassifier, find_only_implementations
from archgen.plugins.aadl.property_values import PropertyScope, read_first_text, read_size, read_texts
from archgen.plugins.aadl.resolved_classifiers import UNBOUND, ClassifierResolver, ClassifierUse, ResolvedClassifier

_ROS_PACKAGE = re.compile(r"[a-z][a-z0-9_]*_(?:msgs|srvs|interfaces|actions)\Z")
_ROS_NAME = re.compile(r"[A-Z][A-Za-z0-9]*\Z")
_BASE_TYPES = {
    "boolean": "bool",
    "string": "string",
    "character": "char",
    "float_32": "float32",
    "float_64": "float64",
    **{f"integer_{size}": f"int{size}" for size in (8, 16, 32, 64)},
    **{f"unsigned_{size}": f"uint{size}" for size in (8, 16, 32, 64)},
}
_SIZELESS_TYPES = {"integer": "int32", "natural": "uint32", "float": "float64"}
_CALL_PARTS = {
    "request": "request",
    "response": "response",
    "goal": "request",
    "result": "response",
    "feedback": "feedback",
}
"""The parts of services and actions, by what an export of archgen's calls them."""
_MAX_ARRAY = 1_000_000
_BASE_PACKAGES = frozenset({"base_types", "data_model"})
_KEEPING_CLASSIFIERS = frozenset({"internal_state", "tf"})
_TYPE_KEYS = {"comment": "description", "status": "status", "version": "version"}
_FIELD_KEYS = {"default": "default_value", "unit": "unit_name", "comment": "description"}
"""Data of the library of components: they are hints of who has them, and no types."""


def _has_default(type_name: str, text: str) -> bool:
    """Whether a message may have a field of this type with this default."""
    literal = json.dumps(text, ensure_ascii=False) if re.match(r"w?string(?!.*\[)", type_name) else text
    definition = parse_interface_definition(f"{type_name} x {literal}", "a/msg/A", "", ros1=False)
    return (
        "/" not in type_name and "\n" not in text and not definition.diagnostics and bool(definition.interface.parts[0])
    )


class AadlDataTypes:
    """The types of a model; each gets its name when it is first asked for."""

    def __init__(self, resolver: ClassifierResolver) -> None:
        self.types: dict[str, dict[str, Any]] = {}
        self._resolver = resolver
        self._names: dict[str, str] = {}
        self._taken_names: set[str] = set()
        self._only_implementations = find_only_implementations(resolver.names)

    def name_use(self, use: ClassifierUse, kind: str = "msg") -> str:
        """Return the name of the type of a port; nothing where it has none."""
        if not use.name or use.category == UNBOUND:
            return ""
        if use.known is None:
            return self._name_unknown(use.name, kind)
        if use.known.is_of_library and use.known.classifier.name.lower().startswith("untyped"):
            return ""
        name = self._name_known(use.known, kind)
        values = [self.name_use(value) for value in use.bindings.values()]
        return f"{name}<{', '.join(values)}>" if values and all(values) else name

    def _name_unknown(self, full_name: str, kind: str) -> str:
        """Return the name of a type that is in none of the files: nothing else is called so."""
        if message := _make_message(full_name, kind):
            return message
        key = f"unknown {full_name.lower()}"
        if key not in self._names:
            package, _, own_name = full_name.partition(".")[0].rpartition("::")
            if own_name in self._taken_names and package:
                own_name = f"{own_name} ({package.replace('::', ' ')})"
            self._names[key] = own_name
            self._taken_names.add(own_name)
        return self._names[key]

    def add_all(self) -> int:
        """Take all data that are types of the model; return how many."""
        count = 0
        for known in self._resolver.names.known.values():
            if known.classifier.category == "data" and not (
                _is_library_data(known) or self._is_shadowed(known) or self._is_part(known)
            ):
                count += 1
                self._name_known(known, "msg")
        return count

    def _is_part(self, known_classifier: KnownClassifier) -> bool:
        """Whether an export of archgen's wrote data as the request or the answer of a call: the message says it."""
        scope = PropertyScope(self._resolver, self._resolver.resolve_known(known_classifier))
        return bool(find_own_text(scope, (), "part_of"))

    def _is_shadowed(self, known_classifier: KnownClassifier) -> bool:
        """Whether a type is told by its only implementation."""
        return known_classifier.key in self._only_implementations

    def _name_known(self, known_classifier: KnownClassifier, kind: str) -> str:
        # A type and its only implementation are one: it has the fields of the implementation.
        known_classifier = self._only_implementations.get(known_classifier.key, known_classifier)
        key = known_classifier.key
        type_key = key.partition(".")[0]
        is_only = self._only_implementations.get(type_key) is known_classifier
        if key in self._names:
            return self._names[key]
        resolved = self._resolver.resolve_known(known_classifier)
        scope = PropertyScope(self._resolver, resolved)
        own_kind = find_own_text(scope, (), "flow_kind") or kind
        own_message = find_own_text(scope, (), "message_name") or _make_message(known_classifier.full_name, own_kind)
        name = find_own_text(scope, (), "id") or known_classifier.classifier.name.partition(".")[0]
        if known_classifier.classifier.is_implementation and not is_only:
            name = known_classifier.classifier.name.replace(".", " ")
        if name in self._taken_names:
            name = f"{name} ({known_classifier.package.name.replace('::', ' ')})"[:200]
        self._names[key] = name
        body = self._describe(resolved, scope, kind)
        if own_message and not body:
            # The message says all that the model says.
            self._names[key] = own_message
            return own_message
        message = own_message or _find_message(resolved, own_kind)
        body = {**({"message": message} if message else {}), **body}
        self._taken_names.add(name)
        if known_classifier.package.name.lower() not in _BASE_PACKAGES:
            self._add_type(known_classifier, name, body)
        return name

    def _add_type(self, known_classifier: KnownClassifier, name: str, body: dict[str, Any]) -> None:
        if not self._resolver.names.is_own:
            hints = body.get("hints", {}).get("aadl", {})
            body = {**body, "hints": {"aadl": {"classifier": known_classifier.full_name, **hints}}}
        self.types[name] = body

    def _describe(self, resolved: ResolvedClassifier, scope: PropertyScope, kind: str) -> dict[str, Any]:
        body = read_own_words(scope, (), _TYPE_KEYS)
        if size := read_size(scope.value((), "data_size", "source_data_size")):
            body["size"] = size
        if prototypes := [use.name for use in resolved.prototypes.values() if use.category == UNBOUND]:
            body["generic"] = prototypes
        if kind == "srv":
            body |= self._describe_call(resolved)
        elif values := self._read_enumerators(scope):
            body["values"] = values
        elif fields := self._read_fields(resolved, scope):
            body["fields"] = fields
        hints: dict[str, Any] = {}
        if texts := read_texts(scope.value((), "source_text")):
            hints["source_text"] = texts
        if text := read_first_text(scope.value((), "source_name")):
            hints["source_name"] = text
        return {**body, "hints": {"aadl": hints}} if hints else body

    def _describe_call(self, resolved: ResolvedClassifier) -> dict[str, Any]:
        if self._resolver.names.is_own:
            return self._read_call_parts(resolved)
        parts: dict[str, dict[str, Any]] = {"request": {}, "response": {}}
        for port in resolved.ports.values():
            if port.kind == "parameter":
                name = self._name_field(port.use)
                for word, part in (("in", "request"), ("out", "response")):
                    if word in port.direction.split() and name:
                        parts[part][_fold_field_name(port.written.name)] = name
        return {key: value for key, value in parts.items() if value} and parts

    def _read_call_parts(self, resolved: ResolvedClassifier) -> dict[str, Any]:
        """Return what an export of archgen's says of the parts of a call: their fields, or a type."""
        parts: dict[str, Any] = {}
        for name, port in resolved.ports.items():
            known = port.use.known
            if name not in _CALL_PARTS or known is None:
                continue
            content = self._only_implementations.get(known.key)
            if not self._is_part(known):
                parts[_CALL_PARTS[name]] = self.name_use(port.use)
            elif content and (data := self._resolver.resolve_known(content)):
                parts[_CALL_PARTS[name]] = self._read_fields(data, PropertyScope(self._resolver, data))
        return parts

    def _read_enumerators(self, scope: PropertyScope) -> list[str]:
        value = scope.value((), "data_model::data_representation")
        if not (isinstance(value, AadlName) and value.name.lower() == "enum"):
            return []
        words = [re.sub(r"\W", "_", text).upper() for text in read_texts(scope.value((), "data_model::enumerators"))]
        return list(dict.fromkeys(word for word in words if word and word[0].isalpha()))

    def _read_fields(self, resolved: ResolvedClassifier, scope: PropertyScope) -> dict[str, Any]:
        fields: dict[str, Any] = {}
        for name, part in resolved.parts.items():
            if part.category != "data":
                continue
            type_name = self._name_field(part.use) + _write_dimensions(part.written.dimensions)
            own_words = read_own_words(scope, (name,), _FIELD_KEYS)
            type_name = find_own_text(scope, (name,), "field_type") or type_name
            field_name = find_own_text(scope, (name,), "id") or _fold_field_name(part.written.name)
            if "default" in own_words and not _has_default(type_name, own_words["default"]):
                del own_words["default"]
                words = f"`{part.written.name}` has a default that is none of its type"
                self._resolver.notes.add_contradiction("Default_Value", words, part.written.span)
            if type_name:
                fields[field_name] = {"type": type_name, **own_words} if own_words else type_name
        if not fields:
            names = read_texts(scope.value((), "data_model::element_names"))
            base = scope.value((), "data_model::base_type")
            items = base.items if isinstance(base, AadlList) else ()
            links = [item.path[0] for item in items if isinstance(item, AadlLink) and item.kind == "classifier"]
            if names and len(names) == len(links):
                uses = [self._resolver.find_use(link, {}, resolved.known, {}) for link in links]
                fields = {_fold_field_name(name): self._name_field(use) for name, use in zip(names, uses, strict=True)}
        return {name: type_name for name, type_name in fields.items() if type_name}

    def _name_field(self, use: ClassifierUse) -> str:
        """Return the type of a field: one of ROS where the model has one of its own base types."""
        if use.category == UNBOUND:
            return use.name
        package, _, name = use.full_name.lower().rpartition("::")
        if package == "base_types" or (use.known is None and not package):
            if name in _BASE_TYPES:
                return _BASE_TYPES[name]
            if name in _SIZELESS_TYPES and use.known is not None:
                words = f"it has no size in AADL; fields have `{_SIZELESS_TYPES[name]}`"
                self._resolver.notes.add_counted(f"Base_Types::{name}", words, use.known.classifier.span, fate="noted")
            if name in _SIZELESS_TYPES:
                return _SIZELESS_TYPES[name]
        type_name = self.name_use(use)
        if use.name and use.known is None and "/" not in type_name:
            # A field names a type that there is.
            self.types.setdefault(type_name, {"hints": {"aadl": {"classifier": use.full_name}}})
        return type_name


def _is_library_data(classifier: KnownClassifier) -> bool:
    name = classifier.classifier.name.lower().partition(".")[0]
    return classifier.package.name.lower() in _BASE_PACKAGES or name in _KEEPING_CLASSIFIERS or classifier.is_of_library


def _find_message(resolved: ResolvedClassifier, kind: str) -> str:
    """Return the message of ROS that a type is made from, or nothing."""
    entries = (resolved.known, *resolved.ancestors)
    # What is in none of the files is told by its name.
    names = [*(entry.full_name for entry in entries[1:]), *(entry.classifier.extends for entry in entries)]
    return next((found for name in names if (found := _make_message(name, kind))), "")


def _make_message(full_name: str, kind: str) -> str:
    """Return the message or service of ROS that a name means, or nothing."""
    package, _, name = full_name.partition(".")[0].rpartition("::")
    if _ROS_PACKAGE.match(package) and _ROS_NAME.match(name):
        return f"{package}/{kind}/{name}"
    return ""


def _write_dimensions(dimensions: tuple[str, ...]) -> str:
    if not dimensions:
        return ""
    sizes = [int(size) for size in dimensions if size.isdigit()]
    if len(sizes) != len(dimensions):
        return "[]"
    total = 1
    for size in sizes:
        total *= size
    return f"[{total}]" if 0 < total < _MAX_ARRAY else "[]"


def _fold_field_name(name: str) -> str:
    """Return a name as fields of messages are called."""
    folded = re.sub(r"_+", "_", re.sub(r"(?<=[a-z0-9])(?=[A-Z])", "_", name)).lower().strip("_")
    return folded if folded[:1].isalpha() else f"field_{folded}"
