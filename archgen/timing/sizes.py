"""How many bytes a message takes: as written at its type, else computed from its definition where the size is fixed.

ROS 2 puts a header of 4 bytes in front, and a dummy byte into a message without fields (rosidl's
`structure_needs_at_least_one_member`); ROS 1 sends the fields and nothing else.
"""

from __future__ import annotations

import re
from collections.abc import Callable
from functools import cache
from math import ceil
from typing import Literal

from archgen.frozen import dataclass
from archgen.model.architecture import Architecture
from archgen.model.distro import is_ros_1
from archgen.model.interfaces import Field, Interfaces
from archgen.model.node import Endpoint, Flow
from archgen.timing import encoding
from archgen.timing.encoding import Shape

HEADER = 4
"""The encapsulation header of ROS 2, which says in which representation the message follows."""
LARGEST = 2**63 - 1
"""No message is larger; a definition that asks for more has no known size."""
_TIMES = frozenset({"time", "duration", "builtin_interfaces/msg/Time", "builtin_interfaces/msg/Duration"})
"""ROS 1 has these built in: two numbers of 4 bytes."""
_STRING = re.compile(r"(w?)string(?:<=([0-9]+))?\Z")
_ARRAY = re.compile(r"\[(<=)?([0-9]*)\]\Z")
_MADE = re.compile(
    r"(.+/(?:srv|action)/.+?)_"
    r"(Request|Response|Goal|Result|Feedback|FeedbackMessage|(?:SendGoal|GetResult)_(?:Request|Response))\Z"
)
"""The messages that ROS 2 generates from services and actions."""
_PARTS = {"srv": ("Request", "Response"), "action": ("Goal", "Result", "Feedback")}
_GOAL_ID = Field("goal_id", "uint8", "[16]")
_WRAPPED = {
    "SendGoal_Request": (_GOAL_ID, Field("goal", "{}_Goal")),
    "SendGoal_Response": (Field("accepted", "bool"), Field("stamp", "builtin_interfaces/msg/Time")),
    "GetResult_Request": (_GOAL_ID,),
    "GetResult_Response": (Field("status", "int8"), Field("result", "{}_Result")),
    "FeedbackMessage": (_GOAL_ID, Field("feedback", "{}_Feedback")),
}
_DUMMY = (Field("structure_needs_at_least_one_member", "uint8"),)


@dataclass(frozen=True, slots=True)
class MessageSize:
    """A message's bytes on the wire, None where unknown; with `exact` False they are an upper bound.

    `why` says where the figure comes from, or which field leaves it open.
    """

    bytes: int | None
    exact: bool
    why: str
    written: bool = False
    """Whether the project wrote the size at the type, so that nothing was computed."""

    def __str__(self) -> str:
        """Return the size in words, such as `52 B (computed)`; an empty text where it is unknown."""
        if self.bytes is None:
            return ""
        return f"{'' if self.exact else 'at most '}{self.bytes} B{'' if self.written else ' (computed)'}"


Role = Literal["data", "request", "answer"]
"""What passes: a sample of a topic, a client's request, or a server's answer."""
Asked = Callable[[str | None, str | None], MessageSize]
"""Maps a message and the conceptual type that it carries (None where not named) to a size."""


def size(message: str, interfaces: Interfaces) -> MessageSize:
    """Compute the size of `pkg/msg/Name`, or of a message that ROS 2 generates (`pkg/srv/Name_Request`)."""
    return _Computed(interfaces).size(message)


def known(architecture: Architecture) -> Asked:
    """Return the function that finds a message's size and its reason. A `size` written at the type takes precedence.

    Computed sizes are cached in the returned function, so that it may be asked often.
    """
    computed = _Computed(architecture.interfaces)

    def answer(message: str | None, type_: str | None) -> MessageSize:
        mapped = architecture.types.get(type_) if type_ is not None else None
        if mapped is not None and mapped.size is not None:
            return MessageSize(ceil(mapped.size.value), exact=True, why=f"written at the type `{type_}`", written=True)
        if message is None:
            return MessageSize(None, exact=False, why="nobody named the message")
        return computed.size(message)

    return answer


def of(architecture: Architecture) -> Callable[[str | None, str | None], int | None]:
    """Return the function that finds a message's bytes alone: exact, an upper bound, or None."""
    answer = known(architecture)
    return cache(lambda message, type_: answer(message, type_).bytes)


def carried(architecture: Architecture) -> Callable[[Endpoint, Role], int | None]:
    """Return the function that finds how many bytes pass from a writer (publisher or server) in each role.

    An action answers with its result and any number of feedbacks, which has a size only where one is written at its
    type.
    """
    answer = of(architecture)

    def of_writer(writer: Endpoint, role: Role) -> int | None:
        suffix = _SUFFIXES[writer.flow, role]
        message = None if writer.message is None or suffix is None else f"{writer.message}{suffix}"
        return answer(message, writer.type)

    return of_writer


def of_topics(architecture: Architecture) -> dict[str, int | None]:
    """Return the bytes of a sample on each topic: the largest of its writers', None where one is unknown."""
    of_writer = carried(architecture)
    found: dict[str, int | None] = {}
    for name, topic in architecture.topics.items():
        if topic.flow == "topic":
            all_sizes = [of_writer(writer, "data") for writer in topic.writers]
            known_sizes = [one for one in all_sizes if one is not None]
            found[name] = max(known_sizes) if known_sizes and len(known_sizes) == len(all_sizes) else None
    return found


