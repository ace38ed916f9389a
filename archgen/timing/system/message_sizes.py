"""How many bytes a message takes: as written at its type, else computed from its definition where the size is fixed.

ROS 2 puts a header of 4 bytes in front, and a dummy byte into a message without fields (rosidl's
`structure_needs_at_least_one_member`); ROS 1 sends the fields and nothing else.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable
from functools import cache, reduce
from math import ceil
from typing import Literal

from archgen.frozen import dataclass
from archgen.model.architecture import Architecture
from archgen.model.known_interfaces import InterfaceField, Interfaces
from archgen.model.node import Endpoint, FlowKind
from archgen.model.ros_distro import is_ros_1

_ALIGNMENT = 8
_LENGTH_PREFIX_BYTES = 4
"""Bytes of the number that precedes a sequence or a text."""
WireRoom = tuple[int, ...]
"""The bytes that a value takes, padding before it included, for each offset modulo 8 at which it may begin."""
EMPTY_ROOM: WireRoom = (0,) * _ALIGNMENT
NUMBER_WIDTHS = {
    **dict.fromkeys(("bool", "byte", "char", "octet", "int8", "uint8"), 1),
    **dict.fromkeys(("int16", "uint16"), 2),
    **dict.fromkeys(("int32", "uint32", "float32"), 4),
    **dict.fromkeys(("int64", "uint64", "float64"), 8),
}
"""The bytes of each builtin number."""


@dataclass(frozen=True, slots=True)
class WireShape:
    """The bytes of a value, None where unknown; with `exact` False an upper bound. `why` names the field."""

    room: WireRoom | None
    exact: bool = True
    why: str = ""


def room_of_number(width: int, *, aligned: bool) -> WireRoom:
    """Return the room of a number of some bytes."""
    # -start % width is the padding up to the next multiple of the width.
    return tuple((-start % width if aligned else 0) + width for start in range(_ALIGNMENT))


def room_of_text(length: int, *, wide: bool) -> WireRoom:
    """Return the largest room of a text of bounded length, in ROS 2.

    A wide character takes 4 bytes in the older of the two encodings in use, 2 in the newer.
    """
    # Texts of bytes end with a zero byte, wide ones do not.
    characters = 4 * length if wide else length + 1
    return append_room(room_of_number(_LENGTH_PREFIX_BYTES, aligned=True), (characters,) * _ALIGNMENT)


def room_of_sequence(element: WireRoom, length: int) -> WireRoom:
    """Return the largest room of a sequence of bounded length, in ROS 2."""
    return append_room(room_of_number(_LENGTH_PREFIX_BYTES, aligned=True), room_of_array(element, length))


def room_of_array(element: WireRoom, count: int) -> WireRoom:
    """Return the room of `count` elements in a row, by doubling, since counts may be large."""
    total = EMPTY_ROOM
    # Binary exponentiation: `append_room` is associative, so that the total so far can be doubled for each bit.
    for bit in f"{count:b}":
        total = append_room(total, total)
        if bit == "1":
            total = append_room(total, element)
    return total


def room_of_row(rooms: Iterable[WireRoom]) -> WireRoom:
    """Return the room of values in a row."""
    return reduce(append_room, rooms, EMPTY_ROOM)


def append_room(first: WireRoom, second: WireRoom) -> WireRoom:
    """Return the room of one value behind another."""
    # The second value begins where the first one ends: at its offset plus its bytes.
    return tuple(byte_count + second[(start + byte_count) % _ALIGNMENT] for start, byte_count in enumerate(first))


HEADER_BYTES = 4
"""The encapsulation header of ROS 2, which says in which representation the message follows."""
MAX_MESSAGE_BYTES = 2**63 - 1
"""No message is larger; a definition that asks for more has no known size."""
_ROS1_TIMES = frozenset({"time", "duration", "builtin_interfaces/msg/Time", "builtin_interfaces/msg/Duration"})
"""ROS 1 has these built in: two numbers of 4 bytes."""
_STRING_TYPE = re.compile(r"(w?)string(?:<=([0-9]+))?\Z")
_ARRAY_SUFFIX = re.compile(r"\[(<=)?([0-9]*)\]\Z")
_GENERATED_MESSAGE = re.compile(
    r"(.+/(?:srv|action)/.+?)_"
    r"(Request|Response|Goal|Result|Feedback|FeedbackMessage|(?:SendGoal|GetResult)_(?:Request|Response))\Z"
)
"""The messages that ROS 2 generates from services and actions."""
_DEFINITION_PARTS = {"srv": ("Request", "Response"), "action": ("Goal", "Result", "Feedback")}
_GOAL_ID = InterfaceField("goal_id", "uint8", "[16]")
_ACTION_WRAPPERS = {
    "SendGoal_Request": (_GOAL_ID, InterfaceField("goal", "{}_Goal")),
    "SendGoal_Response": (InterfaceField("accepted", "bool"), InterfaceField("stamp", "builtin_interfaces/msg/Time")),
    "GetResult_Request": (_GOAL_ID,),
    "GetResult_Response": (InterfaceField("status", "int8"), InterfaceField("result", "{}_Result")),
    "FeedbackMessage": (_GOAL_ID, InterfaceField("feedback", "{}_Feedback")),
}
_DUMMY_FIELDS = (InterfaceField("structure_needs_at_least_one_member", "uint8"),)


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


MessageRole = Literal["data", "request", "answer"]
"""What passes: a sample of a topic, a client's request, or a server's answer."""
SizeQuery = Callable[[str | None, str | None], MessageSize]
"""Maps a message and the conceptual type that it carries (None where not named) to a size."""


def make_size_query(architecture: Architecture) -> SizeQuery:
    """Return the function that finds a message's size and its reason. A `size` written at the type takes precedence.

    Computed sizes are cached in the returned function, so that it may be asked often.
    """
    computer = _SizeComputer(architecture.interfaces)

    def answer_size(message: str | None, type_: str | None) -> MessageSize:
        mapped = architecture.types.get(type_) if type_ is not None else None
        if mapped is not None and mapped.size is not None:
            return MessageSize(ceil(mapped.size.value), exact=True, why=f"written at the type `{type_}`", written=True)
        if message is None:
            return MessageSize(None, exact=False, why="nobody named the message")
        return computer.message_size(message)

    return answer_size


def make_byte_query(architecture: Architecture) -> Callable[[str | None, str | None], int | None]:
    """Return the function that finds a message's bytes alone: exact, an upper bound, or None."""
    size_query = make_size_query(architecture)
    return cache(lambda message, type_: size_query(message, type_).bytes)


