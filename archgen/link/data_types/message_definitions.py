"""Turn types with fields into definitions of messages, as if their `.msg`, `.srv` and `.action` files were there.

Name the messages that types define by their fields: `<project>_msgs/msg/<Name>`, unless `message` says otherwise.

Types of a library are messages of the library's package, the same for all projects that use it.

Read what a type says of its message: fields, constants, values, and the names that a generic type is made for.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from typing import TypedDict

from archgen.diagnostics import Diagnostic, Label, Span, diagnose_repetition, did_you_mean, first_written_span
from archgen.frozen import NamedTuple, replace
from archgen.link import mapping_values
from archgen.link.data_types.field_types import FieldTypeReader, TypeSources, is_bound_name
from archgen.model.generic_names import read_generic_name
from archgen.model.known_interfaces import Interface, InterfaceConstant, InterfaceField
from archgen.model.message_types import PART_KEYS, ConceptualType, DataConstant, DataField
from archgen.schema.quantity_wording import clip_text
from archgen.schema.short_forms import fold_type_name
from archgen.syntax.interface_definitions import INVALID_INTERFACE, InterfaceDefinition, explain_bad_name
from archgen.syntax.interface_literals import (
    STRING_TYPES,
    FieldType,
    TypeComplaint,
    explain_bad_default,
    explain_bad_literal,
    list_literal_types,
)
from archgen.syntax.yaml_tree import MappingEntry, MappingNode, ScalarNode, SequenceNode


class TypeReading(NamedTuple):
    """The type that is read, the grammar that its message follows, and where findings go."""

    name: str
    ros1: bool
    diagnostics: list[Diagnostic]
    is_damaged: bool = False
    """Whether something in the type could not be read: that is reported, and may be what seems to be missing."""

    def report(self, rule: str, message: str, span: Span, help_line: str | None = None) -> None:
        """Report what is wrong with the type."""
        self.diagnostics.append(Diagnostic(rule, message, span, help=help_line, element=self.name))


class TypeContent(TypedDict):
    """What a type says of its message, as the fields of `ConceptualType`."""

    fields: tuple[DataField, ...] | None
    constants: tuple[DataConstant, ...]
    values: tuple[str, ...]
    part_fields: dict[str, tuple[DataField, ...]]
    generic: tuple[str, ...]


_CONTENT_KEYS = frozenset({"fields", "constants", "values", "generic", *PART_KEYS})


def read_type_content(body: MappingNode, reading: TypeReading) -> TypeContent:
    """Return what a type says of its message. What ROS would refuse is reported and left out."""
    # Nearly every type is only mapped to a message.
    if _CONTENT_KEYS.isdisjoint(body.entries):
        return {"fields": None, "constants": (), "values": (), "part_fields": {}, "generic": ()}
    fields = _read_fields(body, "fields", reading)
    parts = {key: part for key in PART_KEYS if (part := _read_fields(body, key, reading)) is not None}
    values = tuple(_read_names(body, "values", reading))
    if values and fields is not None:
        _report_beside(body, "fields", "values", reading, "a type has fields, or is one of several values")
        fields = None
    if parts and (fields is not None or values):
        written_key = "fields" if fields is not None else "values"
        _report_beside(body, written_key, next(iter(parts)), reading, "a service or an action has no fields of its own")
        fields, values = None, ()
    constants = tuple(_read_constants(body, set(values), reading))
    generic = tuple(_read_names(body, "generic", reading))
    return {"fields": fields, "constants": constants, "values": values, "part_fields": parts, "generic": generic}


def _report_beside(body: MappingNode, key: str, other_key: str, reading: TypeReading, reason: str) -> None:
    label = Label(body.entries[other_key].key_span, f"`{other_key}`")
    message = f"`{key}` and `{other_key}` exclude each other: {reason}"
    span = body.entries[key].key_span
    help_line = "keep one of them"
    reading.diagnostics.append(
        Diagnostic("wrong-value", message, span, labels=(label,), help=help_line, element=reading.name)
    )


def _read_fields(body: MappingNode, key: str, reading: TypeReading) -> tuple[DataField, ...] | None:
    """Return the fields below a key; None where none are written there."""
    if not isinstance(body.get(key), MappingNode):
        return None
    return tuple(
        _read_field(entry, reading)
        for entry in mapping_values.get_mapping(body, key)
        if _check_name("field", entry.key, entry.key_span, reading)
    )


def _read_field(entry: MappingEntry, reading: TypeReading) -> DataField:
    body = mapping_values.get_body(entry)
    type_text = mapping_values.get_text(body, "type")
    if not type_text and not reading.is_damaged:
        help_line = f"write what it holds: `{entry.key}: float64`"
        reading.report("missing-key", f"the field `{entry.key}` lacks `type`", entry.key_span, help_line)
    default = body.get("default")
    return DataField(
        entry.key,
        fold_type_name(type_text) if type_text else None,
        mapping_values.get_texts(body, "default") if isinstance(default, SequenceNode) else _text_of(default),
        mapping_values.get_text(body, "unit"),
        mapping_values.get_text(body, "comment"),
        at=entry.key_span,
        type_at=mapping_values.get_span(body, "type") if type_text else entry.key_span,
        default_at=mapping_values.get_span(body, "default"),
    )


def _text_of(node: object) -> str | None:
    return node.text if isinstance(node, ScalarNode) and node.value is not None else None


def _check_name(kind: str, name: str, span: Span, reading: TypeReading) -> bool:
    help_line = explain_bad_name(kind, name, ros1=reading.ros1)
    if help_line:
        repaired_name = "_".join(filter(None, name.replace("-", " ").replace("_", " ").split()))
        repaired_name = repaired_name.upper() if kind == "constant" else repaired_name.lower()
        is_repaired = explain_bad_name(kind, repaired_name, ros1=reading.ros1) is None
        guess = did_you_mean(name, [repaired_name]) if is_repaired else None
        reading.report(INVALID_INTERFACE, f"`{clip_text(name)}` is no name of a {kind}", span, guess or help_line)
    return help_line is None


def _read_names(body: MappingNode, key: str, reading: TypeReading) -> Iterator[str]:
    """Yield the names of a list, each once; what is repeated, empty, or no name of a constant is reported."""
    node = body.get(key)
    if isinstance(node, SequenceNode) and not node.items:
        reading.report("wrong-value", f"`{key}` names nothing", node.span, f"name one or more, or leave `{key}` out")
    first_spans = dict[str, Span]()
    for scalar in mapping_values.get_scalars(body, key):
        first_span = first_spans.setdefault(scalar.text, scalar.span)
        if first_span is not scalar.span:
            message = f"`{key}` names `{clip_text(scalar.text)}` twice"
            reading.diagnostics.append(
                diagnose_repetition("wrong-value", message, scalar.span, first_span, element=reading.name)
            )
        elif key == "generic" or _check_name("constant", scalar.text, scalar.span, reading):
            yield scalar.text


def _read_constants(body: MappingNode, taken_names: set[str], reading: TypeReading) -> Iterator[DataConstant]:
    for entry in mapping_values.get_mapping(body, "constants"):
        if entry.key in taken_names:
            message = f"`{entry.key}` is one of the `values`, too"
            reading.report("wrong-value", message, entry.key_span, "constants have names of their own")
        elif _check_name("constant", entry.key, entry.key_span, reading):
            yield from _read_constant(entry, reading)


def _read_constant(entry: MappingEntry, reading: TypeReading) -> Iterator[DataConstant]:
    body = mapping_values.get_body(entry)
    type_node, value_node = (mapping_values.get_scalar(body, key) for key in ("type", "value"))
    if type_node is None or value_node is None:
        if reading.is_damaged:
            return
        missing_key = "value" if type_node else "type"
        help_line = f"write both: `{entry.key}: {{type: uint8, value: 3}}`"
        reading.report("missing-key", f"the constant `{entry.key}` lacks `{missing_key}`", entry.key_span, help_line)
    elif type_node.text not in list_literal_types(ros1=reading.ros1):
        message = f"a constant has a builtin type, not `{clip_text(type_node.text)}`"
        guess = did_you_mean(type_node.text, list_literal_types(ros1=reading.ros1))
        help_line = guess or "it is one such as `uint8`, `float64` or `string`"
        reading.report(INVALID_INTERFACE, message, type_node.span, help_line)
    else:
        value = write_literal(type_node.text, value_node.text, ros1=reading.ros1)
        reason = explain_bad_text(type_node.text, value_node.text, ros1=reading.ros1) or explain_bad_literal(
            type_node.text, value, None, ros1=reading.ros1
        )
        if reason:
            message = f"`{clip_text(value_node.text)}` is no value of `{type_node.text}`"
            reading.report(INVALID_INTERFACE, message, value_node.span, reason)
        else:
            yield DataConstant(entry.key, type_node.text, value, mapping_values.get_text(body, "comment"))


def write_literal(type_name: str, text: str, *, ros1: bool) -> str:
    """Return a value as definitions write it: in ROS 2 a text stands in quotes."""
    if type_name not in STRING_TYPES or ros1:
        return text.strip()
    return '"' + text.replace('"', '\\"') + '"'


def explain_bad_text(type_name: str, text: str, *, ros1: bool) -> str | None:
    """Return why a text cannot stand in a definition, which is read line by line, up to a `#`; None if it can.

    In ROS 1 the text of a constant goes on to the end of its line.
    """
    if type_name in STRING_TYPES and ("\n" in text or "\r" in text):
        return "in a definition a text stands on one line"
    if type_name in STRING_TYPES and "#" in text and not ros1:
        return "in a definition `#` begins a comment"
    return None


_PART_KEYS_BY_KIND = {"srv": PART_KEYS[:2], "action": PART_KEYS}
_LIMITS = (("uint8", 2**8), ("uint16", 2**16))
MAX_TAKEN_FIELDS = 20_000
"""Fields that services and actions may take from the types that they name: each may take the same ones."""
VALUE_FIELD = "value"
"""The field of an enumeration's message, which holds one of its constants."""


