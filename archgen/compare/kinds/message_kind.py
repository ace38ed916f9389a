"""The message definitions of the project's own packages: fields, constants, defaults and comments."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from typing import NamedTuple, TypeVar

from archgen.compare.architecture_version import ArchitectureVersion
from archgen.compare.element_likeness import letter_pairs
from archgen.compare.element_relations import ElementRelations, project_messages
from archgen.compare.kinds.key_spec import Effect, KeySpec, ReadContext, Worsening
from archgen.compare.kinds.kind_spec import FeatureSpec, KindSpec
from archgen.compare.kinds.shared_features import mark_values
from archgen.diagnostics.source_span import NO_SPAN, Span
from archgen.model.known_interfaces import Interface, InterfaceConstant, InterfaceField

_Named = TypeVar("_Named", InterfaceField, InterfaceConstant)


class ProjectMessage(NamedTuple):
    """An interface of one of the project's packages; its definition is None if only its name is known.

    `at` is the type that defines it by its fields; the place of a file's definition is not known here.
    """

    name: str
    definition: Interface | None
    at: Span = NO_SPAN


def _list_messages(version: ArchitectureVersion) -> Mapping[str, ProjectMessage]:
    definitions = version.architecture.interfaces.definitions
    type_spans = {each.message: each.at for each in version.architecture.types.values() if each.has_content}
    return {
        name: ProjectMessage(name, definitions.get(name), type_spans.get(name, NO_SPAN))
        for name in project_messages(version.architecture)
    }


def _read_fields(message: ProjectMessage, _context: ReadContext) -> tuple[str, ...]:
    """Return the fields of an interface as ROS writes them, with `---` between the parts of a service or action."""
    lines: list[str] = []
    for part in message.definition.parts if message.definition else ():
        lines += (["---"] if part is not message.definition.parts[0] else []) if message.definition else []
        lines += [f"{field.type}{field.array} {field.name}" for field in part]
    return tuple(lines)


def _read_constants(message: ProjectMessage, _context: ReadContext) -> Mapping[str, str]:
    """Return the values of the constants, by name, with the part of a service or action in front."""
    return {
        name: f"{constant.type} {constant.value}"
        for name, constant in _list_by_name(message.definition, lambda definition: definition.constants)
    }


def _read_defaults(message: ProjectMessage, _context: ReadContext) -> Mapping[str, str]:
    """Return the values that fields have if nobody sets them."""
    fields = _list_by_name(message.definition, lambda definition: definition.parts)
    return {name: field.default for name, field in fields if field.default}


def _read_comments(message: ProjectMessage, _context: ReadContext) -> Mapping[str, str]:
    """Return what is said about fields and constants: often the unit, the frame, the direction of an axis."""
    fields = _list_by_name(message.definition, lambda definition: definition.parts)
    constants = _list_by_name(message.definition, lambda definition: definition.constants)
    comments = [(name, field.comment) for name, field in fields]
    comments += [(name, constant.comment) for name, constant in constants]
    return {name: comment for name, comment in comments if comment}


def _list_by_name(
    definition: Interface | None, list_parts: Callable[[Interface], tuple[tuple[_Named, ...], ...]]
) -> Iterator[tuple[str, _Named]]:
    """Yield what is in the parts of a definition, with its name: `width`, `request.width`."""
    if definition is None:
        return
    for part_name, part in zip(definition.part_names, list_parts(definition), strict=False):
        for each in part:
            yield f"{part_name}.{each.name}" if part_name else each.name, each


def _mark_fields(_relations: ElementRelations, message: ProjectMessage) -> frozenset[str]:
    parts = message.definition.parts if message.definition else ()
    return mark_values(*(f"{field.name} {field.type}" for part in parts for field in part))


def _mark_types(relations: ElementRelations, message: ProjectMessage) -> frozenset[str]:
    types = relations.architecture.types.values()
    return relations.common_ids("type", [each.name for each in types if each.message == message.name])


MESSAGE = KindSpec(
    "message",
    "Message definitions",
    (
        KeySpec("fields", _read_fields, worsening=Worsening.ALWAYS),
        KeySpec("constants.", _read_constants, Effect.SYSTEM),
        KeySpec("defaults.", _read_defaults, Effect.SYSTEM),
        KeySpec("comments.", _read_comments, Effect.SYSTEM),
        KeySpec("comment", lambda each, _: (each.definition and each.definition.comment) or None, is_prose=True),
    ),
    elements=_list_messages,
    features=(
        FeatureSpec("name", 2, lambda _, message: letter_pairs(message.name.rpartition("/")[2])),
        FeatureSpec("package", 1, lambda _, message: mark_values(message.name.rpartition("/")[0])),
        FeatureSpec("fields", 5, _mark_fields),
        FeatureSpec("users", 4, _mark_types),
    ),
    whole_word="message definition",
)
