"""The type mapper: conceptual types and the ROS messages that carry them."""

from __future__ import annotations

import re
from dataclasses import field
from typing import Literal

from archgen.frozen import dataclass
from archgen.model.quantity import Quantity
from archgen.source import NOWHERE, Span

_FULL = re.compile(r"([a-zA-Z][a-zA-Z0-9_]*)/(msg|srv|action)/([A-Z][A-Za-z0-9_]*)\Z", re.ASCII)
_SHORT = re.compile(r"([a-z][a-z0-9_]*)/([A-Z][A-Za-z0-9_]*)\Z", re.ASCII)


@dataclass(frozen=True, slots=True)
class Type:
    """A conceptual type and its message (`pkg/msg/Name`), None while nobody mapped it."""

    name: str
    message: str | None = None
    comment: str | None = None
    size: Quantity | None = None
    status: Literal["existing", "planned"] | None = None
    request: str | None = None
    response: str | None = None
    feedback: str | None = None
    origin: Literal["project", "shipped", "message"] = "project"
    """Who maps it: the project, archgen's type mapper, or the name itself, being a message."""
    at: Span = field(default=NOWHERE, compare=False, repr=False)
    message_at: Span = field(default=NOWHERE, compare=False, repr=False)


def full_message(text: str) -> str | None:
    """Give a message's full name (`sensor_msgs/Image` is `sensor_msgs/msg/Image`), None where the text is none."""
    if _FULL.match(text):
        return text
    short = _SHORT.match(text)
    return f"{short[1]}/msg/{short[2]}" if short else None


def flow_of(message: str | None) -> Literal["topic", "service", "action"]:
    """Say what flows for a full message name: its middle part decides; an unknown message counts as a topic."""
    middle = message.split("/")[1] if message else "msg"
    return {"srv": "service", "action": "action"}.get(middle, "topic")  # type: ignore[return-value]
