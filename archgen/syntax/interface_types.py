"""Read the type of a field in an interface definition: builtin or a message, perhaps bounded, perhaps an array."""

from __future__ import annotations

import re
from typing import NamedTuple

from archgen.diagnostics.suggestions import did_you_mean
from archgen.frozen import dataclass

_NUMBER_TYPES = ("float32", "float64", *(f"{sign}int{bits}" for sign in ("", "u") for bits in (8, 16, 32, 64)))
# Types whose values can be written as text; time, duration and messages can have neither constants nor defaults.
_LITERAL_TYPES = frozenset({"bool", "byte", "char", "string", *_NUMBER_TYPES})
# Names without a package that stand for a message; the key says whether the grammar is that of ROS 1.
_TYPE_ALIASES = {
    True: {"Header": "std_msgs/msg/Header"},
    False: {"time": "builtin_interfaces/msg/Time", "duration": "builtin_interfaces/msg/Duration"},
}
# Types of C, Protocol Buffers and other languages that people write by habit.
_FOREIGN_TYPES = {"float": "float32", "double": "float64", "int": "int32", "uint": "uint32", "boolean": "bool"}
_ARRAY_SIZE = re.compile(r"\[(?:(<=)?([0-9]{1,19}))?\]\Z", re.ASCII)
_BOUNDED_STRING = re.compile(r"(w?string)<=([0-9]{1,19})\Z", re.ASCII)
# The two patterns of rosidl_adapter for the names of packages and messages. `Sample_` and the suffixes of generated
# messages are the only underscores that ROS 2 allows in a message's name.
_PACKAGE_NAME = re.compile(r"[a-z](?:_?[a-z0-9])*\Z", re.ASCII)
_MESSAGE_NAME = re.compile(r"(?:Sample_)?[A-Z][A-Za-z0-9]*(?:_(?:Request|Response|Goal|Result|Feedback))*\Z", re.ASCII)
# genmsg allows nearly anything.
_ROS1_NAME = re.compile(r"[A-Za-z][A-Za-z0-9_]*\Z", re.ASCII)


class TypeComplaint(NamedTuple):
    """What is wrong with a type, and what to write instead."""

    message: str
    help: str | None = None


@dataclass(frozen=True, slots=True)
class FieldType:
    """A field's type. `base` is the builtin type or a message's full name; `bound` is the greatest length of a string.

    `array` is the brackets as written, empty for a single value; `size` is the number in them: 3 for `[3]` and `[<=3]`,
    None for `[]`.
    """

    base: str
    is_builtin: bool
    bound: int | None = None
    array: str = ""
    size: int | None = None

    @property
    def name(self) -> str:
        """The type of one element: `string<=10`, `geometry_msgs/msg/Pose`."""
        return self.base if self.bound is None else f"{self.base}<={self.bound}"


def list_literal_types(*, ros1: bool) -> frozenset[str]:
    """Return the builtin types whose values can be written as literals: those that a constant may have."""
    return _LITERAL_TYPES if ros1 else _LITERAL_TYPES | {"wstring"}


def read_field_type(text: str, package: str, *, ros1: bool) -> FieldType | TypeComplaint:
    """Read a type as it is written in a definition of `package`, or say what is wrong with it."""
    bracket_index = text.find("[")
    base, array = (text, "") if bracket_index < 0 else (text[:bracket_index], text[bracket_index:])
    size_match = _ARRAY_SIZE.match(array) if array else None
    # ROS 1 knows no `[<=3]` but allows `[0]`; in ROS 2 it is the other way round.
    if array and (
        size_match is None or (size_match[1] and ros1) or (size_match[2] and not int(size_match[2]) and not ros1)
    ):
        return _explain_bad_array(array, ros1=ros1)
    if ros1 and array and base == "Header":
        element_type: FieldType | TypeComplaint = _read_message_type(
            base, package, ros1=ros1
        )  # only `Header` alone is special
    else:
        element_type = _read_element_type(base, package, ros1=ros1)
    if isinstance(element_type, TypeComplaint) or size_match is None:
        return element_type
    return FieldType(
        element_type.base,
        element_type.is_builtin,
        element_type.bound,
        array,
        int(size_match[2]) if size_match[2] else None,
    )


def _explain_bad_array(array: str, *, ros1: bool) -> TypeComplaint:
    if array.count("[") > 1 and array.endswith("]"):
        return TypeComplaint("arrays have one dimension only", "put the inner array into a message of its own")
    forms = "`[]` or `[3]`" if ros1 else "`[]`, `[3]` or `[<=3]`"
    return TypeComplaint(f"`{array}` is no size of an array", f"an array is written {forms}")


def _read_element_type(text: str, package: str, *, ros1: bool) -> FieldType | TypeComplaint:
    if text in list_literal_types(ros1=ros1) or (ros1 and text in {"time", "duration"}):
        return FieldType(text, is_builtin=True)
    if text in _TYPE_ALIASES[ros1]:
        return FieldType(_TYPE_ALIASES[ros1][text], is_builtin=False)
    if "<=" in text:
        return _read_bounded_string(text, ros1=ros1)
    if text in _FOREIGN_TYPES:
        return TypeComplaint(f"there is no type `{text}` in ROS", f"did you mean `{_FOREIGN_TYPES[text]}`?")
    return _read_message_type(text, package, ros1=ros1)


def _read_bounded_string(text: str, *, ros1: bool) -> FieldType | TypeComplaint:
    match = _BOUNDED_STRING.match(text)
    if ros1:
        return TypeComplaint("ROS 1 has no bounded strings", "write `string`")
    if match is None or not int(match[2]):
        return TypeComplaint(f"`{text}` is no bounded string", "it is written `string<=10`, with a length above 0")
    return FieldType(match[1], is_builtin=True, bound=int(match[2]))


def _read_message_type(text: str, package: str, *, ros1: bool) -> FieldType | TypeComplaint:
    """Resolve `Name` and `package/Name` to the full name `package/msg/Name`."""
    parts = text.split("/")
    if len(parts) == 3 and parts[1] == "msg":  # noqa: PLR2004  # pkg/msg/Name
        return TypeComplaint(
            f"inside definitions a message has two parts, not `{text}`", f"write `{parts[0]}/{parts[2]}`"
        )
    if len(parts) == 1:
        parts = [package, text]
    if len(parts) == 2 and _is_message_name(*parts, ros1=ros1):  # noqa: PLR2004  # pkg/Name
        return FieldType(f"{parts[0]}/msg/{parts[1]}", is_builtin=False)
    type_names = {*list_literal_types(ros1=ros1), "time", "duration"}
    form = "`Name` or `package/Name`" if ros1 else "`Name` or `package/Name`, letters and digits, a capital first"
    return TypeComplaint(f"`{text}` is no type", did_you_mean(text, type_names) or f"a message is written {form}")


def _is_message_name(package: str, name: str, *, ros1: bool) -> bool:
    if ros1:
        return bool(_ROS1_NAME.match(package) and _ROS1_NAME.match(name))
    return bool(_PACKAGE_NAME.match(package) and _MESSAGE_NAME.match(name))
