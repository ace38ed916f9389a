"""Conceptual types, the ROS messages they are mapped to or their fields make, and the names of messages."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from typing import Literal

from archgen.diagnostics import NO_SPAN, Span
from archgen.frozen import dataclass, field
from archgen.model.element_annotations import NO_ANNOTATIONS, ElementAnnotations
from archgen.model.promise import Deprecation
from archgen.model.quantity import Quantity

_FULL_NAME = re.compile(r"([a-zA-Z][a-zA-Z0-9_]*)/(msg|srv|action)/([A-Z][A-Za-z0-9_]*)\Z", re.ASCII)
_SHORT_NAME = re.compile(r"([a-z][a-z0-9_]*)/([A-Z][A-Za-z0-9_]*)\Z", re.ASCII)
_BRACKETS = re.compile(r"(?<!\])(?:\[[^\[\]]*+\])++\Z")

PART_KEYS = ("request", "response", "feedback")
"""The keys of a service's or action's type that name a type or hold fields, in the order of a definition."""


@dataclass(frozen=True, slots=True)
class DataField:
    """A field of a type. `type` is as written: `Pose[]`, `float64[36]`; `default` too, each item of a list."""

    name: str
    type: str | None
    default: str | tuple[str, ...] | None = None
    unit: str | None = None
    comment: str | None = None
    at: Span = field(default=NO_SPAN, compare=False, repr=False)
    type_at: Span = field(default=NO_SPAN, compare=False, repr=False)
    default_at: Span = field(default=NO_SPAN, compare=False, repr=False)

    @property
    def element_type(self) -> str:
        """The type without the brackets of an array; empty while it is not known."""
        return (self.type or "").removesuffix(self.array).rstrip()

    @property
    def array(self) -> str:
        """The brackets of an array as written; empty for a single value."""
        brackets = _BRACKETS.search(self.type or "")
        return brackets[0] if brackets else ""

    @property
    def meaning(self) -> str:
        """What is said of the field on one line, its unit in front, as comments in definitions say it."""
        unit = f"[{self.unit}]" if self.unit else ""
        return " ".join(f"{unit} {self.comment or ''}".split())


@dataclass(frozen=True, slots=True)
class DataConstant:
    """A constant of a type; the value is as ROS writes it."""

    name: str
    type: str
    value: str
    comment: str | None = None


@dataclass(frozen=True, slots=True)
class ConceptualType:
    """A conceptual type. `message` is the ROS message it is mapped to (`pkg/msg/Name`), if any; `size` in B.

    A type with `fields` (None: none are written), `constants`, `values` or `part_fields` (the fields of `request`,
    `response` and `feedback`) defines its message. A type with `generic` stands for many: `Envelope<Pose>` is another
    type.
    """

    name: str
    message: str | None = None
    comment: str | None = None
    size: Quantity | None = None
    status: Literal["existing", "planned"] | None = None
    request: str | None = None
    response: str | None = None
    feedback: str | None = None
    fields: tuple[DataField, ...] | None = None
    constants: tuple[DataConstant, ...] = ()
    values: tuple[str, ...] = ()
    part_fields: Mapping[str, tuple[DataField, ...]] = field(default_factory=dict)
    generic: tuple[str, ...] = ()
    frame: str | None = None
    """The coordinate frame in which such data is given, as written."""
    version: str | None = None
    deprecated: Deprecation | None = None
    origin: Literal["project", "shipped", "message"] = "project"
    """What maps it: the project, the type mapper that ships with archgen, or its own name, which is a message."""
    library: str | None = None
    """The library that it comes from, None where the project declares it, or nobody."""
    annotations: ElementAnnotations = NO_ANNOTATIONS
    at: Span = field(default=NO_SPAN, compare=False, repr=False)
    message_at: Span = field(default=NO_SPAN, compare=False, repr=False)
    frame_at: Span = field(default=NO_SPAN, compare=False, repr=False)

    @property
    def has_content(self) -> bool:
        """Whether it says itself what is in its message."""
        return self.fields is not None or bool(self.constants or self.values or self.part_fields)

    def list_fields(self) -> Iterator[tuple[str, DataField]]:
        """Yield all written fields, each with its part: `request`, ..., or an empty text."""
        yield from (("", each) for each in self.fields or ())
        for part, fields in self.part_fields.items():
            yield from ((part, each) for each in fields)


def full_message_name(text: str) -> str | None:
    """Return a message's full name (`sensor_msgs/msg/Image` for `sensor_msgs/Image`); None if the text is none."""
    if _FULL_NAME.match(text):
        return text
    short = _SHORT_NAME.match(text)
    return f"{short[1]}/msg/{short[2]}" if short else None


def flow_of(message: str | None) -> Literal["topic", "service", "action"]:
    """Return the kind of flow of a full message name, by its middle part; an unknown message (None) is a topic."""
    middle = message.split("/")[1] if message else "msg"
    return {"srv": "service", "action": "action"}.get(middle, "topic")  # type: ignore[return-value]