class TypeDefinition(NamedTuple):
    """A message that a type defines, and the span of the type."""

    type_name: str
    span: Span
    definition: InterfaceDefinition
    is_implied: bool
    """Whether it only follows from the types that the type names: then a definition elsewhere counts."""


class _DefinitionPart(NamedTuple):
    """The fields and constants of a message, or of a part of a service or action."""

    fields: tuple[InterfaceField, ...]
    constants: tuple[InterfaceConstant, ...] = ()
    references: tuple[tuple[str, Span], ...] = ()


class DefinitionMaker:
    """Makes the definitions of a project's types, and reports what ROS would refuse in their fields."""

    def __init__(
        self, types: Mapping[str, ConceptualType], type_reader: FieldTypeReader, diagnostics: list[Diagnostic]
    ) -> None:
        self._types = types
        self._type_reader = type_reader
        self._diagnostics = diagnostics
        self._taken_count = 0

    def make_definition(self, conceptual_type: ConceptualType, span: Span) -> TypeDefinition:
        """Return the definition of the message that a type is."""
        kind, message = find_message_kind(conceptual_type), conceptual_type.message or ""
        parts = (
            [self._make_message_part(conceptual_type)]
            if kind == "msg"
            else [self._make_inner_part(conceptual_type, key) for key in _PART_KEYS_BY_KIND[kind]]
        )
        constants = tuple(part.constants for part in parts)
        interface = Interface(message, tuple(part.fields for part in parts), constants if any(constants) else ())
        references = tuple(reference for part in parts for reference in part.references)
        definition = InterfaceDefinition(interface, references, ())
        return TypeDefinition(conceptual_type.name, span, definition, is_implied=not conceptual_type.has_content)

    def check_fields(self, conceptual_type: ConceptualType) -> None:
        """Report what is wrong with the fields of a type of which no message is made."""
        for part in (conceptual_type.fields or (), *conceptual_type.part_fields.values()):
            self._make_part(part, conceptual_type)

    def _make_message_part(self, conceptual_type: ConceptualType) -> _DefinitionPart:
        written = self._make_part(conceptual_type.fields or (), conceptual_type)
        constants = tuple(
            InterfaceConstant(each.name, each.type, each.value, " ".join((each.comment or "").split()))
            for each in conceptual_type.constants
        )
        if not conceptual_type.values:
            return _DefinitionPart(written.fields, constants, written.references)
        count = len(conceptual_type.values)
        value_type = next((name for name, limit in _LIMITS if count <= limit), "uint32")
        values = (
            InterfaceConstant(name, value_type, str(number)) for number, name in enumerate(conceptual_type.values)
        )
        return _DefinitionPart((InterfaceField(VALUE_FIELD, value_type),), (*values, *constants))

    def _make_inner_part(self, conceptual_type: ConceptualType, key: str) -> _DefinitionPart:
        """Return a part of a service or action: its fields as written, or those of the type that is named."""
        inner_name = getattr(conceptual_type, key)
        inner_type = self._types.get(inner_name) if inner_name else None
        if inner_type is None or key in conceptual_type.part_fields:
            return self._make_part(conceptual_type.part_fields.get(key, ()), conceptual_type)
        if inner_type.fields is None:
            text = f"`{conceptual_type.name}` takes the fields of `{inner_name}` as its {key}, and they are not known"
            field_name = "_".join(inner_name.lower().split())
            help_line = f"write them: `{key}: {{{clip_text(field_name)}: {inner_name}}}`"
            self._report(text, conceptual_type.at, help_line, conceptual_type)
            return _DefinitionPart(())
        self._taken_count += len(inner_type.fields)
        if self._taken_count > MAX_TAKEN_FIELDS:
            text = f"`{conceptual_type.name}` and others take more than {MAX_TAKEN_FIELDS:,} fields from the types they name"
            help_line = "name one field that holds the type: no service needs so many"
            self._diagnostics.append(
                Diagnostic("too-large", text, conceptual_type.at, help=help_line, element=conceptual_type.name)
            )
            return _DefinitionPart(())
        return self._make_message_part(inner_type)

    def _make_part(self, fields: Sequence[DataField], conceptual_type: ConceptualType) -> _DefinitionPart:
        made_fields, references = list[InterfaceField](), list[tuple[str, Span]]()
        for field in fields:
            field_type = self._type_reader.read_type(field, conceptual_type)
            if isinstance(field_type, TypeComplaint):
                self._report(field_type.message, field.type_at, field_type.help, conceptual_type)
            if not isinstance(field_type, FieldType):
                continue
            default = self._write_default(field, field_type, conceptual_type)
            made_fields.append(InterfaceField(field.name, field_type.name, field_type.array, default, field.meaning))
            if "/" in field_type.base:
                references.append((field_type.base, field.type_at))
        return _DefinitionPart(tuple(made_fields), (), tuple(references))

    def _write_default(self, field: DataField, field_type: FieldType, conceptual_type: ConceptualType) -> str:
        """Return the default of a field as definitions write it; empty for none, and for one that ROS refuses."""
        if field.default is None:
            return ""
        ros1, items = self._type_reader.ros1, (field.default,) if isinstance(field.default, str) else field.default
        literals = [write_literal(field_type.base, item, ros1=ros1) for item in items]
        literal = literals[0] if isinstance(field.default, str) else f"[{', '.join(literals)}]"
        reason = next(self._explain_bad_default(items, field, field_type, literal), None)
        if reason is None:
            return literal
        self._report(
            f"`{clip_text(literal)}` is no default of `{field.name}`", field.default_at, reason, conceptual_type
        )
        return ""

    def _explain_bad_default(
        self, items: Sequence[str], field: DataField, field_type: FieldType, literal: str
    ) -> Iterator[str]:
        if self._type_reader.ros1:
            yield "a field of ROS 1 has no default"
        elif not field_type.is_builtin:
            yield "only a field of a builtin type has a default"
        elif field_type.array and isinstance(field.default, str):
            yield "the default of an array is a list, as in `[1, 2]`"
        elif not field_type.array and not isinstance(field.default, str):
            yield f"a list is the default of an array, as in `{field_type.name}[]`"
        else:
            yield from filter(None, (explain_bad_text(field_type.base, item, ros1=False) for item in items))
            yield from filter(None, [explain_bad_default(field_type, literal)])

    def _report(self, message: str, span: Span, help_line: str | None, conceptual_type: ConceptualType) -> None:
        # What generic types make has the fields of the generic one: it is wrong there, once.
        element = read_generic_name(conceptual_type.name).base
        self._diagnostics.append(Diagnostic(INVALID_INTERFACE, message, span, help=help_line, element=element))


