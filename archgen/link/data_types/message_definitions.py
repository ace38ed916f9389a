"""Turn types with fields into definitions of messages, as if their `.msg`, `.srv` and `.action` files were there.

Name the messages that types define by their fields: `<project>_msgs/msg/<Name>`, unless `message` says otherwise.

Types of a library are messages of the library's package, the same for all projects that use it.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence

from archgen.diagnostics import Diagnostic, Label, Span, first_written_span
from archgen.frozen import NamedTuple, replace
from archgen.link.data_types.field_reading import explain_bad_text, write_literal
from archgen.link.data_types.field_types import FieldTypeReader, TypeSources, is_bound_name
from archgen.model.generic_names import read_generic_name
from archgen.model.known_interfaces import Interface, InterfaceConstant, InterfaceField
from archgen.model.message_types import PART_KEYS, ConceptualType, DataField
from archgen.schema.quantity_wording import clip_text
from archgen.syntax.interface_definitions import INVALID_INTERFACE, InterfaceDefinition
from archgen.syntax.interface_literals import FieldType, TypeComplaint, explain_bad_default

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