def make_writer_query(architecture: Architecture) -> Callable[[Endpoint, MessageRole], int | None]:
    """Return the function that finds how many bytes pass from a writer (publisher or server) in each role.

    An action answers with its result and any number of feedbacks, which has a size only where one is written at its
    type.
    """
    byte_query = make_byte_query(architecture)

    def bytes_of_writer(writer: Endpoint, role: MessageRole) -> int | None:
        suffix = _MESSAGE_SUFFIXES[writer.flow, role]
        message = None if writer.message is None or suffix is None else f"{writer.message}{suffix}"
        return byte_query(message, writer.type)

    return bytes_of_writer


def find_topic_sizes(architecture: Architecture) -> dict[str, int | None]:
    """Return the bytes of a sample on each topic: the largest of its writers', None where one is unknown."""
    bytes_of_writer = make_writer_query(architecture)
    topic_sizes: dict[str, int | None] = {}
    for name, topic in architecture.list_carriers():
        if topic.flow == "topic":
            all_sizes = [bytes_of_writer(writer, "data") for writer in topic.writers]
            known_sizes = [byte_count for byte_count in all_sizes if byte_count is not None]
            topic_sizes[name] = max(known_sizes) if known_sizes and len(known_sizes) == len(all_sizes) else None
    return topic_sizes


_MESSAGE_SUFFIXES: dict[tuple[FlowKind, MessageRole], str | None] = {
    ("topic", "data"): "",
    ("service", "request"): "_Request",
    ("service", "answer"): "_Response",
    ("action", "request"): "_SendGoal_Request",
    ("action", "answer"): None,
}
"""How ROS 2 names the message of each role; None where there is no single one."""