CONFLICTING_MESSAGE = "conflicting-message"
_WORD = re.compile(r"[A-Za-z0-9]+")
_MESSAGE_NAME = re.compile(r"[A-Z][A-Za-z0-9]*\Z", re.ASCII)


def name_messages(
    types: dict[str, ConceptualType], sources: TypeSources, spans: Mapping[str, Span], diagnostics: list[Diagnostic]
) -> list[str]:
    """Give the types that define a message its name, and return these types; what keeps one from it is reported.

    `spans` say where types that nothing declares are used.
    """
    first_types, defining_types = dict[str, ConceptualType](), list[str]()
    for name, conceptual_type in types.items():
        if conceptual_type.generic and conceptual_type.message:
            diagnostics.append(_diagnose_generic_message(conceptual_type))
            types[name] = replace(conceptual_type, message=None)
        if not defines_message(conceptual_type, types):
            continue
        kind = find_message_kind(conceptual_type)
        package = _find_package(types, name, sources)
        spelled_name = spell_message_name(name, types)
        message = conceptual_type.message or (f"{package}/{kind}/{spelled_name}" if spelled_name else None)
        span = first_written_span(conceptual_type.message_at, conceptual_type.at, spans.get(name, conceptual_type.at))
        named_type = types[name] = replace(conceptual_type, message=message)
        conflict = _find_conflict(named_type, kind, span, first_types)
        if conflict is None:
            defining_types.append(name)
            first_types[str(message)] = replace(named_type, at=span)
        # What only names its request and response describes a message; it need not be the one who defines it.
        elif named_type.has_content:
            diagnostics.append(conflict)
    return defining_types


