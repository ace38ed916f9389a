"""What the walk through a program knows of values: texts, parameters, objects, and what it cannot know, with the place of that."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from typing import Any

from archgen.plugin.importing import Span
from archgen.plugins.ros.sources.source_code import Function, SourceClass

Value = Any
"""A plain value of Python, a SourceClass, a SourceFile for a module, or one of the classes below."""


@dataclass(slots=True, eq=False)
class UnknownText:
    """What only running the program would tell."""

    text: str
    span: Span
    foreign_type: str = ""
    """The dotted type of an object of C++ whose class lies elsewhere."""


MAX_TEXT = 2000
"""How long a text may become, and what else is put together of parts: `measure_value`."""
_UNKNOWN_SIZE = 64
_LEVEL_SIZE = 100
_MAX_WAYS = 16


@dataclass(slots=True, eq=False)
class _Parts:
    """Several values. Their size is that of all parts together, and something for the level: so there are few of them, too."""

    parts: tuple[Value, ...]
    size: int = field(init=False)

    def __post_init__(self) -> None:
        self.size = _LEVEL_SIZE + sum(map(measure_value, self.parts))


class Alternatives(_Parts):
    """One of several values, by a condition that is not known."""


@dataclass(slots=True, eq=False)
class ParameterValue:
    """The value of a parameter. `value` is what counts: what was given to the node, else the default of the program."""

    name: str
    value: Value
    default: Value = None


class JoinedText(_Parts):
    """A text of several parts of which not all are texts of the program itself."""


@dataclass(slots=True, eq=False)
class ExternalName:
    """Something of another package, by its name with dots: `rclpy.node.Node`."""

    name: str


@dataclass(slots=True, eq=False)
class FoundEndpoint:
    """The use of one name by a node."""

    use: str
    flow: str
    name: Value
    message: str
    span: Span
    qos: Mapping[str, Any] = field(default_factory=dict)
    is_conditional: bool = False
    """Whether it is made only under a condition that is not known."""


@dataclass(slots=True, eq=False)
class FoundNode:
    """A node that a program makes. `periods` are those of its timers in seconds, None where one is computed."""

    span: Span
    name: Value = None
    namespace: Value = None
    endpoints: list[FoundEndpoint] = field(default_factory=list)
    endpoints_by_name: dict[tuple[object, ...], FoundEndpoint] = field(default_factory=dict)
    """The same, by what makes two uses of a name one."""
    defaults: dict[str, Value] = field(default_factory=dict)
    """The parameters that it declares."""
    periods: list[float | None] = field(default_factory=list)
    is_lifecycle: bool = False


@dataclass(slots=True, eq=False)
class NodeHandle:
    """What a program speaks through in place of its node: a node handle of roscpp, an image transport, a waiting subscriber."""

    node: FoundNode
    prefix: Value = ""
    kind: str = ""
    message: str = ""


@dataclass(slots=True, eq=False)
class WalkedObject:
    """An object of a class of the workspace. `node` is the node that it is (`is_node`), or that it was given."""

    made_of: SourceClass
    fields: dict[str, Value] = field(default_factory=dict)
    node: FoundNode | None = None
    is_node: bool = False
    type_values: dict[str, str] = field(default_factory=dict)
    """What the parameters of its template stand for."""


@dataclass(slots=True, eq=False)
class BoundFunction:
    """A function, with the object whose method it is and the names around it."""

    function: Function
    self_object: WalkedObject | None = None
    around: Value = None


@dataclass(slots=True, eq=False)
class TextStream:
    """A stream of C++ into which texts are written."""

    parts: list[Value] = field(default_factory=list)


def settle(value: Value) -> Value:
    """Return what counts of a value: of a parameter what it is set to, of joined parts the text if all are known."""
    while isinstance(value, ParameterValue):
        value = value.value
    if isinstance(value, JoinedText):
        parts = [settle(part) for part in value.parts]
        return "".join(map(str, parts)) if all(isinstance(part, str | int) for part in parts) else value
    return value


def measure_value(value: Value) -> int:
    """Return how long a text is, or about how much there is to walk through in a value."""
    while isinstance(value, ParameterValue):
        value = value.value
    return len(value) if isinstance(value, str) else value.size if isinstance(value, _Parts) else _UNKNOWN_SIZE


def join_texts(parts: Iterable[Value]) -> Value:
    """Return a text of parts, as parts where some are no texts of the program itself; NotImplemented for a very long one."""
    flat: list[Value] = []
    for part in parts:
        flat += part.parts if isinstance(part, JoinedText) else [part]
    if all(isinstance(part, str | int | float) for part in flat):
        texts = [*map(str, flat)]
        return "".join(texts) if sum(map(len, texts)) <= MAX_TEXT else NotImplemented
    joined = JoinedText(tuple(flat))
    return joined if joined.size <= MAX_TEXT else NotImplemented


def join_ways(first: Value, second: Value) -> Alternatives:
    """Return one of two values, each of which may be one of several; the first ones of very many."""
    ways = [way for each in (first, second) for way in (each.parts if isinstance(each, Alternatives) else (each,))]
    return Alternatives(tuple({id(way): way for way in ways}.values())[:_MAX_WAYS])


def show_value(value: Value) -> str:
    """Return what is known of a text, with `*` for the rest."""
    settled = settle(value)
    if isinstance(settled, JoinedText):
        return "".join(map(show_value, settled.parts))
    return str(settled) if isinstance(settled, str | int | float) else "*"


def find_unknown(value: Value) -> str:
    """Return the expression that is not known in a value."""
    name = ""
    while isinstance(value, ParameterValue):
        name, value = f"the parameter {value.name}", value.value
    if name:
        return find_unknown(value) or name
    if isinstance(value, JoinedText):
        return next(filter(None, map(find_unknown, value.parts)), "")
    if isinstance(value, Alternatives):
        return "one of " + ", ".join(map(show_value, value.parts))
    return value.text if isinstance(value, UnknownText) else value.name if isinstance(value, ExternalName) else ""


def find_unknown_place(value: Value) -> Span | None:
    """Return where the expression stands that is not known in a value."""
    while isinstance(value, ParameterValue):
        value = value.value
    if isinstance(value, _Parts):
        return next(filter(None, map(find_unknown_place, value.parts)), None)
    return value.span if isinstance(value, UnknownText) and value.span.line else None
