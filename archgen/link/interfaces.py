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

from archgen.diagnostic import Diagnostic, Label
from archgen.model.distro import is_ros_1
from archgen.model.interfaces import DISTROS, Field, Interface, Interfaces
from archgen.source import Span
from archgen.suggest import closest
from archgen.syntax.interfaces import NAME, Definition, parse

_DATA = Path(__file__).resolve().parent / "ros_interfaces"
_PATH = re.compile(r"(?:.*/)?([A-Za-z][A-Za-z0-9_]*)/(msg|srv|action)/([A-Za-z][A-Za-z0-9_]*)\.(\w+)\Z", re.ASCII)
_FULL = re.compile(r"[A-Za-z][A-Za-z0-9_]*/(?:msg|srv|action)/[A-Za-z][A-Za-z0-9_]*\Z", re.ASCII)
_ROS2 = re.compile(r"[a-z](?:_?[a-z0-9])*/(?:msg|srv|action)/[A-Z][A-Za-z0-9]*\Z", re.ASCII)
_FIELDS_OF = {"rolling": "lyrical"}  # tools/make_ros_interfaces.py writes no fields for rolling: they are lyrical's


class Definitions(Mapping[str, Interface]):
    """The definitions of interfaces by full name: the project's own, and those that ship, which are read on first use.

    A file of fields is read only when one of its messages is asked for, and then only that message is parsed.
    """

    __slots__ = ("_distros", "_own")

    def __init__(self, distros: tuple[str, ...], own: Mapping[str, Interface]) -> None:
        """Remember the project's own interfaces, and the distributions to search after them, in order."""
        self._distros = distros
        self._own = own

    def __getitem__(self, name: str) -> Interface:
        """Return the definition of `package/msg/Name`; raise KeyError where there is none."""
        if name in self._own:
            return self._own[name]
        for distro in self._distros:
            fields = _fields(distro).get(name)
            if fields is not None:
                return Interface(name, (tuple(_field(text) for text in fields),))
        raise KeyError(name)

    def __iter__(self) -> Iterator[str]:
        """Iterate over all names, the project's own first, each once."""
        return iter(dict.fromkeys([*self._own, *(name for distro in self._distros for name in _fields(distro))]))

    def __len__(self) -> int:
        """Count the definitions."""
        return sum(1 for _ in self)


def load(
    distro: str | None,
    definitions: Sequence[tuple[str, str]] = (),
    inline: Mapping[str, tuple[str, Span]] | None = None,
) -> tuple[Interfaces, tuple[Diagnostic, ...]]:
    """Return the interfaces known for a distribution, and what is wrong with the project's own definitions.

    `definition_files` are pairs of path and text; `inline_definitions` are those of `ros: {definitions: ...}` by full
    name, each with the span of its text.
    """
    if not definitions and not inline:
        return _shipped(distro), ()
    return _own(distro, tuple(definitions), tuple((inline or {}).items()))


@lru_cache(4)
def _own(
    distro: str | None, definitions: tuple[tuple[str, str], ...], inline: tuple[tuple[str, tuple[str, Span]], ...]
) -> tuple[Interfaces, tuple[Diagnostic, ...]]:
    """Lay the project's own definitions over what ships; cached, because most revisions of a project share them."""
    # The arguments are tuples, not a list and a dict, to be hashable for the cache.
    shipped = _shipped(distro)
    ros1 = is_ros_1(distro)
    diagnostics = list[Diagnostic]()
    own = dict[str, Definition]()
    places = dict[str, Span]()
    for name, definition, place in _read(definitions, dict(inline), diagnostics, ros1=ros1):
        # The first definition of a name counts, files before inline ones.
        if name in own:
            label = Label(places[name], "the first one")
            diagnostics.append(Diagnostic(NAME, f"`{name}` is defined twice", place, labels=(label,)))
            continue
        own[name], places[name] = definition, place
        diagnostics += definition.diagnostics
    interfaces = _merge(shipped, {name: definition.interface for name, definition in own.items()})
    # Only after all are merged: a definition may name a message that a later one defines.
    for definition in own.values():
        diagnostics += _unknown_fields(definition, interfaces)
    diagnostics += _circles(own)
    return interfaces, tuple(diagnostics)


def name_of(file: str) -> str | None:
    """Return the full name of the interface in a file `.../package/msg/Name.msg`, None for any other path."""
    match = _PATH.match(file)
    return f"{match[1]}/{match[2]}/{match[3]}" if match and match[2] == match[4] else None


def _read(
    files: Sequence[tuple[str, str]],
    inline: Mapping[str, tuple[str, Span]],
    diagnostics: list[Diagnostic],
    *,
    ros1: bool,
) -> Iterator[tuple[str, Definition, Span]]:
    """Yield name, definition and span of each of the project's definitions; one without a valid name is reported."""
    for file, text in files:
        name, place = name_of(file), Span.of_file(file)
        if name is None:
            help_ = "a definition's path ends in its package, its kind and its name: `ramcip_msgs/msg/Grasp.msg`"
            diagnostics.append(Diagnostic(NAME, f"`{file}` does not say which interface it defines", place, help=help_))
        elif _nameable(name, place, diagnostics, ros1=ros1):
            yield name, parse(text, name, file, ros1=ros1), place
    for name, (text, place) in inline.items():
        if not _FULL.match(name):
            help_ = "it is written `package/msg/Name` (or srv, action)"
            diagnostics.append(Diagnostic(NAME, f"`{name}` is no name of an interface", place, help=help_))
        elif _nameable(name, place, diagnostics, ros1=ros1):
            yield name, _moved(parse(text, name, place.file, ros1=ros1), place), place


