"""Names of messages, quantities, generations of ROS."""

from __future__ import annotations

from fractions import Fraction

import pytest

from archgen.model.message_types import flow_of, full_message_name
from archgen.model.quantity import Quantity, parse_quantity
from archgen.model.ros_distro import is_ros_1


@pytest.mark.parametrize(
    ("text", "name"),
    [
        ("sensor_msgs/Image", "sensor_msgs/msg/Image"),
        ("sensor_msgs/msg/Image", "sensor_msgs/msg/Image"),
        ("std_srvs/srv/Trigger", "std_srvs/srv/Trigger"),
        ("Image", None),
        ("a/b/C", None),
        ("Colour image", None),
        ("sensor_msgs/image", None),
        ("sensor_msgs/Image\n", None),
    ],
)
def test_a_message_has_a_full_name(text: str, name: str | None) -> None:
    assert full_message_name(text) == name


@pytest.mark.parametrize(
    ("message", "flow"), [(None, "topic"), ("a/msg/B", "topic"), ("a/srv/B", "service"), ("a/action/B", "action")]
)
def test_what_is_unknown_flows_as_a_topic(message: str | None, flow: str) -> None:
    assert flow_of(message) == flow


@pytest.mark.parametrize(
    ("text", "dimension", "value"),
    [
        ("200 ms", "duration", 200 * 10**6),
        ("200ms", "duration", 200 * 10**6),
        ("0.1 s", "duration", 10**8),
        ("1.5 kHz", "frequency", 1500),
        ("1 KiB", "size", 1024),
        ("1 kB/s", "bandwidth", 8000),
        ("0.3 Hz", "frequency", Fraction(3, 10)),
        ("200 Hz", "duration", None),
        ("200  ms", "duration", None),
        (".5 s", "duration", None),
        ("5. s", "duration", None),
        ("1e3 s", "duration", None),
        ("-1 s", "duration", None),
        ("٣ s", "duration", None),
        ("9" * 19 + " s", "duration", None),
    ],
)
def test_quantities_are_exact(text: str, dimension: str, value: Fraction | int | None) -> None:
    quantity = parse_quantity(text, dimension)
    assert (quantity and quantity.value) == value


def test_quantities_are_the_same_by_value_and_print_as_written() -> None:
    second = parse_quantity("1 s", "duration")
    assert second == parse_quantity("1000 ms", "duration")
    assert str(parse_quantity("1000ms", "duration")) == "1000 ms"
    assert second == Quantity(Fraction(10**9), "")


@pytest.mark.parametrize(("distro", "old"), [("noetic", True), ("jazzy", False), (None, False), ("", False)])
def test_only_the_distributions_of_ros_1_are_ros_1(distro: str | None, old: bool) -> None:  # noqa: FBT001
    assert is_ros_1(distro) is old