class _SizeComputer:
    """Computes sizes bottom-up from definitions, each message once."""

    def __init__(self, interfaces: Interfaces) -> None:
        """Take the definitions."""
        self._interfaces = interfaces
        self._ros1 = is_ros_1(interfaces.distro)
        self._shapes: dict[str, WireShape] = {}

    def message_size(self, message: str) -> MessageSize:
        """Return the size of one message, header included."""
        shape = self._shape_of(message)
        if shape.room is None:
            return MessageSize(None, exact=False, why=shape.why)
        byte_count = shape.room[0] + (0 if self._ros1 else HEADER_BYTES)
        why = "computed from its definition"
        return MessageSize(byte_count, shape.exact, why if shape.exact else f"{why}, which bounds {shape.why}")

    def _shape_of(self, message: str) -> WireShape:
        """Return a message's shape, after those of all messages that it holds."""
        # An explicit stack: recursion would end at Python's limit; `open_names` finds those that hold themselves.
        open_names: set[str] = set()
        pending = [message]
        while pending:
            name = pending[-1]
            if name in self._shapes:
                open_names.discard(pending.pop())
                continue
            open_names.add(name)
            member_types = dict.fromkeys(f.type for f in self._wire_fields(name) or () if not self._is_builtin(f.type))
            missing = [member_type for member_type in member_types if member_type not in self._shapes]
            if open_names.intersection(missing):
                self._shapes[name] = WireShape(None, why=f"`{name}` holds itself")
            elif missing:
                pending += missing
            else:
                self._shapes[name] = self._struct_shape(name)
        return self._shapes[message]

    def _is_builtin(self, type_: str) -> bool:
        """Whether a field's type needs no definition."""
        return "/" not in type_ or (self._ros1 and type_ in _ROS1_TIMES)

    def _wire_fields(self, name: str) -> tuple[InterfaceField, ...] | None:
        """Return the fields on the wire, None where the definition is not known."""
        match = _GENERATED_MESSAGE.match(name)
        base, part_name = (match[1], match[2]) if match else (name, "")
        definition = self._interfaces.definitions.get(base)
        if definition is None:
            return None
        part_names = _DEFINITION_PARTS.get(base.split("/")[1], ("",))
        if part_name in part_names:
            return definition.parts[part_names.index(part_name)] or (() if self._ros1 else _DUMMY_FIELDS)
        # What remains are the wrappers that ROS 2 puts around an action's goal, result and feedback (with the goal's
        # id).
        if part_name not in _ACTION_WRAPPERS or len(part_names) != len(_DEFINITION_PARTS["action"]):
            return None
        return tuple(InterfaceField(f.name, f.type.format(base), f.array) for f in _ACTION_WRAPPERS[part_name])

    def _struct_shape(self, name: str) -> WireShape:
        fields = self._wire_fields(name)
        if fields is None:
            return WireShape(None, why=_missing_definition_text(name))
        shapes = [self._field_shape(field) for field in fields]
        rooms = [shape.room for shape in shapes if shape.room is not None]
        if len(rooms) < len(shapes):
            return next(shape for shape in shapes if shape.room is None)
        room = room_of_row(rooms)
        if room[0] > MAX_MESSAGE_BYTES:
            return WireShape(None, why=f"`{name}` would be larger than any message can be")
        bounding_field = next((shape.why for shape in shapes if not shape.exact), "")
        return WireShape(room, not bounding_field, bounding_field)

    def _field_shape(self, field: InterfaceField) -> WireShape:
        """Return the shape of a field, its brackets included."""
        element_shape = self._element_shape(field)
        array_match = _ARRAY_SUFFIX.match(field.array)
        if array_match is None or element_shape.room is None:
            return element_shape
        if not array_match[2]:
            return WireShape(None, why=f"the field `{field.name}` may have any length (`{field.type}[]`)")
        # `[<=n]` is a bounded sequence, its length written in front; `[n]` an array of fixed length.
        if array_match[1]:
            return WireShape(
                room_of_sequence(element_shape.room, int(array_match[2])),
                exact=False,
                why=f"the field `{field.name}`",
            )
        return WireShape(room_of_array(element_shape.room, int(array_match[2])), element_shape.exact, element_shape.why)

    def _element_shape(self, field: InterfaceField) -> WireShape:
        """Return the shape of a field without its brackets."""
        if self._ros1 and field.type in _ROS1_TIMES:
            return WireShape(room_of_number(8, aligned=False))
        if field.type in NUMBER_WIDTHS:
            return WireShape(room_of_number(NUMBER_WIDTHS[field.type], aligned=not self._ros1))
        string_match = _STRING_TYPE.match(field.type)
        if string_match and string_match[2]:
            room = room_of_text(int(string_match[2]), wide=bool(string_match[1]))
            return WireShape(room, exact=False, why=f"the field `{field.name}`")
        if string_match:
            return WireShape(None, why=f"the field `{field.name}` may have any length (`{field.type}`)")
        inner_shape = self._shapes.get(field.type, WireShape(None, why=f"nobody knows the type `{field.type}`"))
        # What leaves `stamp` open inside `header` is reported as `header.stamp`.
        return WireShape(
            inner_shape.room, inner_shape.exact, inner_shape.why.replace("the field `", f"the field `{field.name}.", 1)
        )


def _missing_definition_text(name: str) -> str:
    """Say why a message has no fields: it is a whole service or action, or its definition is unknown."""
    is_several = name.split("/")[1] in _DEFINITION_PARTS and not _GENERATED_MESSAGE.match(name)
    return f"`{name}` is several messages" if is_several else f"the fields of `{name}` are not known"