def defines_message(conceptual_type: ConceptualType, types: Mapping[str, ConceptualType]) -> bool:
    """Whether a type says what is in its message: itself, or by the types of its request and response."""
    if conceptual_type.generic:
        return False
    return conceptual_type.has_content or is_made_of_parts(conceptual_type, types)


def is_made_of_parts(conceptual_type: ConceptualType, types: Mapping[str, ConceptualType]) -> bool:
    """Whether all that it names as request, response and feedback are types with fields."""
    names = [name for key in PART_KEYS if (name := getattr(conceptual_type, key))]
    inner_types = [types.get(name) for name in names]
    return bool(names) and all(each is not None and each.fields is not None for each in inner_types)


def find_message_kind(conceptual_type: ConceptualType) -> str:
    """Return the kind of what a type defines: `msg`, `srv` or `action`."""
    parts = {key for key in PART_KEYS if getattr(conceptual_type, key) or key in conceptual_type.part_fields}
    return "action" if "feedback" in parts else "srv" if parts else "msg"


def _find_package(types: Mapping[str, ConceptualType], type_name: str, sources: TypeSources) -> str:
    """Return the package of a type's message: a library's where all that its name is made of comes from there.

    A library's generic type that holds a type of the project is a message of the project: the library does not know it.
    """
    libraries, pending_names = set[str | None](), [type_name]
    while pending_names:
        name = pending_names.pop().partition("[")[0]
        base, arguments = read_generic_name(name) if is_bound_name(name, types) else (name, ())
        declared_type = types.get(base)
        if declared_type is not None and declared_type.origin == "project":
            libraries.add(declared_type.library)
        pending_names += arguments
    library = libraries.pop() if len(libraries) == 1 else None
    return sources.library_packages.get(library or "", f"{sources.project_id}_msgs")


