"""Name the messages that types define by their fields: `<project>_msgs/msg/<Name>`, unless `message` says otherwise.

Types of a library are messages of the library's package, the same for all projects that use it.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from dataclasses import replace

from archgen.diagnostics.diagnostic import Diagnostic, Label
from archgen.diagnostics.source_span import Span, first_written_span
from archgen.link.data_types.field_types import TypeSources
from archgen.link.data_types.generic_types import is_bound_name
from archgen.model.generic_names import read_generic_name
from archgen.model.message_types import PART_KEYS, ConceptualType

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