def _nameable(name: str, place: Span, diagnostics: list[Diagnostic], *, ros1: bool) -> bool:
    if ros1 or _ROS2.match(name):
        return True
    help_ = "packages are written `like_this`, interfaces `LikeThis`, without underscores"
    diagnostics.append(Diagnostic(NAME, f"`{name}` is no name of an interface in ROS 2", place, help=help_))
    return False


def _moved(definition: Definition, place: Span) -> Definition:
    """Move the spans of a definition inside YAML to where its text begins; the line goes into the message.

    A block's indentation and escapes in quotes make exact columns unknowable here.
    """
    moved = (
        replace(d, span=place, message=f"line {d.span.line} of the definition: {d.message}", labels=())
        for d in definition.diagnostics
    )
    references = ((name, place) for name, _ in definition.references)
    return Definition(definition.interface, tuple(references), tuple(moved))


def _unknown_fields(definition: Definition, interfaces: Interfaces) -> Iterator[Diagnostic]:
    """Report fields whose message certainly does not exist (an error), or looks like a misspelt one (a note)."""
    for message, place in definition.references:
        answer = interfaces.answer(message)
        if answer == "known":
            continue
        guess = interfaces.nearest(message)
        help_ = f"did you mean `{_inside(guess)}`?" if guess and "/msg/" in guess else None
        if answer == "wrong":
            yield Diagnostic(NAME, f"there is no message `{message}`", place, help=help_)
        # The package is unknown or known only in part, so the message may well exist. A note is worth it only if a
        # package of nearly the same name has it: `geometry_msg/Pose` is most likely a slip.
        elif guess and help_ and interfaces.held and closest(message.split("/")[0], [guess.split("/")[0]]):
            yield Diagnostic("unchecked-message", f"archgen holds no message `{message}`", place, help=help_)


def _circles(own: Mapping[str, Definition]) -> Iterator[Diagnostic]:
    """Report fields through which a message of the project contains itself: ROS refuses such messages."""
    for name, definition in own.items():
        for message, place in definition.references:
            if name in _inner(message, own):
                through = "" if message == name else f", through `{message}`"
                yield Diagnostic(NAME, f"`{name}` holds itself{through}", place, help="name it by an id or an index")


def _inner(name: str, own: Mapping[str, Definition]) -> set[str]:
    """Return a message and all messages of the project that it contains, directly or not."""
    found, waiting = set[str](), [name]
    while waiting:
        message = waiting.pop()
        if message not in found and message in own:
            found.add(message)
            waiting += (inner for inner, _ in own[message].references)
    return found


def _inside(message: str) -> str:
    """Return a full name as definitions write it, without `msg`."""
    return message.replace("/msg/", "/")


def _merge(shipped: Interfaces, own: Mapping[str, Interface]) -> Interfaces:
    """Lay the project's definitions over what ships.

    A package that the project defines counts as known in full, so any other name in it is wrong; unless archgen already
    knows a part of a package of that name: then the project adds to it, and other names in it may or may not exist.
    """
    packages = frozenset(name.split("/", 1)[0] for name in own)
    known = shipped.packages()
    return replace(
        shipped,
        names=shipped.names | frozenset(own),
        whole=shipped.whole | (packages - known),
        definitions=Definitions(_asked(shipped.distro), own),
        project_packages=packages,
    )


def _asked(distro: str | None) -> tuple[str, ...]:
    """Return the distributions whose data answer for a project's distribution: all for None, none if unknown."""
    return DISTROS if distro is None else (distro,) if distro in DISTROS else ()


@cache
def _shipped(distro: str | None) -> Interfaces:
    """Return the interfaces that ship for a distribution; for None, those of all distributions."""
    names, whole = set[str](), set[str]()
    for asked in _asked(distro):
        for package, kinds in _names(asked).items():
            for kind in ("msg", "srv", "action"):
                names.update(f"{package}/{kind}/{name}" for name in kinds.get(kind, ()))
            # Without a distribution nothing is "whole": a name that one lacks may exist in another.
            if kinds["whole"] and distro is not None:
                whole.add(package)
    return Interfaces(
        distro, frozenset(names), frozenset(whole), Definitions(_asked(distro), {}), held=bool(_asked(distro))
    )


def _names(distro: str) -> dict[str, dict[str, Any]]:
    found: dict[str, dict[str, Any]] = json.loads((_DATA / f"{distro}.names.json").read_text(encoding="utf-8"))
    return found


# Cached, and shared with callers that only look names up: LazyInterfaces asks for every single message.
@cache
def _fields(distro: str) -> dict[str, list[str]]:
    file = _DATA / f"{_FIELDS_OF.get(distro, distro)}.fields.json"
    found: dict[str, list[str]] = json.loads(file.read_text(encoding="utf-8"))
    return found


def _field(text: str) -> Field:
    """Parse a field as the data files hold it: `float64[36] covariance`."""
    type_, name = text.split(" ")
    base, bracket, size = type_.partition("[")
    return Field(name, base, bracket + size)
