"""Load the interfaces of one ROS distribution: those that ship with archgen, and over them the project's own.

Without a distribution every name that archgen holds for any is known, and no name is ever wrong. Of a distribution that
archgen does not hold, only the project's own definitions are known.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from functools import lru_cache
from typing import TYPE_CHECKING

from archgen.diagnostics import Diagnostic, Label, Span, find_closest
from archgen.frozen import NamedTuple, replace
from archgen.link.data_types.field_types import UNKNOWN_FIELD_TYPE, TypeMention
from archgen.link.shipped_interfaces import LazyInterfaces, list_answering_distros, load_shipped_interfaces
from archgen.model.graph_search import find_rings
from archgen.model.known_interfaces import Interface, Interfaces
from archgen.model.ros_distro import is_ros_1
from archgen.syntax.interface_definitions import INVALID_INTERFACE, InterfaceDefinition, parse_interface_definition

if TYPE_CHECKING:
    from archgen.link.data_types.message_definitions import TypeDefinition

_DEFINITION_PATH = re.compile(
    r"(?:.*/)?([A-Za-z][A-Za-z0-9_]*)/(msg|srv|action)/([A-Za-z][A-Za-z0-9_]*)\.(\w+)\Z", re.ASCII
)
_FULL_NAME = re.compile(r"[A-Za-z][A-Za-z0-9_]*/(?:msg|srv|action)/[A-Za-z][A-Za-z0-9_]*\Z", re.ASCII)
_ROS2_NAME = re.compile(r"[a-z](?:_?[a-z0-9])*/(?:msg|srv|action)/[A-Z][A-Za-z0-9]*\Z", re.ASCII)


class TypeMessages(NamedTuple):
    """The messages that types of the project define by their fields, and the messages that these fields name."""

    definitions: tuple[TypeDefinition, ...] = ()
    mentions: tuple[TypeMention, ...] = ()


NO_TYPE_MESSAGES = TypeMessages()


def load_interfaces(
    distro: str | None,
    definition_files: Sequence[tuple[str, str]] = (),
    inline_definitions: Mapping[str, tuple[str, Span]] | None = None,
    type_messages: TypeMessages = NO_TYPE_MESSAGES,
) -> tuple[Interfaces, tuple[Diagnostic, ...]]:
    """Return the interfaces known for a distribution, and what is wrong with the project's own definitions.

    `definition_files` are pairs of path and text; `inline_definitions` are those of `ros: {definitions: ...}` by full
    name, each with the span of its text.
    """
    if not definition_files and not inline_definitions and type_messages == NO_TYPE_MESSAGES:
        return load_shipped_interfaces(distro), ()
    return _load_own_definitions(
        distro, tuple(definition_files), tuple((inline_definitions or {}).items()), type_messages
    )


@lru_cache(4)
def _load_own_definitions(
    distro: str | None,
    definition_files: tuple[tuple[str, str], ...],
    inline_definitions: tuple[tuple[str, tuple[str, Span]], ...],
    type_messages: TypeMessages,
) -> tuple[Interfaces, tuple[Diagnostic, ...]]:
    """Lay the project's own definitions over what ships; cached, because most revisions of a project share them."""
    # The arguments are tuples, not a list and a dict, to be hashable for the cache.
    shipped = load_shipped_interfaces(distro)
    is_ros1 = is_ros_1(distro)
    diagnostics = list[Diagnostic]()
    own_definitions = dict[str, InterfaceDefinition]()
    spans = dict[str, Span]()
    for name, definition, span in _read_definitions(
        definition_files, dict(inline_definitions), diagnostics, ros1=is_ros1
    ):
        # The first definition of a name counts, files before inline ones.
        if name in own_definitions:
            label = Label(spans[name], "the first one")
            diagnostics.append(Diagnostic(INVALID_INTERFACE, f"`{name}` is defined twice", span, labels=(label,)))
            continue
        own_definitions[name], spans[name] = definition, span
        diagnostics += definition.diagnostics
    file_definitions = dict(own_definitions)
    for type_definition in type_messages.definitions:
        conflict = _find_conflict(type_definition, shipped, spans, ros1=is_ros1)
        if conflict is None:
            name = type_definition.definition.interface.name
            own_definitions[name] = type_definition.definition
        # What the types of its request and response say describes a service; its definition is where it is.
        elif not type_definition.is_implied:
            diagnostics.append(conflict)
    interfaces = _merge_interfaces(
        shipped, {name: definition.interface for name, definition in own_definitions.items()}
    )
    # Only after all are merged: a definition may name a message that a later one defines.
    for definition in file_definitions.values():
        for message, span in definition.references:
            diagnostics += _find_unknown_field(TypeMention(message, span, ""), interfaces)
    for mention in type_messages.mentions:
        diagnostics += _find_unknown_field(mention, interfaces)
    diagnostics += _find_self_containing(file_definitions, own_definitions)
    return interfaces, tuple(diagnostics)


def _find_conflict(
    type_definition: TypeDefinition, shipped: Interfaces, spans: Mapping[str, Span], *, ros1: bool
) -> Diagnostic | None:
    """Return why a type does not define its message: there is one already, or it is none in ROS 2."""
    from archgen.link.data_types.message_definitions import CONFLICTING_MESSAGE

    name, type_name = type_definition.definition.interface.name, type_definition.type_name
    name_problems = list[Diagnostic]()
    if not _check_name(name, type_definition.span, name_problems, ros1=ros1):
        return replace(name_problems[0], element=type_name)
    if name not in shipped.names and name not in spans:
        return None
    labels = (Label(spans[name], "its definition"),) if name in spans else ()
    is_own = name in spans
    return Diagnostic(
        CONFLICTING_MESSAGE,
        f"the type `{type_name}` defines `{name}` once more{'' if is_own else ', which is a message of ROS'}",
        type_definition.span,
        labels=labels,
        help="keep one of them" if is_own else "name a message of your own: `message: my_msgs/msg/Name`",
        element=type_name,
    )


