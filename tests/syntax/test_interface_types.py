"""Types of fields as interface definitions write them, in both generations of ROS."""

from __future__ import annotations

import pytest

from archgen.syntax.interface_literals import FieldType, TypeComplaint, list_literal_types, read_field_type


@pytest.mark.parametrize(
    ("text", "ros1", "name", "array", "size"),
    [
        ("int32", False, "int32", "", None),
        ("string<=10", False, "string<=10", "", None),
        ("int8[]", False, "int8", "[]", None),
        ("int8[3]", False, "int8", "[3]", 3),
        ("int8[<=3]", False, "int8", "[<=3]", 3),
        ("string<=5[<=2]", False, "string<=5", "[<=2]", 2),
        ("Pose", False, "own/msg/Pose", "", None),
        ("geometry_msgs/Pose[]", False, "geometry_msgs/msg/Pose", "[]", None),
        ("time", False, "builtin_interfaces/msg/Time", "", None),
        ("time", True, "time", "", None),
        ("Header", True, "std_msgs/msg/Header", "", None),
        ("Header[]", True, "own/msg/Header", "[]", None),  # only `Header` alone is special
        ("Header", False, "own/msg/Header", "", None),
        ("int8[0]", True, "int8", "[0]", 0),
        ("my_type", True, "own/msg/my_type", "", None),
    ],
)
def test_a_type_is_read_with_its_bounds(text: str, ros1: bool, name: str, array: str, size: int | None) -> None:  # noqa: FBT001
    field = read_field_type(text, "own", ros1=ros1)
    assert isinstance(field, FieldType)
    assert (field.name, field.array, field.size) == (name, array, size)


@pytest.mark.parametrize(
    ("text", "ros1", "message", "advice"),
    [
        ("int", False, "there is no type `int` in ROS", "did you mean `int32`?"),
        ("itn32", False, "`itn32` is no type", "did you mean `int32`?"),
        ("int8[0]", False, "`[0]` is no size of an array", "an array is written `[]`, `[3]` or `[<=3]`"),
        ("int8[<=3]", True, "`[<=3]` is no size of an array", "an array is written `[]` or `[3]`"),
        ("int8[2][3]", False, "arrays have one dimension only", "put the inner array into a message of its own"),
        ("string<=0", False, "`string<=0` is no bounded string", "it is written `string<=10`, with a length above 0"),
        ("string<=4", True, "ROS 1 has no bounded strings", "write `string`"),
        (
            "sensor_msgs/msg/Image",
            False,
            "inside definitions a message has two parts, not `sensor_msgs/msg/Image`",
            "write `sensor_msgs/Image`",
        ),
        (
            "my_type",
            False,
            "`my_type` is no type",
            "a message is written `Name` or `package/Name`, letters and digits, a capital first",
        ),
    ],
)
def test_what_is_no_type_is_said_with_what_to_write(text: str, ros1: bool, message: str, advice: str) -> None:  # noqa: FBT001
    assert read_field_type(text, "own", ros1=ros1) == TypeComplaint(message, advice)


def test_wide_strings_can_be_constants_in_ros_2_only() -> None:
    assert list_literal_types(ros1=False) - list_literal_types(ros1=True) == {"wstring"}
