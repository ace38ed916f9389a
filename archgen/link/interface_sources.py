"""Load the interfaces of one ROS distribution: those that ship with archgen, and over them the project's own.

Without a distribution every name that archgen holds for any is known, and no name is ever wrong. Of a distribution that
archgen does not hold, only the project's own definitions are known.
"""

from __future__ import annotations

import json
import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from functools import cache, lru_cache
from pathlib import Path
from typing import Any

from archgen.diagnostics.diagnostic import Diagnostic, Label
from archgen.diagnostics.source_span import Span
from archgen.diagnostics.suggestions import find_closest
from archgen.model.known_interfaces import KNOWN_DISTROS, Interface, InterfaceField, Interfaces
from archgen.model.ros_distro import is_ros_1
from archgen.syntax.interface_definitions import INVALID_INTERFACE, InterfaceDefinition, parse_definition

_DATA_FOLDER = Path(__file__).resolve().parent / "ros_interfaces"
_DEFINITION_PATH = re.compile(
    r"(?:.*/)?([A-Za-z][A-Za-z0-9_]*)/(msg|srv|action)/([A-Za-z][A-Za-z0-9_]*)\.(\w+)\Z", re.ASCII
)
_FULL_NAME = re.compile(r"[A-Za-z][A-Za-z0-9_]*/(?:msg|srv|action)/[A-Za-z][A-Za-z0-9_]*\Z", re.ASCII)
_ROS2_NAME = re.compile(r"[a-z](?:_?[a-z0-9])*/(?:msg|srv|action)/[A-Z][A-Za-z0-9]*\Z", re.ASCII)
_SAME_FIELDS_AS = {
    "rolling": "lyrical"
}  # tools/make_ros_interfaces.py writes no fields for rolling: they are lyrical's


class LazyInterfaces(Mapping[str, Interface]):
    """The definitions of interfaces by full name: the project's own, and those that ship, which are read on first use.

    A file of fields is read only when one of its messages is asked for, and then only that message is parsed.
    """

    __slots__ = ("_distros", "_own_interfaces")

    def __init__(self, distros: tuple[str, ...], own_interfaces: Mapping[str, Interface]) -> None:
        """Remember the project's own interfaces, and the distributions to search after them, in order."""
        self._distros = distros
        self._own_interfaces = own_interfaces

    def __getitem__(self, name: str) -> Interface:
        """Return the definition of `package/msg/Name`; raise KeyError where there is none."""
        if name in self._own_interfaces:
            return self._own_interfaces[name]
        for distro in self._distros:
            fields = _load_fields(distro).get(name)
            if fields is not None:
                return Interface(name, (tuple(_parse_field(text) for text in fields),))
        raise KeyError(name)

    def __iter__(self) -> Iterator[str]:
        """Iterate over all names, the project's own first, each once."""
        return iter(
            dict.fromkeys([*self._own_interfaces, *(name for distro in self._distros for name in _load_fields(distro))])
        )

    def __len__(self) -> int:
        """Count the definitions."""
        return sum(1 for _ in self)


class LazyHoldingDistros(Mapping[str, tuple[str, ...]]):
    """The distributions that have an interface, by full name; read when the first name is asked for."""

    __slots__ = ()

    def __getitem__(self, name: str) -> tuple[str, ...]:
        """Return the distributions that have `package/msg/Name`; raise KeyError where there is none."""
        return _load_holding_distros()[name]

    def __iter__(self) -> Iterator[str]:
        """Iterate over the names that any distribution has."""
        return iter(_load_holding_distros())

    def __len__(self) -> int:
        """Count these names."""
        return len(_load_holding_distros())


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
        return _load_shipped_interfaces(distro), ()
    return _load_own_definitions(distro, tuple(definition_files), tuple((inline_definitions or {}).items()))


@lru_cache(4)
def _load_own_definitions(
    distro: str | None,
    definition_files: tuple[tuple[str, str], ...],
    inline_definitions: tuple[tuple[str, tuple[str, Span]], ...],
) -> tuple[Interfaces, tuple[Diagnostic, ...]]:
    """Lay the project's own definitions over what ships; cached, because most revisions of a project share them."""
    # The arguments are tuples, not a list and a dict, to be hashable for the cache.
    shipped = _load_shipped_interfaces(distro)
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
        definitions=LazyInterfaces(_list_distros(shipped.distro), own_interfaces),
        project_packages=packages,
    )


def _list_distros(distro: str | None) -> tuple[str, ...]:
    """Return the distributions whose data answer for a project's distribution: all for None, none if unknown."""
    return KNOWN_DISTROS if distro is None else (distro,) if distro in KNOWN_DISTROS else ()


@cache
def _load_shipped_interfaces(distro: str | None) -> Interfaces:
    """Return the interfaces that ship for a distribution; for None, those of all distributions."""
    names, whole_packages, patch_packages = set[str](), set[str](), set[str]()
    for data_distro in _list_distros(distro):
        names.update(_list_names(data_distro))
        # Without a distribution nothing is "whole": a name that one lacks may exist in another.
        if distro is not None:
            packages = _load_names(data_distro)
            whole_packages.update(package for package, entry in packages.items() if entry["whole"])
            patch_packages.update(package for package, entry in packages.items() if entry.get("patch"))
    return Interfaces(
        distro,
        frozenset(names),
        frozenset(whole_packages),
        LazyInterfaces(_list_distros(distro), {}),
        has_names=bool(_list_distros(distro)),
        patch_packages=frozenset(patch_packages),
        holding_distros=LazyHoldingDistros(),
    )


@cache
def _load_holding_distros() -> dict[str, tuple[str, ...]]:
    distros_by_name = dict[str, tuple[str, ...]]()
    for distro in sorted(KNOWN_DISTROS):
        for name in _list_names(distro):
            distros_by_name[name] = (*distros_by_name.get(name, ()), distro)
    return distros_by_name


def _list_names(distro: str) -> Iterator[str]:
    return (
        f"{package}/{kind}/{name}"
        for package, kinds in _load_names(distro).items()
        for kind in ("msg", "srv", "action")
        for name in kinds.get(kind, ())
    )


@cache
def _load_names(distro: str) -> dict[str, dict[str, Any]]:
    names_by_package: dict[str, dict[str, Any]] = json.loads(
        (_DATA_FOLDER / f"{distro}.names.json").read_text(encoding="utf-8")
    )
    return names_by_package


# Cached, and shared with callers that only look names up: LazyInterfaces asks for every single message.
@cache
def _load_fields(distro: str) -> dict[str, list[str]]:
    file = _DATA_FOLDER / f"{_SAME_FIELDS_AS.get(distro, distro)}.fields.json"
    fields_by_interface: dict[str, list[str]] = json.loads(file.read_text(encoding="utf-8"))
    return fields_by_interface


def _parse_field(text: str) -> InterfaceField:
    """Parse a field as the data files hold it: `float64[36] covariance`."""
    type_text, name = text.split(" ")
    base, bracket, size = type_text.partition("[")
    return InterfaceField(name, base, bracket + size)
