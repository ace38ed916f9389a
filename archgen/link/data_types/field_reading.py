"""Read what a type says of its message: fields, constants, values, and the names that a generic type is made for."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TypedDict

from archgen.diagnostics import Diagnostic, Label, Span, diagnose_repetition, did_you_mean
from archgen.frozen import NamedTuple
from archgen.link import mapping_values
from archgen.model.message_types import PART_KEYS, DataConstant, DataField
from archgen.schema.quantity_wording import clip_text
from archgen.schema.short_forms import fold_type_name
from archgen.syntax.interface_definitions import INVALID_INTERFACE, explain_bad_name
from archgen.syntax.interface_literals import STRING_TYPES, explain_bad_literal, list_literal_types
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
