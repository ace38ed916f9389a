"""Message sizes: against an independent serialiser for every message of fixed size, and by hand for what it cannot say."""

from __future__ import annotations

from fractions import Fraction
from typing import Any

import numpy as np
import pytest
from rosbags.interfaces import Nodetype
from rosbags.typesys import Stores, get_typestore

from archgen.diagnostics.source_span import NO_SPAN
from archgen.link import interface_sources
from archgen.model.architecture import Architecture, ProjectInfo
from archgen.model.known_interfaces import Interface, InterfaceField, Interfaces
from archgen.model.message_types import ConceptualType
from archgen.model.node import Endpoint, FlowKind, Topic
from archgen.model.quantity import Quantity
from archgen.timing.system import message_sizes

STORES = [store for store in Stores if store not in {Stores.EMPTY, Stores.LATEST}]
SHIPPED = {
    "noetic": Stores.ROS1_NOETIC,
    "humble": Stores.ROS2_HUMBLE,
    "jazzy": Stores.ROS2_JAZZY,
    "kilted": Stores.ROS2_KILTED,
    "lyrical": Stores.ROS2_LYRICAL,
    "rolling": Stores.ROS2_LYRICAL,
}
FILLER = "structure_needs_at_least_one_member"
Store = Any


def spell(node: tuple[Nodetype, Any]) -> tuple[str, str]:
    """Write a type of the serialiser as type and array."""
    kind, details = node
    if kind == Nodetype.BASE:
        return (f"{details[0]}<={details[1]}" if details[1] else details[0]), ""
    if kind == Nodetype.NAME:
        return details, ""
    bound = str(details[1]) if kind == Nodetype.ARRAY else f"<={details[1]}" if details[1] else ""
    return spell(details[0])[0], f"[{bound}]"


def known(store: Store, distro: str) -> Interfaces:
    """Give everything that the serialiser knows, as definitions."""
    found = {
        name: Interface(name, (tuple(InterfaceField(f, *spell(node)) for f, node in fields if f != FILLER),))
        for name, (_, fields) in store.fielddefs.items()
    }
    return Interfaces(distro, definitions=found)


def fixed(store: Store, name: str) -> bool:
    """Say whether a message has neither text nor sequence in it, however deep."""

    def of(node: tuple[Nodetype, Any]) -> bool:
        kind, details = node
        if kind == Nodetype.BASE:
            return details[0] not in {"string", "wstring"}
        if kind == Nodetype.NAME:
            return fixed(store, details)
        return kind == Nodetype.ARRAY and of(details[0])

    return all(of(node) for _, node in store.fielddefs[name][1])


def zero(store: Store, node: tuple[Nodetype, Any]) -> object:
    """Make a value to send."""
    kind, details = node
    if kind == Nodetype.NAME:
        return message(store, details)
    if kind == Nodetype.ARRAY:
        element, count = details
        if element[0] == Nodetype.NAME:
            return [message(store, element[1]) for _ in range(count)]
        return np.zeros(count, {"byte": "uint8", "char": "uint8", "octet": "uint8"}.get(element[1][0], element[1][0]))
    return {"bool": False, "float32": 0.0, "float64": 0.0}.get(details[0], 0)


def message(store: Store, name: str) -> object:
    return store.types[name](*[zero(store, node) for _, node in store.fielddefs[name][1]])


def sent(store: Store, name: str, *, ros1: bool) -> int:
    """Count the bytes that the serialiser makes."""
    return len((store.serialize_ros1 if ros1 else store.serialize_cdr)(message(store, name), name))


def size_of(name: str, held: Interfaces) -> message_sizes.MessageSize:
    return message_sizes.make_size_query(Architecture(ProjectInfo("robot", "Robot"), interfaces=held))(name, None)


def compare(held: Interfaces, store: Store, *, ros1: bool) -> tuple[dict[str, int | None], dict[str, int]]:
    names = [name for name in store.fielddefs if fixed(store, name)]
    ours = {name: size_of(name, held).bytes for name in names}
    return ours, {name: sent(store, name, ros1=ros1) for name in names}


