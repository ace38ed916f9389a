"""Conceptual types, the ROS messages they are mapped to, and the names of messages."""

from __future__ import annotations

import re
from dataclasses import field
from typing import Literal

from archgen.diagnostics.source_span import NO_SPAN, Span
from archgen.frozen import dataclass
from archgen.model.quantity import Quantity

_FULL_NAME = re.compile(r"([a-zA-Z][a-zA-Z0-9_]*)/(msg|srv|action)/([A-Z][A-Za-z0-9_]*)\Z", re.ASCII)
_SHORT_NAME = re.compile(r"([a-z][a-z0-9_]*)/([A-Z][A-Za-z0-9_]*)\Z", re.ASCII)


@dataclass(frozen=True, slots=True)
class ConceptualType:
    """A conceptual type. `message` is the ROS message it is mapped to (`pkg/msg/Name`), if any; `size` in B."""

    name: str
    message: str | None = None
    comment: str | None = None
    size: Quantity | None = None
    status: Literal["existing", "planned"] | None = None
    request: str | None = None
    response: str | None = None
    feedback: str | None = None
    frame: str | None = None
    """The coordinate frame in which such data is given, as written."""
    origin: Literal["project", "shipped", "message"] = "project"
    """What maps it: the project, the type mapper that ships with archgen, or its own name, which is a message."""
    at: Span = field(default=NO_SPAN, compare=False, repr=False)
    message_at: Span = field(default=NO_SPAN, compare=False, repr=False)
    frame_at: Span = field(default=NO_SPAN, compare=False, repr=False)


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
