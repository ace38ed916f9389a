"""Read the type of a field in an interface definition: builtin or a message, perhaps bounded, perhaps an array."""

from __future__ import annotations

import re
from typing import NamedTuple

from archgen.frozen import dataclass
from archgen.suggest import did_you_mean

_NUMBERS = ("float32", "float64", *(f"{sign}int{bits}" for sign in ("", "u") for bits in (8, 16, 32, 64)))
# Types whose values can be written as text; time, duration and messages can have neither constants nor defaults.
_LITERAL = frozenset({"bool", "byte", "char", "string", *_NUMBERS})
# Names without a package that stand for a message; the key says whether the grammar is that of ROS 1.
_ALIASES = {
    True: {"Header": "std_msgs/msg/Header"},
    False: {"time": "builtin_interfaces/msg/Time", "duration": "builtin_interfaces/msg/Duration"},
}
# Types of C, Protocol Buffers and other languages that people write by habit.
_ELSEWHERE = {"float": "float32", "double": "float64", "int": "int32", "uint": "uint32", "boolean": "bool"}
_SIZE = re.compile(r"\[(?:(<=)?([0-9]{1,19}))?\]\Z", re.ASCII)
_BOUNDED = re.compile(r"(w?string)<=([0-9]{1,19})\Z", re.ASCII)
# The two patterns of rosidl_adapter for the names of packages and messages. `Sample_` and the suffixes of generated
# messages are the only underscores that ROS 2 allows in a message's name.
_PACKAGE = re.compile(r"[a-z](?:_?[a-z0-9])*\Z", re.ASCII)
_MESSAGE = re.compile(r"(?:Sample_)?[A-Z][A-Za-z0-9]*(?:_(?:Request|Response|Goal|Result|Feedback))*\Z", re.ASCII)
# genmsg allows nearly anything.
_LOOSE = re.compile(r"[A-Za-z][A-Za-z0-9_]*\Z", re.ASCII)


class Complaint(NamedTuple):
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
    builtin: bool
    bound: int | None = None
    array: str = ""
    size: int | None = None

    @property
    def name(self) -> str:
        """The type of one element: `string<=10`, `geometry_msgs/msg/Pose`."""
        return self.base if self.bound is None else f"{self.base}<={self.bound}"


def literal_types(*, ros1: bool) -> frozenset[str]:
    """Return the builtin types whose values can be written as literals: those that a constant may have."""
    return _LITERAL if ros1 else _LITERAL | {"wstring"}


def read_type(text: str, package: str, *, ros1: bool) -> FieldType | Complaint:
    """Read a type as it is written in a definition of `package`, or say what is wrong with it."""
    index = text.find("[")
    base, array = (text, "") if index < 0 else (text[:index], text[index:])
    size = _SIZE.match(array) if array else None
    # ROS 1 knows no `[<=3]` but allows `[0]`; in ROS 2 it is the other way round.
    if array and (size is None or (size[1] and ros1) or (size[2] and not int(size[2]) and not ros1)):
        return _bad_array(array, ros1=ros1)
    if ros1 and array and base == "Header":
        element: FieldType | Complaint = _message(base, package, ros1=ros1)  # only `Header` alone is special
    else:
        element = _element(base, package, ros1=ros1)
    if isinstance(element, Complaint) or size is None:
        return element
    return FieldType(element.base, element.builtin, element.bound, array, int(size[2]) if size[2] else None)


def _bad_array(array: str, *, ros1: bool) -> Complaint:
    if array.count("[") > 1 and array.endswith("]"):
        return Complaint("arrays have one dimension only", "put the inner array into a message of its own")
    forms = "`[]` or `[3]`" if ros1 else "`[]`, `[3]` or `[<=3]`"
    return Complaint(f"`{array}` is no size of an array", f"an array is written {forms}")


def _element(text: str, package: str, *, ros1: bool) -> FieldType | Complaint:
    if text in literal_types(ros1=ros1) or (ros1 and text in {"time", "duration"}):
        return FieldType(text, builtin=True)
    if text in _ALIASES[ros1]:
        return FieldType(_ALIASES[ros1][text], builtin=False)
    if "<=" in text:
        return _bounded(text, ros1=ros1)
    if text in _ELSEWHERE:
        return Complaint(f"there is no type `{text}` in ROS", f"did you mean `{_ELSEWHERE[text]}`?")
    return _message(text, package, ros1=ros1)


def _bounded(text: str, *, ros1: bool) -> FieldType | Complaint:
    match = _BOUNDED.match(text)
    if ros1:
        return Complaint("ROS 1 has no bounded strings", "write `string`")
    if match is None or not int(match[2]):
        return Complaint(f"`{text}` is no bounded string", "it is written `string<=10`, with a length above 0")
    return FieldType(match[1], builtin=True, bound=int(match[2]))


def _message(text: str, package: str, *, ros1: bool) -> FieldType | Complaint:
    """Resolve `Name` and `package/Name` to the full name `package/msg/Name`."""
    parts = text.split("/")
    if len(parts) == 3 and parts[1] == "msg":  # noqa: PLR2004  # pkg/msg/Name
        return Complaint(f"inside definitions a message has two parts, not `{text}`", f"write `{parts[0]}/{parts[2]}`")
    if len(parts) == 1:
        parts = [package, text]
    if len(parts) == 2 and _named(*parts, ros1=ros1):  # noqa: PLR2004  # pkg/Name
        return FieldType(f"{parts[0]}/msg/{parts[1]}", builtin=False)
    known = (*literal_types(ros1=ros1), "time", "duration")
    form = "`Name` or `package/Name`" if ros1 else "`Name` or `package/Name`, letters and digits, a capital first"
    return Complaint(f"`{text}` is no type", did_you_mean(text, known) or f"a message is written {form}")


def _named(package: str, name: str, *, ros1: bool) -> bool:
    if ros1:
        return bool(_LOOSE.match(package) and _LOOSE.match(name))
    return bool(_PACKAGE.match(package) and _MESSAGE.match(name))