@pytest.mark.parametrize("which", STORES)
def test_every_message_of_fixed_size_is_as_large_as_the_serialiser_makes_it(which: Stores) -> None:
    store, distro = get_typestore(which), which.value.partition("_")[2]
    ours, theirs = compare(known(store, distro), store, ros1=distro == "noetic")
    assert ours == theirs
    assert len(ours) > 40


@pytest.mark.parametrize("distro", SHIPPED)
def test_the_definitions_that_ship_give_the_same(distro: str) -> None:
    store, (held, _) = get_typestore(SHIPPED[distro]), interface_sources.load_interfaces(distro)
    ours, theirs = compare(held, store, ros1=distro == "noetic")
    if distro == "noetic":  # built in there, and no messages
        for name in ("builtin_interfaces/msg/Time", "builtin_interfaces/msg/Duration"):
            ours.pop(name, None), theirs.pop(name, None)
    assert ours == theirs


@pytest.mark.parametrize("which", STORES)
def test_every_other_message_is_unknown_or_bounded(which: Stores) -> None:
    store, distro = get_typestore(which), which.value.partition("_")[2]
    held = known(store, distro)
    assert not [n for n in store.fielddefs if not fixed(store, n) and size_of(n, held).exact]


def defined(text: str, distro: str = "jazzy") -> Interfaces:
    """Read definitions of a project's own, `name: field; field`, one a line."""
    lines = [line.strip().partition(": ") for line in text.strip().splitlines()]
    held, wrong = interface_sources.load_interfaces(
        distro, (), {n: (t.replace("; ", "\n"), NO_SPAN) for n, _, t in lines}
    )
    assert [d for d in wrong if "holds itself" not in d.message] == []
    return held


@pytest.mark.parametrize(
    ("fields", "bytes_", "exact", "why"),
    [
        ("uint8 a; float64 b", 4 + 16, True, "computed from its definition"),
        ("float64 b; uint8 a", 4 + 9, True, "computed from its definition"),
        ("uint8[3] a; uint16 b; float32 c", 4 + 3 + 1 + 2 + 2 + 4, True, "computed from its definition"),
        ("bool a; geometry_msgs/Point[2] p", 4 + 8 + 48, True, "computed from its definition"),
        ("std_msgs/Empty[3] e", 4 + 3, True, "computed from its definition"),
        ("uint8[1000000000000] a", 4 + 10**12, True, "computed from its definition"),
        ("uint8[9223372036854775807] a", 4 + 2**63 - 1, True, "computed from its definition"),
        ("uint8[9223372036854775808] a", None, False, "`demo_msgs/msg/A` would be larger than any message can be"),
        ("string<=10 a", 4 + 4 + 11, False, "computed from its definition, which bounds the field `a`"),
        ("wstring<=10 a", 4 + 4 + 40, False, "computed from its definition, which bounds the field `a`"),
        ("uint8 x; float64[<=3] a", 4 + 8 + 24, False, "computed from its definition, which bounds the field `a`"),
        ("string<=3[<=2] a", 4 + 4 + 8 + 8, False, "computed from its definition, which bounds the field `a`"),
        ("string a", None, False, "the field `a` may have any length (`string`)"),
        ("uint8[] a", None, False, "the field `a` may have any length (`uint8[]`)"),
        ("std_msgs/Header h", None, False, "the field `h.frame_id` may have any length (`string`)"),
        ("sensor_msgs/Image i", None, False, "the field `i.header.frame_id` may have any length (`string`)"),
        ("other_msgs/Thing t", None, False, "the fields of `other_msgs/msg/Thing` are not known"),
        ("demo_msgs/A a", None, False, "`demo_msgs/msg/A` holds itself"),
        (
            "std_msgs/ColorRGBA[9223372036854775807] a",
            None,
            False,
            "`demo_msgs/msg/A` would be larger than any message can be",
        ),
    ],
)
def test_sizes_by_hand(fields: str, bytes_: int | None, *, exact: bool, why: str) -> None:
    found = size_of("demo_msgs/msg/A", defined(f"demo_msgs/msg/A: {fields}"))
    assert found == message_sizes.MessageSize(bytes_, exact, why)


def test_ros_1_has_no_header_and_no_gaps() -> None:
    held = defined("demo_msgs/msg/A: uint8 a; float64 b; time c; std_msgs/Empty d", "noetic")
    assert size_of("demo_msgs/msg/A", held).bytes == 17


