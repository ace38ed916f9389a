"""Load the interfaces of one ROS distribution: those that ship with archgen, and over them the project's own.

Without a distribution every name that archgen holds for any is known, and no name is ever wrong. Of a distribution that
archgen does not hold, only the project's own definitions are known.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from functools import lru_cache

from archgen.diagnostics.diagnostic import Diagnostic, Label
from archgen.diagnostics.source_span import Span
from archgen.diagnostics.suggestions import find_closest
from archgen.link.shipped_interfaces import LazyInterfaces, list_answering_distros, load_shipped_interfaces
from archgen.model.known_interfaces import Interface, Interfaces
from archgen.model.ros_distro import is_ros_1
from archgen.syntax.interface_definitions import INVALID_INTERFACE, InterfaceDefinition, parse_definition

_DEFINITION_PATH = re.compile(
    r"(?:.*/)?([A-Za-z][A-Za-z0-9_]*)/(msg|srv|action)/([A-Za-z][A-Za-z0-9_]*)\.(\w+)\Z", re.ASCII
)
_FULL_NAME = re.compile(r"[A-Za-z][A-Za-z0-9_]*/(?:msg|srv|action)/[A-Za-z][A-Za-z0-9_]*\Z", re.ASCII)
_ROS2_NAME = re.compile(r"[a-z](?:_?[a-z0-9])*/(?:msg|srv|action)/[A-Z][A-Za-z0-9]*\Z", re.ASCII)


def load_interfaces(
    distro: str | None,
    definition_files: Sequence[tuple[str, str]] = (),
    inline_definitions: Mapping[str, tuple[str, Span]] | None = None,
) -> tuple[Interfaces, tuple[Diagnostic, ...]]:
    """Return the interfaces known for a distribution, and what is wrong with the project's own definitions.

    `definition_files` are pairs of path and text; `inline_definitions` are those of `ros: {definitions: ...}` by full
    name, each with the span of its text.
    """
    if not definition_files and not inline_definitions:
        return load_shipped_interfaces(distro), ()
    return _load_own_definitions(distro, tuple(definition_files), tuple((inline_definitions or {}).items()))


@lru_cache(4)
def _load_own_definitions(
    distro: str | None,
    definition_files: tuple[tuple[str, str], ...],
    inline_definitions: tuple[tuple[str, tuple[str, Span]], ...],
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
    interfaces = _merge_interfaces(
        shipped, {name: definition.interface for name, definition in own_definitions.items()}
    )
    # Only after all are merged: a definition may name a message that a later one defines.
    for definition in own_definitions.values():
        diagnostics += _find_unknown_fields(definition, interfaces)
    diagnostics += _find_self_containing(own_definitions)
    return interfaces, tuple(diagnostics)


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
            diagnostics.append(
                Diagnostic(INVALID_INTERFACE, f"`{file}` does not say which interface it defines", span, help=help_line)
            )
        elif _check_name(name, span, diagnostics, ros1=ros1):
            yield name, parse_definition(text, name, file, ros1=ros1), span
    for name, (text, span) in inline_definitions.items():
        if not _FULL_NAME.match(name):
            help_line = "it is written `package/msg/Name` (or srv, action)"
            diagnostics.append(
                Diagnostic(INVALID_INTERFACE, f"`{name}` is no name of an interface", span, help=help_line)
            )
        elif _check_name(name, span, diagnostics, ros1=ros1):
            yield name, _move_spans(parse_definition(text, name, span.file, ros1=ros1), span), span


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


def _find_unknown_fields(definition: InterfaceDefinition, interfaces: Interfaces) -> Iterator[Diagnostic]:
    """Report fields whose message certainly does not exist (an error), or looks like a misspelt one (a note)."""
    for message, span in definition.references:
        answer = interfaces.status_of(message)
        if answer == "known":
            continue
        guess = interfaces.find_nearest(message)
        help_line = f"did you mean `{_short_message_name(guess)}`?" if guess and "/msg/" in guess else None
        if answer == "wrong":
            yield Diagnostic(INVALID_INTERFACE, f"there is no message `{message}`", span, help=help_line)
        # The package is unknown or known only in part, so the message may well exist. A note is worth it only if a
        # package of nearly the same name has it: `geometry_msg/Pose` is most likely a slip.
        elif (
            guess and help_line and interfaces.has_names and find_closest(message.split("/")[0], [guess.split("/")[0]])
        ):
            yield Diagnostic("unchecked-message", f"archgen holds no message `{message}`", span, help=help_line)


def _find_self_containing(own_definitions: Mapping[str, InterfaceDefinition]) -> Iterator[Diagnostic]:
    """Report fields through which a message of the project contains itself: ROS refuses such messages."""
    for name, definition in own_definitions.items():
        for message, span in definition.references:
            if name in _list_inner_messages(message, own_definitions):
                detour = "" if message == name else f", through `{message}`"
                yield Diagnostic(
                    INVALID_INTERFACE, f"`{name}` holds itself{detour}", span, help="name it by an id or an index"
                )


def _list_inner_messages(name: str, own_definitions: Mapping[str, InterfaceDefinition]) -> set[str]:
    """Return a message and all messages of the project that it contains, directly or not."""
    inner_messages, pending_messages = set[str](), [name]
    while pending_messages:
        message = pending_messages.pop()
        if message not in inner_messages and message in own_definitions:
            inner_messages.add(message)
            pending_messages += (inner for inner, _ in own_definitions[message].references)
    return inner_messages


def _short_message_name(message: str) -> str:
    """Return a full name as definitions write it, without `msg`."""
    return message.replace("/msg/", "/")


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