def spell_message_name(type_name: str, types: Mapping[str, ConceptualType]) -> str | None:
    """Return what the message of a type is called, its words joined in capitals; None where no name of ROS comes of it.

    Only names of generic ones among `types` are taken apart.
    """
    # Letters that ROS does not know cannot just be left out: `Größe` is no `Gre`.
    name = "".join(_list_words(types, type_name)) if type_name.isascii() else ""
    return name if _MESSAGE_NAME.match(name) else None


def _list_words(types: Mapping[str, ConceptualType], type_name: str) -> Iterator[str]:
    """Yield the words of a name with a capital each; a message's own name counts, without its package."""
    pending_names = [type_name]
    while pending_names:
        name = pending_names.pop()
        base, arguments = read_generic_name(name) if is_bound_name(name, types) else (name, ())
        yield from (word[:1].upper() + word[1:] for word in _WORD.findall(base.rpartition("/")[2]))
        pending_names += reversed(arguments)


def _diagnose_generic_message(generic_type: ConceptualType) -> Diagnostic:
    name, span = generic_type.name, first_written_span(generic_type.message_at, generic_type.at)
    bound_name = f"{name}<{', '.join(['Pose'] * len(generic_type.generic))}>"
    help_line = f"leave it out; what is made of it may have one: `{bound_name}: {{message: {generic_type.message}}}`"
    text = f"`{name}` is generic, which is no single message"
    return Diagnostic(CONFLICTING_MESSAGE, text, span, help=help_line, element=name)


_KIND_PHRASES = {"msg": "fields of a message", "srv": "parts of a service", "action": "parts of an action"}


def _find_conflict(
    conceptual_type: ConceptualType, kind: str, span: Span, first_types: Mapping[str, ConceptualType]
) -> Diagnostic | None:
    message, name = conceptual_type.message, conceptual_type.name
    help_line, labels = f"name it: `message: my_msgs/{kind}/Name`", tuple[Label, ...]()
    if message is None:
        text = f"no message can be called after the type `{name}`: in ROS a name is letters and digits, a letter first"
    elif message.split("/")[1] != kind:
        text = f"`{name}` has the {_KIND_PHRASES[kind]}, and `{message}` is none"
    elif message in first_types:
        first_type = first_types[message]
        labels = (Label(first_type.at, f"`{first_type.name}` is this message"),)
        text = f"the types `{first_type.name}` and `{name}` both define `{message}`"
    else:
        return None
    return Diagnostic(CONFLICTING_MESSAGE, text, span, labels=labels, help=help_line, element=name)
