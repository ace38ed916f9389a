"""What a pattern is made of, what a view of an architecture holds, and what a match binds: plain data.

A view holds mappings, lists and texts. All scalars are texts, as they are written; nothing is None.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from typing import Self

from archgen.diagnostics import Span
from archgen.frozen import NamedTuple
from archgen.syntax.yaml_tree import PlainValue, ScalarNode

TYPE_KEYS = frozenset({"type", "is", "same_as", "message"})
"""Keys whose values name types: a mapping of one key there is a generic type, `{Envelope: $t}`."""
INNER_KEY = "components"
"""What stands inside of a component is in a copy of all that it has; rules find it by paths of its own."""
ViewValue = str | list["ViewValue"] | dict[str, "ViewValue"] | None
Bindings = Mapping[str, ViewValue]
"""What the variables of a rule stand for, by name without `$`."""


class ScalarText(str):
    """A scalar as it is written, with what YAML makes of it and its place, so that a copy of it stays what it is."""

    __slots__ = ("span", "value")
    value: PlainValue
    span: Span | None

    def __new__(cls, text: str, value: PlainValue, span: Span | None = None) -> Self:
        """Make a text that remembers its value."""
        scalar = super().__new__(cls, text)
        scalar.value = value
        scalar.span = span
        return scalar


class PortReference(str):
    """What a port takes its data from: the path of a component, and the name of a port where it names one.

    `holder` is the composed component whose input it is, where it is written as `self.x`. `written` are the words that
    stand in the tree.
    """

    __slots__ = ("component", "holder", "port", "span", "written")
    component: str
    port: str | None
    holder: str | None
    span: Span | None
    written: str

    def __new__(
        cls, component: str, port: str | None, *, holder: str | None = None, at: ScalarNode | None = None
    ) -> Self:
        """Make a reference. With a holder it reads `self.port`."""
        whole = f"self.{port}" if holder is not None else component if port is None else f"{component}.{port}"
        reference = super().__new__(cls, whole)
        reference.component = component
        reference.port = port
        reference.holder = holder
        reference.span = at.span if at else None
        reference.written = at.text if at else whole
        return reference


class ComponentBody(dict[str, "ViewValue"]):
    """All that a component has. `path` is the component that it is read from."""

    __slots__ = ("path",)
    path: str


class Anything(NamedTuple):
    """`$_` or nothing at all: whatever stands there."""

    is_named: bool = False
    """Whether `$_` is written."""


class Variable(NamedTuple):
    """`$x`: bound by its first place, and the same in all others."""

    name: str


class Constant(NamedTuple):
    """A text that stands there as it is."""

    text: ScalarText


class TextPattern(NamedTuple):
    """A text with variables in it: `${name}_state`, `$source.$port`."""

    parts: tuple[Variable | str, ...]
    is_path: bool
    """Whether it is ids and variables with dots between them: all but the first stand for one id each."""


class ListPattern(NamedTuple):
    """A list in which each of these is found, each at a place of its own."""

    items: tuple[Pattern, ...]


class PatternEntry(NamedTuple):
    """One key of a mapping pattern."""

    key: Pattern
    value: Pattern
    span: Span


class MappingPattern(NamedTuple):
    """A mapping that has these keys, whatever else it has; against a text, a generic type: `{Envelope: $t}`."""

    entries: tuple[PatternEntry, ...]


Pattern = Anything | Variable | Constant | TextPattern | ListPattern | MappingPattern

_VARIABLE = re.compile(r"\$\{([A-Za-z_][A-Za-z0-9_]*)\}|\$([A-Za-z_][A-Za-z0-9_]*)")
_PATH_SEPARATOR = re.compile(r"\.")
ANY_NAME = "_"
"""The variable that stands for anything and is never bound."""


def parse_text_pattern(text: str, value: PlainValue, span: Span | None) -> Pattern:
    """Return what a scalar in a pattern means. `$$x` is the text `$x`."""
    if "$" not in text:
        return Constant(ScalarText(text, value, span))
    parts: list[Variable | str] = []
    start = 0
    for match in _VARIABLE.finditer(text):
        if match.start() > 0 and text[match.start() - 1] == "$":
            parts.append(text[start : match.start() - 1] + match[0])
        else:
            parts += [text[start : match.start()], Variable(match[1] or match[2])]
        start = match.end()
    parts.append(text[start:])
    joined = _join_texts(parts)
    if len(joined) == 1:
        only = joined[0]
        if isinstance(only, Variable):
            return Anything(is_named=True) if only.name == ANY_NAME else only
        return Constant(ScalarText(only, only if only != text else value, span))
    return TextPattern(joined, _is_path(joined))


def _join_texts(parts: Sequence[Variable | str]) -> tuple[Variable | str, ...]:
    joined: list[Variable | str] = []
    for part in parts:
        if isinstance(part, str) and joined and isinstance(joined[-1], str):
            joined[-1] += part
        elif part != "":
            joined.append(part)
    return tuple(joined) or ("",)


def _is_path(parts: tuple[Variable | str, ...]) -> bool:
    """Whether each variable stands for whole ids between dots."""
    return all(
        isinstance(part, str)
        or (
            (index == 0 or str(parts[index - 1]).endswith("."))
            and (index == len(parts) - 1 or str(parts[index + 1]).startswith("."))
        )
        for index, part in enumerate(parts)
    )


def list_variables(pattern: Pattern) -> Iterator[str]:
    """Yield the names of the variables in a pattern, without `$_`, as often as they stand there."""
    if isinstance(pattern, Variable):
        yield pattern.name
    elif isinstance(pattern, TextPattern):
        yield from (part.name for part in pattern.parts if isinstance(part, Variable) and part.name != ANY_NAME)
    elif isinstance(pattern, ListPattern):
        for item in pattern.items:
            yield from list_variables(item)
    elif isinstance(pattern, MappingPattern):
        for entry in pattern.entries:
            yield from list_variables(entry.key)
            yield from list_variables(entry.value)