def test_services_and_actions_are_asked_part_by_part() -> None:
    held = defined(
        """
        demo_msgs/srv/Weigh: ---; float64 grams
        demo_msgs/action/Turn: float32 angle; ---; bool done; ---; float32 left
        """
    )
    found = {
        name: size_of(f"demo_msgs/{name}", held).bytes
        for name in (
            "srv/Weigh_Request",
            "srv/Weigh_Response",
            "srv/Weigh_Goal",
            "action/Turn_Goal",
            "action/Turn_SendGoal_Request",
            "action/Turn_SendGoal_Response",
            "action/Turn_GetResult_Request",
            "action/Turn_GetResult_Response",
            "action/Turn_FeedbackMessage",
        )
    }
    assert list(found.values()) == [5, 12, None, 8, 24, 16, 20, 6, 24]
    assert size_of("demo_msgs/srv/Weigh", held).why == "`demo_msgs/srv/Weigh` is several messages"


def test_definitions_may_be_nested_deeply_and_grow_without_bound() -> None:
    lines = [f"demo_msgs/msg/A{n}: demo_msgs/A{n + 1}[9] a" for n in range(3000)]
    held = defined("\n".join([*lines, "demo_msgs/msg/A3000: uint8 a"]))
    assert size_of("demo_msgs/msg/A2990", held).bytes == 4 + 9**10
    assert size_of("demo_msgs/msg/A0", held).bytes is None


def test_what_passes_between_writers_and_readers() -> None:
    held = defined("demo_msgs/srv/Weigh: ---; float64 grams\ndemo_msgs/action/Turn: float32 angle; ---; ---")
    types = {"Grams": ConceptualType("Grams", "demo_msgs/srv/Weigh", size=Quantity(Fraction(801, 2), "400.5 B"))}
    ask = message_sizes.make_writer_query(Architecture(ProjectInfo("p", "P"), types=types, interfaces=held))

    assert message_sizes.make_size_query(Architecture(ProjectInfo("p", "P"), types=types, interfaces=held))(
        "demo_msgs/srv/Weigh", "Grams"
    ) == message_sizes.MessageSize(401, exact=True, why="written at the type `Grams`", written=True)

    def end(flow: FlowKind, message: str | None, type_: str | None = None) -> Endpoint:
        return Endpoint("n", "serves", "/x", flow, None, None, message, type_)

    assert ask(end("topic", "std_msgs/msg/Bool"), "data") == 5
    assert ask(end("topic", None), "data") is None
    assert ask(end("service", "demo_msgs/srv/Weigh"), "request") == 5
    assert ask(end("service", "demo_msgs/srv/Weigh"), "answer") == 12
    assert ask(end("service", "demo_msgs/srv/Weigh", "Grams"), "answer") == 401
    assert ask(end("action", "demo_msgs/action/Turn"), "request") == 24
    assert ask(end("action", "demo_msgs/action/Turn"), "answer") is None


def test_a_topic_has_the_size_of_its_largest_sample() -> None:
    def topic(*messages: str | None) -> Topic:
        ends = tuple(Endpoint("n", "publishes", "/x", "topic", None, None, message) for message in messages)
        return Topic("/x", "topic", (), (), ends, ())

    held, _ = interface_sources.load_interfaces("jazzy")
    topics = {
        "/a": topic("std_msgs/msg/Bool", "std_msgs/msg/Float64"),
        "/b": topic("std_msgs/msg/Bool", "std_msgs/msg/String"),
        "/c": topic(),
    }
    found = message_sizes.find_topic_sizes(Architecture(ProjectInfo("p", "P"), topics=topics, interfaces=held))
    assert found == {"/a": 12, "/b": None, "/c": None}


@pytest.mark.parametrize(
    ("size", "text"),
    [
        (message_sizes.MessageSize(52, exact=True, why=""), "52 B (computed)"),
        (message_sizes.MessageSize(52, exact=False, why=""), "at most 52 B (computed)"),
        (message_sizes.MessageSize(52, exact=True, why="", written=True), "52 B"),
        (message_sizes.MessageSize(None, exact=False, why=""), ""),
    ],
)
def test_a_size_in_words(size: message_sizes.MessageSize, text: str) -> None:
    assert str(size) == text