def interface_name_of(file: str) -> str | None:
    """Return the full name of the interface in a file `.../package/msg/Name.msg`, None for any other path."""
    match = _DEFINITION_PATH.match(file)
    return f"{match[1]}/{match[2]}/{match[3]}" if match and match[2] == match[4] else None


def _read_definitions(
    files: Sequence[tuple[str, str]],
    inline_definitions: Mapping[str, tuple[str, Span]],
    diagnostics: list[Diagnostic],
    *,
    ros1: bool,
) -> Iterator[tuple[str, InterfaceDefinition, Span]]:
    """Yield name, definition and span of each of the project's definitions; one without a valid name is reported."""
    for file, text in files:
        name, span = interface_name_of(file), Span.of_file(file)
        if name is None:
            help_line = "a definition's path ends in its package, its kind and its name: `ramcip_msgs/msg/Grasp.msg`"
            message = f"`{file}` does not say which interface it defines"
            diagnostics.append(Diagnostic(INVALID_INTERFACE, message, span, help=help_line))
        elif _check_name(name, span, diagnostics, ros1=ros1):
            yield name, parse_interface_definition(text, name, file, ros1=ros1), span
    for name, (text, span) in inline_definitions.items():
        if not _FULL_NAME.match(name):
            help_line = "it is written `package/msg/Name` (or srv, action)"
            diagnostics.append(
                Diagnostic(INVALID_INTERFACE, f"`{name}` is no name of an interface", span, help=help_line)
            )
        elif _check_name(name, span, diagnostics, ros1=ros1):
            yield name, _move_spans(parse_interface_definition(text, name, span.file, ros1=ros1), span), span


def _check_name(name: str, span: Span, diagnostics: list[Diagnostic], *, ros1: bool) -> bool:
    if ros1 or _ROS2_NAME.match(name):
        return True
    help_line = "packages are written `like_this`, interfaces `LikeThis`, without underscores"
    diagnostics.append(
        Diagnostic(INVALID_INTERFACE, f"`{name}` is no name of an interface in ROS 2", span, help=help_line)
    )
    return False


def _move_spans(definition: InterfaceDefinition, span: Span) -> InterfaceDefinition:
    """Move the spans of a definition inside YAML to where its text begins; the line goes into the message.

    A block's indentation and escapes in quotes make exact columns unknowable here.
    """
    moved_diagnostics = (
        replace(d, span=span, message=f"line {d.span.line} of the definition: {d.message}", labels=())
        for d in definition.diagnostics
    )
    references = ((name, span) for name, _ in definition.references)
    return InterfaceDefinition(definition.interface, tuple(references), tuple(moved_diagnostics))


def _find_unknown_field(mention: TypeMention, interfaces: Interfaces) -> Iterator[Diagnostic]:
    """Report a field whose message certainly does not exist (an error), or looks like a misspelt one (a note).

    The mention is that of a type, or without an element that of a definition.
    """
    message, span, element = mention.name, mention.span, mention.element or None
    answer = interfaces.status_of(message)
    if answer == "known":
        return
    guess = interfaces.find_nearest(message)
    help_line = f"did you mean `{guess.replace('/msg/', '/')}`?" if guess and "/msg/" in guess else None
    if answer == "wrong":
        rule = UNKNOWN_FIELD_TYPE if element else INVALID_INTERFACE
        yield Diagnostic(rule, f"there is no message `{message}`", span, help=help_line, element=element)
    # The package is unknown or known only in part, so the message may well exist. A note is worth it only if a
    # package of nearly the same name has it: `geometry_msg/Pose` is most likely a slip.
    elif guess and help_line and interfaces.has_names and find_closest(message.split("/")[0], [guess.split("/")[0]]):
        text = f"archgen holds no message `{message}`"
        yield Diagnostic("unchecked-message", text, span, help=help_line, element=element)


def _find_self_containing(
    file_definitions: Mapping[str, InterfaceDefinition], own_definitions: Mapping[str, InterfaceDefinition]
) -> Iterator[Diagnostic]:
    """Report fields through which a message of the project contains itself: ROS refuses such messages.

    Circles of types alone are found before there are definitions of them.
    """
    held_messages = {
        name: [message for message, _ in definition.references if message in own_definitions]
        for name, definition in own_definitions.items()
    }
    ring_numbers = {name: number for number, ring in enumerate(find_rings(held_messages)) for name in ring}
    for name, definition in file_definitions.items():
        for message, span in definition.references:
            if name in ring_numbers and ring_numbers.get(message) == ring_numbers[name]:
                detour = "" if message == name else f", through `{message}`"
                yield Diagnostic(
                    INVALID_INTERFACE, f"`{name}` holds itself{detour}", span, help="name it by an id or an index"
                )


def _merge_interfaces(shipped: Interfaces, own_interfaces: Mapping[str, Interface]) -> Interfaces:
    """Lay the project's definitions over what ships.

    A package that the project defines counts as known in full, so any other name in it is wrong; unless archgen already
    knows a part of a package of that name: then the project adds to it, and other names in it may or may not exist.
    """
    packages = frozenset(name.split("/", 1)[0] for name in own_interfaces)
    shipped_packages = shipped.known_packages()
    return replace(
        shipped,
        names=shipped.names | frozenset(own_interfaces),
        complete_packages=shipped.complete_packages | (packages - shipped_packages),
        definitions=LazyInterfaces(list_answering_distros(shipped.distro), own_interfaces),
        project_packages=packages,
    )