_SUFFIXES: dict[tuple[Flow, Role], str | None] = {
    ("topic", "data"): "",
    ("service", "request"): "_Request",
    ("service", "answer"): "_Response",
    ("action", "request"): "_SendGoal_Request",
    ("action", "answer"): None,
}
"""How ROS 2 names the message of each role; None where there is no single one."""


class _Computed:
    """Computes sizes bottom-up from definitions, each message once."""

    def __init__(self, interfaces: Interfaces) -> None:
        """Take the definitions."""
        self._interfaces = interfaces
        self._ros1 = is_ros_1(interfaces.distro)
        self._shapes: dict[str, Shape] = {}

    def size(self, message: str) -> MessageSize:
        """Return the size of one message, header included."""
        shape = self._shape(message)
        if shape.room is None:
            return MessageSize(None, exact=False, why=shape.why)
        taken = shape.room[0] + (0 if self._ros1 else HEADER)
        why = "computed from its definition"
        return MessageSize(taken, shape.exact, why if shape.exact else f"{why}, which bounds {shape.why}")

    def _shape(self, message: str) -> Shape:
        """Return a message's shape, after those of all messages that it holds."""
        # An explicit stack: recursion would end at Python's limit; `open_names` finds those that hold themselves.
        inside: set[str] = set()
        waiting = [message]
        while waiting:
            name = waiting[-1]
            if name in self._shapes:
                inside.discard(waiting.pop())
                continue
            inside.add(name)
            held = dict.fromkeys(f.type for f in self._fields(name) or () if not self._builtin(f.type))
            missing = [one for one in held if one not in self._shapes]
            if inside.intersection(missing):
                self._shapes[name] = Shape(None, why=f"`{name}` holds itself")
            elif missing:
                waiting += missing
            else:
                self._shapes[name] = self._struct(name)
        return self._shapes[message]

    def _builtin(self, type_: str) -> bool:
        """Whether a field's type needs no definition."""
        return "/" not in type_ or (self._ros1 and type_ in _TIMES)

    def _fields(self, name: str) -> tuple[Field, ...] | None:
        """Return the fields on the wire, None where the definition is not known."""
        made = _MADE.match(name)
        base, part = (made[1], made[2]) if made else (name, "")
        found = self._interfaces.definitions.get(base)
        if found is None:
            return None
        parts = _PARTS.get(base.split("/")[1], ("",))
        if part in parts:
            return found.parts[parts.index(part)] or (() if self._ros1 else _DUMMY)
        # What remains are the wrappers that ROS 2 puts around an action's goal, result and feedback (with the goal's
        # id).
        if part not in _WRAPPED or len(parts) != len(_PARTS["action"]):
            return None
        return tuple(Field(f.name, f.type.format(base), f.array) for f in _WRAPPED[part])

    def _struct(self, name: str) -> Shape:
        """Return the shape of a message from those of its fields."""
        fields = self._fields(name)
        if fields is None:
            return Shape(None, why=_not_held(name))
        shapes = [self._field(field) for field in fields]
        rooms = [shape.room for shape in shapes if shape.room is not None]
        if len(rooms) < len(shapes):
            return next(shape for shape in shapes if shape.room is None)
        room = encoding.row(rooms)
        if room[0] > LARGEST:
            return Shape(None, why=f"`{name}` would be larger than any message can be")
        bounded = next((shape.why for shape in shapes if not shape.exact), "")
        return Shape(room, not bounded, bounded)

    def _field(self, field: Field) -> Shape:
        """Return the shape of a field, its brackets included."""
        one = self._element(field)
        array = _ARRAY.match(field.array)
        if array is None or one.room is None:
            return one
        if not array[2]:
            return Shape(None, why=f"the field `{field.name}` may have any length (`{field.type}[]`)")
        # `[<=n]` is a bounded sequence, its length written in front; `[n]` an array of fixed length.
        if array[1]:
            return Shape(encoding.sequence(one.room, int(array[2])), exact=False, why=f"the field `{field.name}`")
        return Shape(encoding.array(one.room, int(array[2])), one.exact, one.why)

    def _element(self, field: Field) -> Shape:
        """Return the shape of a field without its brackets."""
        if self._ros1 and field.type in _TIMES:
            return Shape(encoding.number(8, aligned=False))
        if field.type in encoding.WIDTHS:
            return Shape(encoding.number(encoding.WIDTHS[field.type], aligned=not self._ros1))
        text = _STRING.match(field.type)
        if text and text[2]:
            room = encoding.text(int(text[2]), wide=bool(text[1]))
            return Shape(room, exact=False, why=f"the field `{field.name}`")
        if text:
            return Shape(None, why=f"the field `{field.name}` may have any length (`{field.type}`)")
        inner = self._shapes.get(field.type, Shape(None, why=f"nobody knows the type `{field.type}`"))
        # What leaves `stamp` open inside `header` is reported as `header.stamp`.
        return Shape(inner.room, inner.exact, inner.why.replace("the field `", f"the field `{field.name}.", 1))


def _not_held(name: str) -> str:
    """Say why a message has no fields: it is a whole service or action, or its definition is unknown."""
    several = name.split("/")[1] in _PARTS and not _MADE.match(name)
    return f"`{name}` is several messages" if several else f"the fields of `{name}` are not known"
